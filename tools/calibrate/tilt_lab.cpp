#include "tools/calibrate/tilt_lab.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "sim/dem/sand_bed.h"
#include "tools/calibrate/lab_formulas.h"
#include "tools/calibrate/lab_rules.h"
#include "tools/calibrate/lane_bed.h"
#include "tools/run/csv_writer.h"

namespace hoof::tools {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr int kStepsATurn = 180;  // 0.5 ms: gravity turns by 1e-3 degrees at 2 degrees a second
constexpr double kSteepest_rad = 80 * kDegree;
constexpr double kHeldRolling = 10;  // above every mu_s that is allowed: nothing turns
constexpr double kQuick_rad_s = 40 * kDegree;
constexpr double kBelow_rad = 2.5 * kDegree;  // the quick tilt is late by 1 to 2 degrees
constexpr double kFirst = 0.02;  // of seen_m: above the elastic give of the contact, some 10 nm

struct SlideRecord {
  std::vector<double> tilt_rad, root;  // root: cube root of the slide over seen_m
  double last_m = 0, last_rad = 0;
  bool seen = false;
  double seen_rad = 0;

  void look(double slid_m, double tilted_rad, double seen_m) {
    if (seen) return;
    if (slid_m >= kFirst * seen_m) {
      tilt_rad.push_back(tilted_rad);
      root.push_back(std::cbrt(slid_m / seen_m));
    }
    if (slid_m >= seen_m) {
      seen = true;
      seen_rad = last_rad + (seen_m - last_m) / (slid_m - last_m) * (tilted_rad - last_rad);
    }
    last_m = slid_m, last_rad = tilted_rad;
  }

  /// Where the straight line through tilt over root has root 0.
  double onset_rad() const {
    const double n = double(root.size());
    double x = 0, y = 0, xx = 0, xy = 0;
    for (std::size_t i = 0; i < root.size(); ++i) {
      const double turned = tilt_rad[i] - seen_rad;  // about there, against cancellation
      x += root[i], y += turned, xx += root[i] * root[i], xy += root[i] * turned;
    }
    const double slope = (n * xy - x * y) / (n * xx - x * x);
    return root.size() < 3 ? seen_rad : seen_rad + (y - slope * x) / n;
  }
};

sim::Materials with_held_rotation(sim::Materials materials) {
  materials.sand_abs.rolling_friction.value = kHeldRolling;
  return materials;
}

/// Downhill is +x: the plate stays z = 0.
Eigen::Vector3d gravity(double tilt_rad) {
  return kGravity_m_s2 * Eigen::Vector3d(std::sin(tilt_rad), 0, -std::cos(tilt_rad));
}

struct Start {
  sim::DemSettings settings;
  sim::BedState state;
};

Start start_of(const sim::Materials& materials, const TiltTest& test) {
  const sim::Materials held = with_held_rotation(materials);
  Start start{lab_settings(held), {}};
  sim::DemSettings& s = start.settings;
  s.precision = sim::Precision::kDouble;
  s.walls = {{Eigen::Vector3d::UnitZ(), 0}};
  s.gravity_m_s2 = gravity(test.from_rad);
  s.cell_m = 0.02;
  const std::vector<double> diameters = lab_diameters(test.grains);
  const double pitch_m = 1.5 * diameters.back();
  const double half_m = 0.5 * pitch_m * double(diameters.size()) + 0.02;
  s.low_m = {-0.1, -half_m, -0.05};
  s.high_m = {0.1 + 10 * test.seen_m, half_m, 0.05};
  for (std::size_t i = 0; i < diameters.size(); ++i) {
    sim::Grain g;
    g.id = std::uint32_t(i);
    g.radius_m = diameters[i] / 2;
    const double press_N =
        grain_mass_kg(held, g.radius_m) * kGravity_m_s2 * std::cos(test.from_rad);
    g.p_m = {0, pitch_m * (double(i) + 0.5 - 0.5 * double(diameters.size())),
             g.radius_m - resting_overlap_m(held, g.radius_m, press_N)};
    start.state.grains.push_back(g);
  }
  return start;
}

}  // namespace

void TiltTest::validate() const {
  require_within("from", from_rad / kDegree, 0, 75, "deg");
  require_within("rate", rate_rad_s / kDegree, 0.05, 100, "deg/s");
  require_within("seen", 1e3 * seen_m, 1e-3, 5, "mm");
  require_within("grains", grains, 1, 10000, "");
}

TiltOutcome tilt(const sim::Materials& materials, const TiltTest& test) {
  test.validate();
  Start at = start_of(materials, test);
  std::vector<SlideRecord> records(at.state.grains.size());
  const auto all_seen = [&] {
    return std::all_of(records.begin(), records.end(), [](const SlideRecord& r) { return r.seen; });
  };
  double tilt_rad = test.from_rad;
  for (long turn = 0; !all_seen(); ++turn) {
    const double time_s = double(turn) * kStepsATurn * kLabStep_s;
    // During the turn gravity stands as at its middle. A bed has one gravity, so the next one goes
    // on from the state of the last, springs of the contacts included.
    const double middle_s = time_s + 0.5 * kStepsATurn * kLabStep_s;
    at.settings.gravity_m_s2 = gravity(test.from_rad + test.rate_rad_s * middle_s);
    sim::SandBed bed(at.settings, at.state);
    bed.advance(kStepsATurn);
    at.state = bed.state();
    tilt_rad = test.from_rad + test.rate_rad_s * (time_s + kStepsATurn * kLabStep_s);
    if (tilt_rad > kSteepest_rad) {
      throw std::runtime_error("tilt: at 80 degrees a grain has not slid by " +
                               format_number(1e3 * test.seen_m) + " mm (static friction " +
                               format_number(materials.sand_abs.static_friction.value) + ")");
    }
    for (std::size_t i = 0; i < records.size(); ++i) {
      records[i].look(at.state.grains[i].p_m.x(), tilt_rad, test.seen_m);
    }
  }
  TiltOutcome out;
  for (const SlideRecord& r : records) {
    out.seen_rad.push_back(r.seen_rad);
    out.onset_rad.push_back(r.onset_rad());
  }
  return out;
}

TiltOutcome tilt_in_two(const sim::Materials& materials, const TiltTest& test) {
  TiltTest quick = test;
  quick.from_rad = 0;
  quick.rate_rad_s = std::max(kQuick_rad_s, test.rate_rad_s);
  quick.grains = 1;  // they all slide at the same tilt
  TiltTest slow = test;
  slow.from_rad = std::max(0.0, tilt(materials, quick).onset_rad.front() - kBelow_rad);
  return tilt(materials, slow);
}

}  // namespace hoof::tools
