#include "tools/calibrate/roll_lab.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>

#include "sim/terrain/random.h"
#include "tools/calibrate/lab_formulas.h"
#include "tools/calibrate/lab_rules.h"
#include "tools/calibrate/lane_bed.h"
#include "tools/run/csv_writer.h"

namespace hoof::tools {
namespace {

constexpr int kStepsALook = 18;      // 50 us
constexpr double kBehind_m = 15e-3;  // the incline goes on so far behind the release
constexpr double kLongest_s = 4;     // just short of tan(incline) a grain hardly moves

/// One grain on its way. The edge is the origin, the incline ends there.
class Roller {
 public:
  Roller(const PlateFrame& plate, double fall_m, const sim::Grain& start)
      : plate_(plate), fall_m_(fall_m), last_(start) {}

  void look(const sim::Grain& now) {
    if (landed()) return;
    const double was_m = way(last_), is_m = way(now);
    if (!over_edge_ && is_m >= 0) {
      const double share = -was_m / (is_m - was_m);
      over_edge_ = last_.p_m + share * (now.p_m - last_.p_m);
      edge_speed_m_s_ = (last_.v_m_s + share * (now.v_m_s - last_.v_m_s)).dot(plate_.downhill);
      const double spin = last_.w_rad_s.y() + share * (now.w_rad_s.y() - last_.w_rad_s.y());
      rim_m_s_ = spin * now.radius_m;
    }
    if (over_edge_ && now.p_m.z() <= over_edge_->z() - fall_m_) {
      const double z_m = over_edge_->z() - fall_m_;
      const double share = (last_.p_m.z() - z_m) / (last_.p_m.z() - now.p_m.z());
      travel_m_ = last_.p_m.x() + share * (now.p_m.x() - last_.p_m.x()) - over_edge_->x();
    }
    last_ = now;
  }

  bool left() const { return over_edge_.has_value(); }
  bool landed() const { return travel_m_.has_value(); }
  double travel_m() const { return *travel_m_; }
  double edge_speed_m_s() const { return edge_speed_m_s_; }
  double rim_share() const { return rim_m_s_ / edge_speed_m_s_; }

 private:
  double way(const sim::Grain& g) const { return g.p_m.dot(plate_.downhill); }

  PlateFrame plate_;
  double fall_m_;
  sim::Grain last_;
  std::optional<Eigen::Vector3d> over_edge_;
  double edge_speed_m_s_ = 0, rim_m_s_ = 0;
  std::optional<double> travel_m_;
};

/// At rest on the incline, as deep in it as their weight presses them.
std::vector<LaneStart> starts_of(const sim::Materials& materials, const RollTest& test,
                                 const PlateFrame& plate) {
  sim::Random random(test.seed);
  std::vector<LaneStart> starts;
  for (const double d_m : lab_diameters(test.grains)) {
    const double run_m = test.run_m + test.spread_m * random.between(-1, 1);
    const double weight_N = grain_mass_kg(materials, d_m / 2) * kGravity_m_s2;
    const double overlap_m = resting_overlap_m(materials, d_m / 2, weight_N * plate.normal.z());
    starts.push_back({d_m, -run_m * plate.downhill + (d_m / 2 - overlap_m) * plate.normal});
  }
  return starts;
}

}  // namespace

void RollTest::validate() const {
  require_within("incline", incline_rad * 180 / std::numbers::pi, 5, 80, "deg");
  require_within("run", 1e3 * run_m, 5, 1000, "mm");
  require_within("fall", 1e3 * fall_m, 5, 1000, "mm");
  require_within("grains", grains, 1, 10000, "");
  require_within("spread", 1e3 * spread_m, 0, 1e3 * run_m / 2, "mm");
}

void require_rolling(const sim::Materials& materials, const RollTest& test) {
  test.validate();
  const double mu_r = materials.sand_abs.rolling_friction.value;
  if (mu_r >= 0.98 * std::tan(test.incline_rad)) {
    throw std::invalid_argument("rolling friction " + format_number(mu_r) +
                                " holds a grain on an incline of " +
                                format_number(test.incline_rad * 180 / std::numbers::pi) +
                                " deg (must be under 0.98 tan of it)");
  }
}

RollOutcome roll(const sim::Materials& materials, const RollTest& test) {
  require_rolling(materials, test);
  const PlateFrame plate(test.incline_rad);
  // What a frictionless slide gives bounds speed and way.
  const double fastest_m_s =
      std::sqrt(2 * kGravity_m_s2 *
                ((test.run_m + test.spread_m) * std::sin(test.incline_rad) + test.fall_m));
  const double reach_m = 0.5 + 4 * fastest_m_s * fastest_m_s / kGravity_m_s2;
  const double top_m = (test.run_m + test.spread_m + kBehind_m) * std::sin(test.incline_rad);
  LaneBed bed(materials, starts_of(materials, test, plate),
              {test.incline_rad, test.run_m + test.spread_m + kBehind_m, 0}, -test.fall_m - reach_m,
              top_m + 0.02, test.run_m + reach_m);
  std::vector<Roller> rollers;
  for (const sim::Grain& g : bed.grains()) rollers.emplace_back(plate, test.fall_m, g);
  const int looks = int(std::ceil(kLongest_s / (kStepsALook * kLabStep_s)));
  const auto all_landed = [&] {
    return std::all_of(rollers.begin(), rollers.end(), [](const Roller& r) { return r.landed(); });
  };
  for (int i = 0; i < looks && !all_landed(); ++i) {
    bed.advance(kStepsALook);
    const auto grains = bed.grains();
    for (std::size_t k = 0; k < grains.size(); ++k) rollers[k].look(grains[k]);
  }
  RollOutcome out;
  for (const Roller& r : rollers) {
    if (!r.landed()) {
      throw std::runtime_error(std::string("roll: a grain has not ") +
                               (r.left() ? "landed" : "come to the edge") + " within 4 s");
    }
    out.travel_m.push_back(r.travel_m());
    out.edge_speed_m_s += r.edge_speed_m_s() / double(rollers.size());
    out.rim_share += r.rim_share() / double(rollers.size());
  }
  return out;
}

}  // namespace hoof::tools
