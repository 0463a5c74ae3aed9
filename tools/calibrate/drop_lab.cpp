#include "tools/calibrate/drop_lab.h"

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

namespace hoof::tools {
namespace {

constexpr int kStepsALook = 18;     // 50 us; a flight bends by 3 nm in that
constexpr double kBelow_m = 6e-3;   // the plate goes on so far below the middle of the impacts
constexpr double kAbove_m = 30e-3;  // and above

/// One grain on its way.
class Faller {
 public:
  Faller(const PlateFrame& plate, double height_after_m, const sim::Grain& start)
      : plate_(plate),
        // Where the middle one of the impacts has its centre.
        landing_z_m_(start.radius_m / plate.normal.z() - height_after_m),
        last_(start) {}

  void look(const sim::Grain& now) {
    if (landed()) return;
    const double gap_m = gap(now);
    if (!before_ && gap_m <= 0) before_ = at_contact(last_, -1);
    if (before_ && !after_ && gap_m > 0 && now.v_m_s.dot(plate_.normal) > 0) {
      after_ = at_contact(now, 1);
      rim_m_s_ = now.radius_m * now.w_rad_s.y();
    }
    if (now.p_m.z() <= landing_z_m_) {
      const double share = (last_.p_m.z() - landing_z_m_) / (last_.p_m.z() - now.p_m.z());
      travel_m_ = last_.p_m.x() + share * (now.p_m.x() - last_.p_m.x());
    }
    last_ = now;
  }

  bool landed() const { return travel_m_.has_value(); }
  bool bounced() const { return after_.has_value(); }
  double travel_m() const { return *travel_m_; }
  double kept_normal() const { return -after_->normal_m_s / before_->normal_m_s; }
  double kept_tangential() const { return after_->tangential_m_s / before_->tangential_m_s; }
  double rim_share() const { return rim_m_s_ / before_->tangential_m_s; }

 private:
  struct Speeds {
    double normal_m_s, tangential_m_s;
  };

  double gap(const sim::Grain& g) const { return g.p_m.dot(plate_.normal) - g.radius_m; }

  /// Speeds where the flight through this state touches the plate: `sign` -1 on its way down.
  Speeds at_contact(const sim::Grain& g, double sign) const {
    const double pull_m_s2 = kGravity_m_s2 * plate_.normal.z();
    const double n = g.v_m_s.dot(plate_.normal);
    const double at_plate = sign * std::sqrt(n * n + 2 * pull_m_s2 * gap(g));
    const double later_s = (n - at_plate) / pull_m_s2;
    return {at_plate, g.v_m_s.dot(plate_.downhill) - kGravity_m_s2 * plate_.downhill.z() * later_s};
  }

  PlateFrame plate_;
  double landing_z_m_;
  sim::Grain last_;
  std::optional<Speeds> before_, after_;
  double rim_m_s_ = 0;
  std::optional<double> travel_m_;
};

std::vector<LaneStart> starts_of(const DropTest& test, const PlateFrame& plate) {
  sim::Random random(test.seed);
  std::vector<LaneStart> starts;
  for (const double d_m : lab_diameters(test.grains)) {
    const double x_m = test.spread_m * random.between(-1, 1);
    starts.push_back({d_m, {x_m, 0, d_m / 2 / plate.normal.z() + test.height_m}});
  }
  return starts;
}

}  // namespace

void DropTest::validate() const {
  require_within("height", 1e3 * height_m, 5, 1000, "mm");
  require_within("height-after", 1e3 * height_after_m, 5, 1000, "mm");
  require_within("plate", plate_rad * 180 / std::numbers::pi, 10, 80, "deg");
  require_within("grains", grains, 1, 10000, "");
  require_within("spread", 1e3 * spread_m, 0, 3, "mm");
  const double fall_m = height_m - spread_m * std::tan(plate_rad);
  require_within("height less what the spread takes of it", 1e3 * fall_m, 2, 1000, "mm");
}

DropOutcome drop(const sim::Materials& materials, const DropTest& test) {
  test.validate();
  const PlateFrame plate(test.plate_rad);
  const auto starts = starts_of(test, plate);
  const double speed_m_s = std::sqrt(2 * kGravity_m_s2 * (test.height_m + 0.02));
  const double longest_s =
      2 * (speed_m_s + std::sqrt(speed_m_s * speed_m_s + 2 * kGravity_m_s2 * test.height_after_m)) /
      kGravity_m_s2;
  const double deepest_m = 0.5 * kGravity_m_s2 * longest_s * longest_s + test.height_after_m;
  LaneBed bed(materials, starts, {test.plate_rad, kAbove_m, kBelow_m}, -deepest_m,
              2 * test.height_m + 0.05, 2 * speed_m_s * longest_s);
  std::vector<Faller> fallers;
  for (const sim::Grain& g : bed.grains()) fallers.emplace_back(plate, test.height_after_m, g);
  const auto all_landed = [&] {
    return std::all_of(fallers.begin(), fallers.end(), [](const Faller& f) { return f.landed(); });
  };
  const int looks = int(std::ceil(longest_s / (kStepsALook * kLabStep_s)));
  for (int i = 0; i < looks && !all_landed(); ++i) {
    bed.advance(kStepsALook);
    const auto grains = bed.grains();
    for (std::size_t k = 0; k < grains.size(); ++k) fallers[k].look(grains[k]);
  }
  DropOutcome out;
  for (const Faller& f : fallers) {
    if (!f.bounced() || !f.landed()) {
      throw std::runtime_error("drop: a grain stays on the plate (restitution " +
                               std::to_string(materials.sand_abs.restitution.value) + ", plate " +
                               std::to_string(test.plate_rad) + " rad)");
    }
    out.travel_m.push_back(f.travel_m());
    out.kept_normal += f.kept_normal() / double(fallers.size());
    out.kept_tangential += f.kept_tangential() / double(fallers.size());
    out.rim_share += f.rim_share() / double(fallers.size());
  }
  return out;
}

}  // namespace hoof::tools
