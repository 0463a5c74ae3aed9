#include "tools/bed/export_bed.h"

#include <Eigen/Geometry>
#include <iostream>
#include <numbers>

#include "sim/multibody/foot.h"
#include "tools/bed/grain_export.h"
#include "tools/experiment/run_settings.h"
#include "tools/run/errors.h"

namespace hoof::tools {
namespace {

GrainSelection selection_of(const ExportBedOptions& options) {
  GrainSelection selection;
  selection.every = std::uint32_t(options.every);
  if (options.region_mm.empty()) return selection;
  const std::vector<double>& mm = options.region_mm;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (mm[2 * axis] < mm[2 * axis + 1]) continue;
    throw UserError("--region: from " + std::to_string(mm[2 * axis]) + " to " +
                    std::to_string(mm[2 * axis + 1]) + " mm along " + "xyz"[axis] +
                    ": the first must be under the second");
  }
  selection.region = {Eigen::Vector3d(mm[0], mm[2], mm[4]) * 1e-3,
                      Eigen::Vector3d(mm[1], mm[3], mm[5]) * 1e-3};
  return selection;
}

void add_foot(const ExportBedOptions& options, VtkSeries& series) {
  std::vector<std::string> overrides = sim::foot_overrides(options.foot);
  overrides.push_back("experiment.toe_deg=" + std::to_string(options.toe_deg));
  const sim::Foot foot = read_run_settings("sinkage", overrides).foot;
  const Eigen::Vector3d up(0, 0, options.foot_height_mm * 1e-3);
  const Eigen::Quaterniond straight = Eigen::Quaterniond::Identity();
  series.add(0, "foot-middle", mesh_triangles(foot.middle, up, straight));
  if (!foot.has_toes) return;
  const double toe_rad = options.toe_deg * std::numbers::pi / 180;
  const auto turned = [](double angle_rad) {  // the left toe opens to +y
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()));
  };
  const Eigen::Vector3d left_m = foot.hinges.left_F_m;
  const Eigen::Vector3d right_m(left_m.x(), -left_m.y(), left_m.z());
  series.add(0, "foot-left", mesh_triangles(foot.left_toe, up + left_m, turned(toe_rad)));
  series.add(0, "foot-right", mesh_triangles(foot.right_toe, up + right_m, turned(-toe_rad)));
}

}  // namespace

void export_bed(const ExportBedOptions& options) {
  if (options.csv.empty() && options.vtk.empty()) {
    throw UserError("bed export: --csv FILE or --vtk DIR is required");
  }
  const GrainSelection selection = selection_of(options);
  const OpenedBed opened = open_bed(options.bed);
  const sim::DemSettings dem = sim::dem_settings(opened.origin.bed, opened.origin.materials, 1);
  if (!options.csv.empty()) {
    write_grain_csv(options.csv, dem, opened.state, selection);
    std::cout << options.csv.string() << "\n";
  }
  if (options.vtk.empty()) return;
  VtkSeries series(options.vtk, "bed");
  series.add(0, "grains", grain_points(dem, opened.state, selection));
  series.add(0, "contacts", contact_lines(dem, opened.state, selection));
  if (!options.foot.empty()) add_foot(options, series);
  std::cout << series.collection().string() << "\n";
}

}  // namespace hoof::tools
