// Points, lines and triangles as ParaView reads them: VTK XML PolyData (.vtp), arrays appended raw,
// little-endian, and collections of such files over time (.pvd).
// Format: VTK File Formats, "XML file formats" (Kitware).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace hoof::tools {

/// One named value, or vector of three, for each point or each cell.
struct VtkArray {
  std::string name;
  int components = 1;
  std::variant<std::vector<float>, std::vector<std::int32_t>> values;
};

/// Points, and cells that are all alike. Lengths in metres.
struct PolyData {
  enum class Cell { kVertex = 1, kLine = 2, kTriangle = 3 };  // points of a cell

  Cell cell = Cell::kVertex;
  std::vector<float> points_m;             // x, y, z of each
  std::vector<std::int64_t> connectivity;  // points of each cell, one cell after the other
  std::vector<VtkArray> point_arrays;
  std::vector<VtkArray> cell_arrays;

  std::size_t point_count() const { return points_m.size() / 3; }
  std::size_t cell_count() const { return connectivity.size() / std::size_t(cell); }
  void add_point(const Eigen::Vector3d& p_m);
};

/// Whole or not there. @throws UserError naming the file and the cause; std::invalid_argument for
/// an array that is not as long as its points or cells
void write_vtp(const std::filesystem::path& file, const PolyData& data);

/// A folder of .vtp files with one .pvd beside them that names them all, each with its time and the
/// part of the scene it shows. The .pvd is whole after every add.
class VtkSeries {
 public:
  /// @param folder made where it is missing  @param name of the .pvd, without the ending
  VtkSeries(std::filesystem::path folder, std::string name);

  /// Writes "<part>-<number of the frame>.vtp". A new time begins a new frame.
  void add(double time_s, const std::string& part, const PolyData& data);

  std::filesystem::path collection() const { return folder_ / (name_ + ".pvd"); }

 private:
  struct Entry {
    double time_s;
    std::string part;
    std::string file;
  };

  std::filesystem::path folder_;
  std::string name_;
  std::vector<Entry> entries_;
  int frame_ = -1;
};

}  // namespace hoof::tools
