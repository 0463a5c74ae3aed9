#include "tools/bed/vtk_file.h"

#include <bit>
#include <stdexcept>
#include <string_view>

#include "tools/bed/whole_file.h"
#include "tools/run/csv_writer.h"
#include "tools/run/errors.h"

namespace hoof::tools {
namespace {

static_assert(std::endian::native == std::endian::little, "the files say LittleEndian");

void write_whole(const std::filesystem::path& file, std::initializer_list<std::string_view> parts) {
  WholeFile out(file);
  for (const std::string_view part : parts) out.write(part);
  out.commit();
}

class VtpText {
 public:
  /// Declares an array here and appends its numbers to the binary part.
  template <typename T>
  void array(const char* type, const std::string& name, int components,
             const std::vector<T>& values) {
    xml_ += "<DataArray type=\"" + std::string(type) + "\" Name=\"" + name +
            "\" NumberOfComponents=\"" + std::to_string(components) +
            "\" format=\"appended\" offset=\"" + std::to_string(binary_.size()) + "\"/>\n";
    const std::uint64_t size = values.size() * sizeof(T);
    binary_.append(reinterpret_cast<const char*>(&size), sizeof size);
    binary_.append(reinterpret_cast<const char*>(values.data()), size);
  }

  void array(const VtkArray& a, std::size_t count) {
    const auto put = [&](const char* type, const auto& values) {
      if (values.size() != count * std::size_t(a.components)) {
        throw std::invalid_argument("VTK array " + a.name + " has " +
                                    std::to_string(values.size()) + " values for " +
                                    std::to_string(count) + " places");
      }
      array(type, a.name, a.components, values);
    };
    if (const auto* reals = std::get_if<std::vector<float>>(&a.values)) {
      put("Float32", *reals);
    } else {
      put("Int32", std::get<std::vector<std::int32_t>>(a.values));
    }
  }

  void arrays(const char* element, const std::vector<VtkArray>& all, std::size_t count) {
    text("<" + std::string(element) + ">\n");
    for (const VtkArray& a : all) array(a, count);
    text("</" + std::string(element) + ">\n");
  }

  void text(const std::string& xml) { xml_ += xml; }
  const std::string& xml() const { return xml_; }
  const std::string& binary() const { return binary_; }

 private:
  std::string xml_;
  std::string binary_;
};

const char* cell_element(PolyData::Cell cell) {
  switch (cell) {
    case PolyData::Cell::kVertex:
      return "Verts";
    case PolyData::Cell::kLine:
      return "Lines";
    case PolyData::Cell::kTriangle:
      break;
  }
  return "Polys";
}

}  // namespace

void PolyData::add_point(const Eigen::Vector3d& p_m) {
  points_m.insert(points_m.end(), {float(p_m.x()), float(p_m.y()), float(p_m.z())});
}

void write_vtp(const std::filesystem::path& file, const PolyData& data) {
  const auto cells_of = [&](PolyData::Cell kind) {
    return " NumberOf" + std::string(cell_element(kind)) + "=\"" +
           std::to_string(kind == data.cell ? data.cell_count() : 0) + "\"";
  };
  VtpText t;
  t.text(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n<Piece NumberOfPoints=\"" +
      std::to_string(data.point_count()) + "\"" + cells_of(PolyData::Cell::kVertex) +
      cells_of(PolyData::Cell::kLine) + " NumberOfStrips=\"0\"" +
      cells_of(PolyData::Cell::kTriangle) + ">\n");
  t.arrays("PointData", data.point_arrays, data.point_count());
  t.arrays("CellData", data.cell_arrays, data.cell_count());
  t.text("<Points>\n");
  t.array("Float32", "Points", 3, data.points_m);
  t.text("</Points>\n");
  std::vector<std::int64_t> ends;  // of each cell in the list of points
  for (std::size_t i = 1; i <= data.cell_count(); ++i) {
    ends.push_back(std::int64_t(i * std::size_t(data.cell)));
  }
  const std::string element = cell_element(data.cell);
  t.text("<" + element + ">\n");
  t.array("Int64", "connectivity", 1, data.connectivity);
  t.array("Int64", "offsets", 1, ends);
  t.text("</" + element + ">\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_");
  write_whole(file, {t.xml(), t.binary(), "\n</AppendedData>\n</VTKFile>\n"});
}

VtkSeries::VtkSeries(std::filesystem::path folder, std::string name)
    : folder_(std::move(folder)), name_(std::move(name)) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) throw UserError(folder_.string() + ": cannot make: " + error.message());
}

void VtkSeries::add(double time_s, const std::string& part, const PolyData& data) {
  if (entries_.empty() || entries_.back().time_s != time_s) ++frame_;
  const std::string number = std::to_string(frame_);
  const std::string file =
      part + "-" + std::string(number.size() < 5 ? 5 - number.size() : 0, '0') + number + ".vtp";
  write_vtp(folder_ / file, data);
  entries_.push_back({time_s, part, file});
  std::string xml =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
      "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (const Entry& e : entries_) {
    xml += "<DataSet timestep=\"" + format_number(e.time_s) + "\" part=\"" + e.part + "\" file=\"" +
           e.file + "\"/>\n";
  }
  write_whole(collection(), {xml, "</Collection>\n</VTKFile>\n"});
}

}  // namespace hoof::tools
