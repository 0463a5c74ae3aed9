#include "sim/multibody/stl.h"

#include <Eigen/Geometry>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>

#include "sim/config/config_error.h"
#include "sim/multibody/mesh_fault.h"

namespace hoof::sim {
namespace {

namespace fs = std::filesystem;

using Facet = std::array<Eigen::Vector3d, 3>;

/// Binary layout: 80 bytes of header, 32 bit count, then per facet 12 floats (normal, 3 vertices)
/// and 16 bits of attributes, all little-endian.
constexpr std::size_t kHeaderBytes = 80;
constexpr std::size_t kFacetBytes = 50;

/// Well above the rounding of 32 bit floats at 0.2 m (15 nm), far below any real feature.
constexpr double kWeld_m = 1e-6;

[[noreturn]] void fail(const fs::path& file, const std::string& why) {
  throw ConfigError(file.string() + ": " + why);
}

std::string read_bytes(const fs::path& file) {
  errno = 0;
  if (fs::is_directory(file)) fail(file, "cannot be read: is a folder");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail(file, std::string("cannot be read: ") + std::strerror(errno ? errno : EIO));
  return {std::istreambuf_iterator<char>(stream), {}};
}

static_assert(std::endian::native == std::endian::little, "STL is little-endian");

template <typename Number>
Number number_at(const std::string& bytes, std::size_t offset) {
  Number value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

/// A binary file's size follows from its count; the word "solid" in front proves nothing.
bool is_binary(const std::string& bytes) {
  if (bytes.size() < kHeaderBytes + 4) return false;
  const std::size_t count = number_at<std::uint32_t>(bytes, kHeaderBytes);
  return bytes.size() == kHeaderBytes + 4 + count * kFacetBytes;
}

std::vector<Facet> binary_facets(const std::string& bytes) {
  std::vector<Facet> facets(number_at<std::uint32_t>(bytes, kHeaderBytes));
  for (std::size_t i = 0; i < facets.size(); ++i) {
    std::size_t offset = kHeaderBytes + 4 + i * kFacetBytes + 3 * sizeof(float);
    for (Eigen::Vector3d& vertex : facets[i]) {
      for (double& coordinate : vertex) {
        coordinate = number_at<float>(bytes, offset);
        offset += sizeof(float);
      }
    }
  }
  return facets;
}

std::vector<Facet> ascii_facets(const std::string& text, const fs::path& file) {
  std::istringstream stream(text);
  std::string line;
  std::vector<Facet> facets;
  int line_number = 0;
  int vertex = 0;
  bool ended = false;
  while (std::getline(stream, line)) {
    ++line_number;
    std::istringstream words(line);
    std::string word;
    words >> word;
    const std::string at = std::to_string(line_number) + ": ";
    if (word == "facet") {
      facets.emplace_back();
      vertex = 0;
    } else if (word == "vertex") {
      if (facets.empty() || vertex > 2) fail(file, at + "vertex outside of a triangle");
      Eigen::Vector3d& point = facets.back()[vertex++];
      if (!(words >> point.x() >> point.y() >> point.z())) {
        fail(file, at + "vertex must have three numbers");
      }
    } else if (word == "endfacet") {
      if (vertex != 3) fail(file, at + "triangle must have three vertices");
    }
    ended = ended || word == "endsolid";
  }
  if (!ended) fail(file, "not a whole STL file: neither binary nor ended by endsolid");
  return facets;
}

/// Gives near points one index, in the order of their first appearance.
class Welder {
 public:
  std::int32_t index_of(const Eigen::Vector3d& point) {
    const Cell cell = cell_of(point);
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      for (std::int64_t dy = -1; dy <= 1; ++dy) {
        for (std::int64_t dz = -1; dz <= 1; ++dz) {
          const auto found = cells_.find({cell[0] + dx, cell[1] + dy, cell[2] + dz});
          if (found == cells_.end()) continue;
          if ((points_[found->second] - point).norm() < kWeld_m) return found->second;
        }
      }
    }
    const auto index = static_cast<std::int32_t>(points_.size());
    points_.push_back(point);
    cells_.emplace(cell, index);
    return index;
  }

  std::vector<Eigen::Vector3d> take() { return std::move(points_); }

 private:
  using Cell = std::array<std::int64_t, 3>;

  static Cell cell_of(const Eigen::Vector3d& point) {
    Cell cell;
    for (int i = 0; i < 3; ++i) cell[i] = std::llround(point[i] / kWeld_m);
    return cell;
  }

  std::map<Cell, std::int32_t> cells_;
  std::vector<Eigen::Vector3d> points_;
};

}  // namespace

TriangleMesh read_stl(const fs::path& file, const Unit& unit) {
  const std::string bytes = read_bytes(file);
  const std::vector<Facet> facets =
      is_binary(bytes) ? binary_facets(bytes) : ascii_facets(bytes, file);

  Welder welder;
  TriangleMesh mesh;
  std::vector<std::size_t> number_in_file;
  for (std::size_t i = 0; i < facets.size(); ++i) {
    std::array<std::int32_t, 3> triangle;
    for (int v = 0; v < 3; ++v) {
      Eigen::Vector3d point;
      for (int axis = 0; axis < 3; ++axis) point[axis] = unit.to_si(facets[i][v][axis]);
      // A kilometre is no foot; it would also overflow the welding grid.
      if (!point.allFinite() || point.cwiseAbs().maxCoeff() > 1e3) {
        fail(file, "triangle " + std::to_string(i + 1) + ": coordinate must be below 1 km");
      }
      triangle[v] = welder.index_of(point);
    }
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) {
      continue;
    }
    mesh.triangles.push_back(triangle);
    number_in_file.push_back(i + 1);
  }
  mesh.vertices_m = welder.take();
  if (mesh.triangles.empty()) fail(file, "holds no triangles");
  if (const auto fault = find_mesh_fault(mesh)) {
    fail(file, "triangle " + std::to_string(number_in_file[fault->triangle]) + ": " + fault->text);
  }
  return mesh;
}

