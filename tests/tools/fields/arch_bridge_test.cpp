// Chains of grains between the parts of a foot, made by hand, and the flow that counts them.

#include "tools/fields/arch_bridge.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "sim/terrain/random.h"
#include "tests/tools/fields/made_scene.h"
#include "tools/fields/max_flow.h"

using namespace hoof;
using namespace hoof::tests;
using namespace hoof::tools;

namespace {

constexpr double kStrong_m = 8e-6, kWeak_m = 1e-6;  // overlaps: forces as 23 to 1

/// Two boxes with a gap of 10 mm along y, and a chain of four grains across it, from under the one
/// (y > 5 mm) to under the other. The grains in the middle are in the gap.
void add_chain(Made& made, double x_m, double overlap_m, int contacts = 3) {
  const double pitch_m = 4e-3 - overlap_m;
  std::uint32_t last = 0;
  for (int k = 0; k < 4; ++k) {
    const auto id = made.grain({x_m, (k - 1.5) * pitch_m, -4e-3});
    if (k > 0 && k <= contacts) made.contact(last, id);
    last = id;
  }
}

Made two_boxes() {
  return Made({box_mesh({-0.03, -0.03, 0}, {0.03, -0.005, 0.01}),
               box_mesh({-0.03, 0.005, 0}, {0.03, 0.03, 0.01})});
}

/// Cuts of all subsets of the nodes: the least one is the largest flow.
std::int64_t least_cut(int nodes, const std::vector<std::array<std::int64_t, 3>>& edges) {
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  for (unsigned set = 0; set < 1u << nodes; ++set) {
    if (!(set & 1) || set >> (nodes - 1) & 1) continue;  // holds 0, not the last
    std::int64_t cut = 0;
    for (const auto& [a, b, c] : edges) {
      if ((set >> a & 1) != (set >> b & 1)) cut += c;
    }
    least = std::min(least, cut);
  }
  return least;
}

}  // namespace

TEST_CASE("the largest flow is the least cut, in random graphs") {
  const std::uint64_t seed = GENERATE(range(1, 60));
  CAPTURE(seed);
  sim::Random random(seed);
  const int nodes = 2 + int(random.between(0, 7));
  std::vector<std::array<std::int64_t, 3>> edges;
  MaxFlow flow(nodes);
  for (int k = int(random.between(0, 20)); k > 0; --k) {
    const int a = int(random.between(0, nodes - 1e-9)), b = int(random.between(0, nodes - 1e-9));
    const auto c = std::int64_t(random.between(0, 9));
    if (a == b) continue;
    edges.push_back({a, b, c});
    flow.add_edge(a, b, c);
  }
  CHECK(flow.between(0, nodes - 1) == least_cut(nodes, edges));
}

TEST_CASE("strong chains over a gap are counted, weak and broken ones are not") {
  Made made = two_boxes();
  add_chain(made, -0.02, kStrong_m);
  add_chain(made, -0.01, kWeak_m);
  add_chain(made, 0.00, kStrong_m, 2);  // its last contact is missing
  add_chain(made, 0.01, kStrong_m);
  // A strong one whose middle grain lies beside the boxes' ends, out of the gap.
  const double pitch_m = 4e-3 - kStrong_m, out_m = std::sqrt(pitch_m * pitch_m - 6.25e-6);
  std::uint32_t last = 0;
  for (const Eigen::Vector2d& p :
       {Eigen::Vector2d(0, -2.5e-3 - pitch_m), Eigen::Vector2d(0, -2.5e-3),
        Eigen::Vector2d(out_m, 0), Eigen::Vector2d(0, 2.5e-3),
        Eigen::Vector2d(0, 2.5e-3 + pitch_m)}) {
    const auto id = made.grain({0.0275 + p.x(), p.y(), -4e-3});
    if (p.y() > -2.5e-3 - pitch_m) made.contact(last, id);
    last = id;
  }
  // Others that are weak, so that the mean lies between.
  for (double x_m = -0.028; x_m < 0.03; x_m += 0.009) {
    made.contact(made.grain({x_m, 0.015, -4e-3}), made.grain({x_m, 0.018999, -4e-3}));
  }
  const FieldScene scene(made.setting, made.moment);
  const ArchBridge arch = arch_bridge(scene);
  CHECK(arch.gap_area_m2 == Approx(0.06 * 0.01));
  CHECK(arch.paths == 2);
  CHECK(arch.force_N == Approx(2 * hertz_N(2e-3, kStrong_m)).epsilon(1e-5));
}

TEST_CASE("a chain that hangs on the foot itself counts, either way round") {
  const double side = GENERATE(-1.0, 1.0);
  Made made = two_boxes();
  // A grain in the gap that both boxes press on from their sides, at z = 2 mm above the soles.
  for (sim::Pose& pose : made.moment.poses) pose.p_WB_m.z() = 0;
  const auto wedged = made.grain({0, side * 1e-3, -1e-3}, 4.5e-3);
  const auto weak = made.grain({0.01, 0.02, -1e-3});
  made.press(wedged, 0, 0, {0, -0.005, 0}, 40);
  made.press(wedged, 1, 0, {0, 0.005, 0}, 30);
  made.press(weak, 1, 0, {0.01, 0.02, 0}, 0.1);
  const ArchBridge arch = arch_bridge(FieldScene(made.setting, made.moment));
  CHECK(arch.paths == 1);
  CHECK(arch.force_N == Approx(30));
}

TEST_CASE("a foot in one piece bridges nothing") {
  Made made({box_mesh({-0.03, -0.03, 0}, {0.03, 0.03, 0.01})});
  add_chain(made, 0, kStrong_m);
  const ArchBridge arch = arch_bridge(FieldScene(made.setting, made.moment));
  CHECK(arch.gap_area_m2 == 0);
  CHECK(arch.paths == 0);
  CHECK(arch.force_N == 0);
}

TEST_CASE("the strong network holds what presses with more than the mean") {
  Made made({box_mesh({-0.03, -0.03, 0}, {0.03, 0.03, 0.01})});
  add_chain(made, 0, kStrong_m);
  add_chain(made, 0.01, kWeak_m);
  const ForceChains c = force_chains(FieldScene(made.setting, made.moment));
  const double strong_N = hertz_N(2e-3, kStrong_m), weak_N = hertz_N(2e-3, kWeak_m);
  CHECK(c.contacts == 6);
  CHECK(c.strong == 3);
  CHECK(c.mean_N == Approx(0.5 * (strong_N + weak_N)));
  CHECK(c.largest_N == Approx(strong_N));
  CHECK(c.strong_share == Approx(strong_N / (strong_N + weak_N)));
}
