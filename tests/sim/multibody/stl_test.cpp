#include "sim/multibody/stl.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "sim/config/config_error.h"
#include "sim/multibody/mass_properties.h"
#include "tests/sim/multibody/cube.h"
#include "tests/sim/multibody/shipped.h"

using namespace hoof::sim;
namespace fs = std::filesystem;

namespace {

class TemporaryFile {
 public:
  TemporaryFile() {
    std::string name = (fs::temp_directory_path() / "hoof-stl-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~TemporaryFile() { fs::remove_all(folder_); }
  fs::path path() const { return folder_ / "foot.stl"; }

 private:
  fs::path folder_;
};

std::string error_of(const fs::path& file) {
  try {
    read_stl(file, kMillimetre);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("a foot goes through an STL file and back") {
  const TemporaryFile file;
  const TriangleMesh mesh = shipped_foot("bionic").middle;
  const StlFormat format = GENERATE(StlFormat::kBinary, StlFormat::kAscii);
  write_stl(mesh, file.path(), format);
  const TriangleMesh back = read_stl(file.path(), kMillimetre);
  REQUIRE(back.triangles.size() == mesh.triangles.size());
  REQUIRE(back.vertices_m.size() == mesh.vertices_m.size());
  // 32 bit floats of up to 90 mm are rounded to 4 nm.
  const double tolerance_m = format == StlFormat::kBinary ? 1e-8 : 1e-15;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const auto& a = mesh.vertices_m[mesh.triangles[t][i]];
      const auto& b = back.vertices_m[back.triangles[t][i]];
      REQUIRE((a - b).norm() < tolerance_m);
    }
  }
}

TEST_CASE("the unit is applied, as STL has none of its own") {
  const TemporaryFile file;
  write_stl(make_cuboid({0, 0, 0}, {0.001, 0.001, 0.001}), file.path());
  CHECK(volume_m3(read_stl(file.path(), kMillimetre)) == Approx(1e-9));
  CHECK(volume_m3(read_stl(file.path(), kMetre)) == Approx(1.0));
}

TEST_CASE("a binary file that begins with solid is read as binary") {
  const TemporaryFile file;
  write_stl(make_cuboid({0, 0, 0}, {0.01, 0.01, 0.01}), file.path());
  std::fstream(file.path(), std::ios::in | std::ios::out | std::ios::binary) << "solid endsolid";
  CHECK(read_stl(file.path(), kMillimetre).triangles.size() == 12);
}

TEST_CASE("nearby vertices are welded, and triangles that collapse are dropped") {
  const TemporaryFile file;
  TriangleMesh mesh = make_cuboid({0, 0, 0}, {0.01, 0.01, 0.01});
  // A sliver on the edge 0-1: a new vertex 0.1 um from vertex 0, its triangle fan closed.
  mesh.vertices_m.push_back({1e-7, 0, 0});
  mesh.triangles[0] = {0, 2, 8};
  mesh.triangles.push_back({8, 2, 1});
  mesh.triangles[4] = {0, 8, 4};
  mesh.triangles.push_back({8, 1, 4});
  write_stl(mesh, file.path());
  const TriangleMesh back = read_stl(file.path(), kMillimetre);
  CHECK(back.vertices_m.size() == 8);
  CHECK(back.triangles.size() == 12);
}

TEST_CASE("a bad STL file is refused with file, triangle and edge") {
  const TemporaryFile file;
  const std::string name = file.path().string();
  CHECK(error_of(file.path()) == name + ": cannot be read: No such file or directory");

  TriangleMesh mesh = make_cuboid({0, 0, 0}, {0.01, 0.02, 0.03});
  mesh.triangles.pop_back();
  write_stl(mesh, file.path());
  CHECK(error_of(file.path()) ==
        name +
            ": triangle 11: edge (10.000 20.000 0.000) to (10.000 0.000 30.000) mm has no "
            "neighbour: the mesh has a hole");

  fs::resize_file(file.path(), fs::file_size(file.path()) - 10);
  CHECK(error_of(file.path()) ==
        name + ": not a whole STL file: neither binary nor ended by endsolid");

  std::ofstream(file.path()) << "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n";
  CHECK(error_of(file.path()) == name + ": 4: vertex must have three numbers");
  std::ofstream(file.path()) << "solid x\nendsolid x\n";
  CHECK(error_of(file.path()) == name + ": holds no triangles");
  std::ofstream(file.path()) << "";
  CHECK(error_of(file.path()).starts_with(name + ": not a whole STL file"));
}
