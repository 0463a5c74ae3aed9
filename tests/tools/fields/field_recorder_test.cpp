// Which moments of a run are kept, on a path that is made up, over a bed that is stepped; cut off
// and gone on with anywhere, the same moments come of it.

#include "tools/fields/field_recorder.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "sim/multibody/prescribed_rig.h"
#include "tests/sim/multibody/shipped.h"
#include "tests/sim/terrain/small_bed.h"

using namespace hoof;
using namespace hoof::tools;

namespace {

sim::Observation at(int tick, double depth_m, double fx_N, double turns = 0.5) {
  sim::Observation o;
  o.time_s = 1e-3 * tick;
  o.phase = tick < 3 ? sim::Phase::kLowering : sim::Phase::kLoaded;
  o.depth_m = depth_m;
  o.ground_N = {fx_N, 0, 100};
  o.foot_m = {turns, 0, 0};  // read back by the plan below
  return o;
}

struct Bench {
  sim::SandBed bed{sim::dem_settings(sim::test::small_bed(), sim::test::shipped_materials(), 1),
                   sim::test::make_small_bed(sim::test::small_bed())};
  sim::PrescribedRig rig{sim::shipped_foot("traditional"), sim::shipped_leg(), {0.0, 0.02}};

  /// What a test of `ticks` ticks keeps, as names and times in ms; the recorder is thrown away
  /// after tick `cut` and made anew from its bytes.
  std::vector<std::pair<std::string, int>> kept(const FieldPlan& plan, int ticks, int cut,
                                                const auto& observe) {
    FieldRecorder recorder(plan);
    for (int tick = 0; tick < ticks; ++tick) {
      recorder.tick(observe(tick), rig, bed);
      if (tick != cut) continue;
      const std::string bytes = recorder.save();
      recorder = FieldRecorder(plan);
      recorder.restore(bytes);
      recorder.tick(observe(tick), rig, bed);  // as after Ctrl-C: the tick is seen twice
    }
    std::vector<std::pair<std::string, int>> found;
    for (const FieldMoment& m : recorder.finish(observe(ticks - 1), rig, bed)) {
      found.push_back({m.name, int(std::lround(1e3 * m.time_s))});
      CHECK(m.poses.size() == 1);
      CHECK(m.sand.grains.size() > 20);
      CHECK(m.sand.grains.size() < bed.grain_count());
    }
    return found;
  }
};

FieldPlan plan() {
  FieldPlan p;
  p.region_m = {Eigen::Vector3d(-0.01, -1, -1), Eigen::Vector3d(1, 1, 1)};
  return p;
}

using Kept = std::vector<std::pair<std::string, int>>;

}  // namespace

TEST_CASE("sinkage keeps contact, times since, the greatest depth and the end") {
  Bench bench;
  FieldPlan p = plan();
  p.after_contact_s = {0.004, 0.010, 0.5};
  // Deepest at tick 24; looked at every fifth tick from the third on.
  const auto observe = [](int tick) { return at(tick, 0.01 - 1e-5 * std::pow(tick - 24, 2), 0); };
  for (const int cut : {-1, 2, 3, 12, 23, 24, 39}) {
    CAPTURE(cut);
    CHECK(bench.kept(p, 40, cut, observe) == Kept{{"contact", 3},
                                                  {"after 4 ms", 7},
                                                  {"after 10 ms", 13},
                                                  {"greatest depth", 23},
                                                  {"end", 39}});
  }
}

TEST_CASE("traction keeps phases of the first stance and the peak of the mean of Fx") {
  Bench bench;
  FieldPlan p = plan();
  p.phases_turns = {0.1, 0.4, 0.5};
  p.turns = [](const Eigen::Vector3d& foot_m) { return foot_m.x(); };
  // A spike of one tick at 20 is no peak; the mean is largest about tick 48.
  const auto observe = [](int tick) {
    const double fx_N = tick == 20 ? 300 : 100 * std::exp(-std::pow((tick - 48) / 10.0, 2));
    return at(tick, 0.01, fx_N, 0.3 + 0.005 * tick);
  };
  for (const int cut : {-1, 19, 21, 43, 48, 50, 53, 89}) {
    CAPTURE(cut);
    CHECK(bench.kept(p, 90, cut, observe) ==
          Kept{{"contact", 3}, {"phase 0.40", 20}, {"phase 0.50", 40}, {"peak Fx", 48}});
  }
}

TEST_CASE("a foot that never touched leaves no moments") {
  Bench bench;
  const auto observe = [](int tick) {
    sim::Observation o = at(tick, 0, 0);
    o.phase = sim::Phase::kLowering;
    return o;
  };
  CHECK(bench.kept(plan(), 20, -1, observe).empty());
}