namespace {

void write_binary(const TriangleMesh& mesh, std::ofstream& out) {
  const auto put = [&out](const auto& value) {
    out.write(reinterpret_cast<const char*>(&value), sizeof value);
  };
  const auto put_vector = [&put](const Eigen::Vector3d& v) {
    for (const double coordinate : v) put(static_cast<float>(coordinate));
  };
  out << std::string(kHeaderBytes, ' ');
  put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d& v0 = mesh.vertices_m[a];
    put_vector((mesh.vertices_m[b] - v0).cross(mesh.vertices_m[c] - v0).normalized());
    for (const std::int32_t v : {a, b, c}) put_vector(1e3 * mesh.vertices_m[v]);
    put(std::uint16_t{0});
  }
}

void write_ascii(const TriangleMesh& mesh, std::ofstream& out) {
  out.precision(17);
  const auto line = [&out](const char* word, const Eigen::Vector3d& v) {
    out << word << ' ' << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
  };
  out << "solid hoof\n";
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d& v0 = mesh.vertices_m[a];
    line("facet normal", (mesh.vertices_m[b] - v0).cross(mesh.vertices_m[c] - v0).normalized());
    out << "outer loop\n";
    for (const std::int32_t v : {a, b, c}) line("vertex", 1e3 * mesh.vertices_m[v]);
    out << "endloop\nendfacet\n";
  }
  out << "endsolid hoof\n";
}

}  // namespace

void write_stl(const TriangleMesh& mesh, const fs::path& file, StlFormat format) {
  errno = 0;
  std::ofstream out(file, std::ios::binary);
  if (format == StlFormat::kBinary) {
    write_binary(mesh, out);
  } else {
    write_ascii(mesh, out);
  }
  out.close();
  if (!out) {
    throw std::runtime_error(file.string() +
                             ": cannot be written: " + std::strerror(errno ? errno : EIO));
  }
}

}  // namespace hoof::sim
