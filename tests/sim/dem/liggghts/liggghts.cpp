#include "tests/sim/dem/liggghts/liggghts.h"

#include <sys/wait.h>

#include <array>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace hoof::sim::test {
namespace fs = std::filesystem;
namespace {

std::ofstream open_exact(const fs::path& file) {
  std::ofstream out(file);
  if (!out) throw std::runtime_error("cannot write " + file.string());
  out << std::setprecision(std::numeric_limits<double>::max_digits10);
  return out;
}

GrainMotion motion(const std::vector<double>& row, std::size_t first) {
  const auto at = [&](std::size_t i) {
    return Eigen::Vector3d(row[first + i], row[first + i + 1], row[first + i + 2]);
  };
  return {at(0), at(3), at(6)};
}

}  // namespace

bool liggghts_is_installed() {
  return std::system("command -v liggghts >/dev/null 2>&1") == 0;
}

void write_data_file(const fs::path& file, const std::vector<Grain>& grains,
                     const Eigen::Vector3d& low_m, const Eigen::Vector3d& high_m) {
  std::ofstream out = open_exact(file);
  out << "grains\n\n" << grains.size() << " atoms\n2 atom types\n\n";
  for (int axis = 0; axis < 3; ++axis) {
    const char name = "xyz"[axis];
    out << low_m[axis] << ' ' << high_m[axis] << ' ' << name << "lo " << name << "hi\n";
  }
  const Eigen::IOFormat row(Eigen::FullPrecision, Eigen::DontAlignCols, " ", " ");
  out << "\nAtoms\n\n";
  for (const Grain& g : grains) {
    out << g.id + 1 << " 1 " << 2 * g.radius_m << " 2650 " << g.p_m.transpose().format(row) << '\n';
  }
  out << "\nVelocities\n\n";
  for (const Grain& g : grains) {
    out << g.id + 1 << ' ' << g.v_m_s.transpose().format(row) << ' '
        << g.w_rad_s.transpose().format(row) << '\n';
  }
}

void write_stl(const fs::path& file, const TriangleMesh& mesh) {
  std::ofstream out = open_exact(file);
  out << "solid body\n";
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d &p = mesh.vertices_m[std::size_t(a)],
                          &q = mesh.vertices_m[std::size_t(b)],
                          &r = mesh.vertices_m[std::size_t(c)];
    out << "facet normal " << (q - p).cross(r - p).normalized().transpose() << "\nouter loop\n";
    for (const Eigen::Vector3d& v : {p, q, r}) out << "vertex " << v.transpose() << '\n';
    out << "endloop\nendfacet\n";
  }
  out << "endsolid body\n";
}

void run_liggghts(const std::string& script, const fs::path& folder,
                  const std::map<std::string, std::string>& variables) {
  const std::string scripts = std::string(HOOF_SOURCE_DIR) + "/tests/sim/dem/liggghts";
  std::string command =
      "cd '" + folder.string() + "' && OMP_NUM_THREADS=1 liggghts -var scripts '" + scripts + "'";
  for (const auto& [name, value] : variables) command += " -var " + name + " '" + value + "'";
  command += " -in '" + scripts + "/" + script + "' 2>&1";
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot start liggghts");
  std::string output;
  std::array<char, 4096> block;
  std::size_t count = 0;
  while ((count = std::fread(block.data(), 1, block.size(), pipe)) > 0) {
    output.append(block.data(), count);
  }
  if (pclose(pipe) != 0) {
    const std::size_t tail = output.size() > 600 ? output.size() - 600 : 0;
    throw std::runtime_error("liggghts failed on " + script + ":\n" + output.substr(tail));
  }
}

std::vector<std::vector<double>> read_numbers(const fs::path& file, char separator) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot read " + file.string());
  std::vector<std::vector<double>> rows;
  std::string line, cell;
  while (std::getline(in, line)) {
    if (line.empty() || line[0] == '#' || std::isalpha(static_cast<unsigned char>(line[0]))) {
      continue;
    }
    std::stringstream cells(line);
    rows.emplace_back();
    while (std::getline(cells, cell, separator)) {
      if (!cell.empty()) rows.back().push_back(std::stod(cell));
    }
  }
  return rows;
}

Dump read_dump(const fs::path& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("liggghts left no " + file.string());
  Dump dump;
  std::string line;
  int step = -1;
  bool in_grains = false;
  while (std::getline(in, line)) {
    if (line.rfind("ITEM:", 0) == 0) {
      in_grains = line.rfind("ITEM: ATOMS", 0) == 0;
      if (line == "ITEM: TIMESTEP") in >> step >> std::ws;
      continue;
    }
    if (!in_grains) continue;
    std::stringstream cells(line);
    std::vector<double> row(10);
    for (double& value : row) cells >> value;
    if (!cells) throw std::runtime_error(file.string() + ": not a row of ten numbers: " + line);
    dump[step][std::uint32_t(row[0]) - 1] = motion(row, 1);
  }
  return dump;
}

void write_record(const fs::path& file, const Dump& dump) {
  std::ofstream out(file);
  if (!out) throw std::runtime_error("cannot write " + file.string());
  out << std::setprecision(10) << "step,grain,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,"
      << "wx_rad_s,wy_rad_s,wz_rad_s\n";
  const Eigen::IOFormat row(10, Eigen::DontAlignCols, ",", ",");
  for (const auto& [step, grains] : dump) {
    for (const auto& [id, g] : grains) {
      out << step << ',' << id << ',' << g.p_m.transpose().format(row) << ','
          << g.v_m_s.transpose().format(row) << ',' << g.w_rad_s.transpose().format(row) << '\n';
    }
  }
}

Dump read_record(const fs::path& file) {
  Dump dump;
  for (const std::vector<double>& row : read_numbers(file, ',')) {
    if (row.size() != 11) throw std::runtime_error(file.string() + ": a row has not 11 columns");
    dump[int(row[0])][std::uint32_t(row[1])] = motion(row, 2);
  }
  return dump;
}

}  // namespace hoof::sim::test
