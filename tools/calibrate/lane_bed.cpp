#include "tools/calibrate/lane_bed.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sim/config/settings.h"
#include "sim/terrain/bed_grading.h"
#include "tools/calibrate/lab_formulas.h"

namespace hoof::tools {
namespace {

constexpr double kAlone_m = 4e-3;
constexpr double kCell_m = 0.02;  // few grains far apart: wide cells are quick to clear
constexpr double kMargin_m = 0.05;

sim::ElasticMaterial elastic(const sim::Material& m) {
  return {m.young_Pa.value, m.poisson.value, m.density_kg_m3.value};
}

sim::PairCoefficients pair(const sim::ContactPair& p) {
  return {p.restitution.value, p.static_friction.value, p.rolling_friction.value};
}

double largest_diameter_m(const std::vector<LaneStart>& starts) {
  double largest_m = 0;
  for (const LaneStart& s : starts) largest_m = std::max(largest_m, s.diameter_m);
  return largest_m;
}

/// A block of 20 mm under its upper face z = 0.
sim::TriangleMesh block(double x0_m, double x1_m, double half_width_m) {
  sim::TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices_m.emplace_back(i & 1 ? x1_m : x0_m, i & 2 ? half_width_m : -half_width_m,
                                 i & 4 ? 0 : -0.02);
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

sim::SandBed make(const sim::Materials& materials, const std::vector<LaneStart>& starts,
                  double pitch_m, double low_z_m, double high_z_m, double far_x_m) {
  sim::DemSettings s = lab_settings(materials);
  s.precision = sim::Precision::kDouble;
  s.cell_m = std::max(kCell_m, 2 * largest_diameter_m(starts));
  const double half_width_m = 0.5 * pitch_m * double(starts.size());
  s.low_m = {-far_x_m - kMargin_m, -half_width_m - kMargin_m, low_z_m - kMargin_m};
  s.high_m = {far_x_m + kMargin_m, half_width_m + kMargin_m, high_z_m + kMargin_m};
  sim::BedState state;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    sim::Grain g;
    g.id = std::uint32_t(i);
    g.radius_m = starts[i].diameter_m / 2;
    g.p_m = starts[i].p_m;
    g.p_m.y() = pitch_m * (double(i) + 0.5) - half_width_m;
    state.grains.push_back(g);
  }
  return {s, state};
}

}  // namespace

sim::DemSettings lab_settings(const sim::Materials& materials) {
  sim::DemSettings s;
  s.grain_material = elastic(materials.sand);
  s.wall_material = elastic(materials.abs);
  s.grain_grain = pair(materials.sand_sand);
  s.grain_wall = pair(materials.sand_abs);
  s.gravity_m_s2 = {0, 0, -kGravity_m_s2};
  s.dt_s = kLabStep_s;
  return s;
}

PlateFrame::PlateFrame(double tilt_rad)
    : downhill(std::cos(tilt_rad), 0, -std::sin(tilt_rad)),
      normal(std::sin(tilt_rad), 0, std::cos(tilt_rad)) {}

LaneBed::LaneBed(const sim::Materials& materials, const std::vector<LaneStart>& starts,
                 const Plate& plate, double low_z_m, double high_z_m, double far_x_m)
    : pitch_m_(1.5 * largest_diameter_m(starts)),
      count_(starts.size()),
      bed_(make(materials, starts, pitch_m_, low_z_m, high_z_m, far_x_m)) {
  bed_.add_mesh(block(-plate.up_m, plate.down_m, 0.5 * pitch_m_ * double(count_) + kMargin_m),
                Eigen::Vector3d::Zero(),
                Eigen::Quaterniond(Eigen::AngleAxisd(plate.tilt_rad, Eigen::Vector3d::UnitY())));
}

double LaneBed::lane_y_m(std::size_t lane) const {
  return pitch_m_ * (double(lane) + 0.5 - 0.5 * double(count_));
}

std::vector<sim::Grain> LaneBed::grains() const {
  std::vector<sim::Grain> grains = bed_.state().grains;
  for (std::size_t i = 0; i < grains.size(); ++i) grains[i].p_m.y() -= lane_y_m(i);
  return grains;
}

std::vector<double> lab_diameters(int n) {
  if (n == 1) return {kAlone_m};
  const sim::Settings paper =
      sim::Settings::load_file(sim::default_config_dir() / "beds" / "paper.toml");
  return sim::graded_diameters(sim::read_bed(sim::Reader(paper)), std::size_t(n));
}

double grain_mass_kg(const sim::Materials& materials, double radius_m) {
  return materials.sand.density_kg_m3.value * sim::sphere_m3(2 * radius_m);
}

double resting_overlap_m(const sim::Materials& materials, double radius_m, double force_N) {
  const sim::DemSettings s = lab_settings(materials);
  const auto law = sim::make_pair_law(s.grain_material, s.wall_material, s.grain_wall);
  return std::pow(3 * force_N / (4 * law.E_eff_Pa * std::sqrt(radius_m)), 2.0 / 3.0);
}

}  // namespace hoof::tools
