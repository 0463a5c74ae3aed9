// The single-grain laboratories, held to closed forms.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "sim/config/settings.h"
#include "tools/calibrate/drop_lab.h"
#include "tools/calibrate/lab_formulas.h"
#include "tools/calibrate/roll_lab.h"
#include "tools/calibrate/tilt_lab.h"
#include "tools/study/drop_law.h"

using namespace hoof;
using namespace hoof::tools;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

sim::Materials sand(double e, double mu_s, double mu_r) {
  const sim::Settings paper =
      sim::Settings::load_file(sim::default_config_dir() / "materials" / "paper.toml");
  sim::Materials m = sim::read_materials(sim::Reader(paper));
  m.sand_abs.restitution.value = e;
  m.sand_abs.static_friction.value = mu_s;
  m.sand_abs.rolling_friction.value = mu_r;
  return m;
}

}  // namespace

TEST_CASE("probe") {
  for (const double e : {0.35, 0.5636, 0.65}) {
    for (const double mu : {0.0, 0.5929}) {
      const DropOutcome o = drop(sand(e, mu, 0.0408), {});
      WARN("e " << e << " mu " << mu << " L " << 1e3 * o.travel_m[0] << " kn " << o.kept_normal
                << " kt " << o.kept_tangential << " rim " << o.rim_share << " law "
                << drop_travel(e, 1, 40.42, 40.42) << " "
                << drop_travel(e, o.kept_tangential, 40.42, 40.42));
    }
  }
  for (const double mu_r : {0.01, 0.0408, 0.3}) {
    const RollOutcome o = roll(sand(0.5636, 0.5929, mu_r), {});
    WARN("mu_r " << mu_r << " S2 " << 1e3 * o.travel_m[0] << " law "
                 << 1e3 * roll_travel_m(45 * kDegree, 0.0496, 0.0643, mu_r) << " v "
                 << o.edge_speed_m_s << " rim " << o.rim_share);
  }
  for (const double mu : {0.375, 0.5929}) {
    const TiltOutcome o = tilt_in_two(sand(0.5636, mu, 0.0408), {});
    WARN("mu " << mu << " seen " << o.seen_rad[0] / kDegree << " onset "
               << o.onset_rad[0] / kDegree << " atan " << std::atan(mu) / kDegree);
  }
}
