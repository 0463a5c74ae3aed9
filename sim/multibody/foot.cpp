#include "sim/multibody/foot.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "sim/multibody/mesh_fault.h"
#include "sim/multibody/stl.h"

namespace hoof::sim {
namespace {

SoleGeometry read_sole(Reader section) {
  SoleGeometry sole;
  section.number("length_mm", sole.length_m, kMillimetre, 10.0, 500.0);
  section.number("width_mm", sole.width_m, kMillimetre, 5.0, 300.0);
  section.number("height_mm", sole.height_m, kMillimetre, 5.0, 200.0);
  section.number("edge_radius_mm", sole.edge_radius_m, kMillimetre, 0.1, 100.0);
  return sole;
}

ToeGeometry read_toe(Reader& section) {
  ToeGeometry toe;
  section.number("length_mm", toe.length_m, kMillimetre, 10.0, 500.0);
  section.number("width_mm", toe.width_m, kMillimetre, 5.0, 300.0);
  section.number("tip_width_mm", toe.tip_width_m, kMillimetre, 5.0, 300.0);
  section.number("height_mm", toe.height_m, kMillimetre, 5.0, 200.0);
  section.number("edge_radius_mm", toe.edge_radius_m, kMillimetre, 0.1, 100.0);
  section.number("hinge_from_heel_mm", toe.hinge_from_heel_m, kMillimetre, 0.0, 500.0);
  section.number("hinge_lateral_mm", toe.hinge_lateral_m, kMillimetre, 0.0, 300.0);
  return toe;
}

ToeHinges read_hinges(Reader& section) {
  ToeHinges hinges;
  section.number("min_opening_deg", hinges.min_opening_rad, kDegree, -20.0, 0.0);
  section.number("max_opening_deg", hinges.max_opening_rad, kDegree, 0.0, 90.0);
  section.number("linkage_stiffness_Nm_rad", hinges.linkage_stiffness_Nm_rad, kNewtonMetrePerRadian,
                 0.0, 1e6);
  section.number("linkage_damping_Nm_s_rad", hinges.linkage_damping_Nm_s_rad,
                 kNewtonMetreSecondPerRadian, 0.0, 1e3);
  return hinges;
}

SpineGeometry read_spines(Reader section) {
  SpineGeometry spines;
  section.number("length_mm", spines.length_m, kMillimetre, 1.0, 50.0);
  section.number("base_mm", spines.base_m, kMillimetre, 0.5, 50.0);
  section.number("tip_mm", spines.tip_m, kMillimetre, 0.1, 50.0);
  section.number("rake_deg", spines.rake_rad, kDegree, -60.0, 60.0);
  section.integer("toe_count", spines.toe_count, 0, 100);
  section.number("toe_pitch_mm", spines.toe_pitch_m, kMillimetre, 1.0, 200.0);
  section.integer("middle_count_row", spines.middle_count_row, 0, 100);
  section.number("middle_pitch_mm", spines.middle_pitch_m, kMillimetre, 1.0, 200.0);
  section.number("middle_row_offset_mm", spines.middle_row_offset_m, kMillimetre, 0.0, 100.0);
  return spines;
}

/// Lowest point to z = 0, middle of the bounding box to x = y = 0.
void centre(TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : mesh.vertices_m) box.extend(v);
  const Eigen::Vector3d origin(box.center().x(), box.center().y(), box.min().z());
  for (Eigen::Vector3d& v : mesh.vertices_m) v -= origin;
}

void read_mesh_file(Reader& section, Foot& foot) {
  std::string file;
  std::string unit;
  section.text("mesh_file", file);
  section.choice("mesh_unit", unit, {"mm", "m"});
  section.finish();
  foot.middle = read_stl(file, unit == "m" ? kMetre : kMillimetre);
  centre(foot.middle);
}

void make_meshes(Foot& foot) {
  foot.middle = make_middle(foot.geometry);
  foot.has_toes = foot.geometry.has_toes;
  if (foot.has_toes) foot.left_toe = foot.right_toe = make_toe(foot.geometry);
}

void read_parts(Reader& section, Foot& foot) {
  FootGeometry& geometry = foot.geometry;
  geometry.middle = read_sole(section.section("middle"));
  geometry.has_toes = section.has("toe");
  if (geometry.has_toes) {
    Reader toe = section.section("toe");
    geometry.toe = read_toe(toe);
    foot.hinges = read_hinges(toe);
  }
  geometry.has_spines = section.has("spines");
  if (geometry.has_spines) geometry.spines = read_spines(section.section("spines"));
  section.finish();
  section.check([&geometry] { geometry.validate(); });

  make_meshes(foot);
  if (!foot.has_toes) return;
  foot.hinges.left_F_m = {geometry.toe.hinge_from_heel_m - 0.5 * geometry.middle.length_m,
                          geometry.toe.hinge_lateral_m, 0.0};
}

}  // namespace

void Foot::validate() const {
  if (!(mass_kg > 0.0)) {
    throw std::invalid_argument("mass_kg = " + std::to_string(mass_kg) + ": must be above 0");
  }
  if (find_mesh_fault(middle))
    throw std::invalid_argument("middle: " + find_mesh_fault(middle)->text);
  if (!has_toes) return;
  for (const TriangleMesh* toe : {&left_toe, &right_toe}) {
    if (const auto fault = find_mesh_fault(*toe))
      throw std::invalid_argument("toe: " + fault->text);
  }
  if (!(hinges.min_opening_rad < hinges.max_opening_rad)) {
    throw std::invalid_argument("min_opening: must be below max_opening");
  }
}

Foot with_worn_spines(Foot foot, double loss_m) {
  if (!foot.geometry.has_spines) {
    throw std::invalid_argument("the foot '" + foot.name + "' has no spines that could wear");
  }
  if (loss_m == 0.0) return foot;
  SpineGeometry& spines = foot.geometry.spines;
  const double share = loss_m / spines.length_m;
  foot.geometry.has_spines = share < 1.0;
  if (foot.geometry.has_spines) {
    spines.tip_m += share * (spines.base_m - spines.tip_m);
    spines.length_m -= loss_m;
  }
  make_meshes(foot);
  return foot;
}

Foot read_foot(Reader section) {
  Foot foot;
  section.text("name", foot.name);
  section.number("mass_kg", foot.mass_kg, kKilogram, 0.01, 50.0);
  if (section.has("mesh_file") || section.has("mesh_unit")) {
    read_mesh_file(section, foot);
  } else {
    read_parts(section, foot);
  }
  section.check([&foot] { foot.validate(); });
  return foot;
}

std::vector<std::string> foot_overrides(const std::string& name_or_stl_file) {
  std::string end = name_or_stl_file.substr(std::max<std::size_t>(name_or_stl_file.size(), 4) - 4);
  std::transform(end.begin(), end.end(), end.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (end != ".stl") return {"use.foot=" + to_text(name_or_stl_file)};
  return {"use.foot=\"stl\"", "foot.mesh_file=" + to_text(name_or_stl_file)};
}

}  // namespace hoof::sim
