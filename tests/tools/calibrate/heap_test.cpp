// Heaps: the fit on surfaces of known slope, the closed shapes of dish and funnel, and small heaps
// of grains that must not depend on threads or on being stopped.
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numbers>

#include "tests/tools/calibrate/lab_sand.h"
#include "tests/tools/run/scratch_folder.h"
#include "tools/calibrate/heap_angle.h"
#include "tools/calibrate/paper_tables.h"
#include "tools/calibrate/repose.h"
#include "tools/calibrate/repose_table.h"
#include "tools/run/output_file.h"
#include "tools/study/statistics.h"

using namespace hoof;
using namespace hoof::tools;
using hoof::tests::kDegree;

namespace {

constexpr double kDish_m = 0.04;

/// Small grains under a cone; its axis goes through (x, y), and it is turned about z.
std::vector<sim::Grain> cone(double angle_deg, double turn_rad = 0, double height_m = 0.06) {
  const double pitch_m = 0.7e-3, radius_m = 1e-3;
  std::vector<sim::Grain> grains;
  for (double x = -0.05; x <= 0.05; x += pitch_m) {
    for (double y = -0.05; y <= 0.05; y += pitch_m) {
      const double z = height_m - std::hypot(x, y) * std::tan(angle_deg * kDegree);
      sim::Grain g;
      g.radius_m = radius_m;
      g.p_m = {x * std::cos(turn_rad) - y * std::sin(turn_rad),
               x * std::sin(turn_rad) + y * std::cos(turn_rad), z};
      grains.push_back(g);
    }
  }
  return grains;
}

/// A heap of a second's work, the least that makes one.
ReposeSettings small() {
  ReposeSettings s;
  s.test.grains = 220;
  s.test.drop = 1.1;
  s.test.outlet_m = 0.026;
  s.test.step_s = 8e-6;
  s.seeds = 2;
  return s;
}

const sim::Materials kPaper = lab_materials("", {}, &sim::Materials::sand_sand);

bool same(const HeapResult& a, const HeapResult& b) {
  return a.angle.ring_deg == b.angle.ring_deg && a.angle.outline_deg == b.angle.outline_deg &&
         a.angle.sides_deg == b.angle.sides_deg && a.angle.height_m == b.angle.height_m &&
         a.angle.radius_m == b.angle.radius_m && a.angle.grains_in_it == b.angle.grains_in_it &&
         a.time_s == b.time_s;
}

}  // namespace

TEST_CASE("heap angle: that of a cone by both fits, whichever way it is turned") {
  for (const double angle_deg : {5.0, 20.0, 37.8, 50.0}) {
    for (const double turn_rad : {0.0, 0.5}) {
      const HeapAngle a = heap_angle(cone(angle_deg, turn_rad), kDish_m);
      INFO(angle_deg << " degrees, turned by " << turn_rad);
      // The highest of the small spheres over a grid of 1 mm, which do not tile the cone evenly.
      CHECK(a.ring_deg == Approx(angle_deg).margin(0.15));
      CHECK(a.outline_deg == Approx(angle_deg).margin(0.3));
      CHECK(a.sides_deg < 0.2);
      // The tip's grain need not stand under a point of the grid, nor on the axis.
      CHECK(a.height_m == Approx(0.061).margin(0.8e-3));
    }
  }
}

TEST_CASE("heap angle: a slope that falls outward is positive, a crater negative; sides tell") {
  CHECK(heap_angle(cone(-15, 0, 0.01), kDish_m).ring_deg == Approx(-15).margin(0.2));
  std::vector<sim::Grain> lopsided = cone(30);
  for (sim::Grain& g : lopsided) g.p_m.z() += 0.2 * g.p_m.x();  // steeper on one side
  const HeapAngle a = heap_angle(lopsided, kDish_m);
  CHECK(a.ring_deg == Approx(30).margin(0.3));
  CHECK(a.sides_deg > 4);
}

TEST_CASE("heap radius: where a cone's surface comes down to the height asked for") {
  for (const double angle_deg : {20.0, 37.8, 50.0}) {
    const double slope = std::tan(angle_deg * kDegree), height_m = 0.04 * slope;
    std::vector<sim::Grain> grains = cone(angle_deg, 0.3, height_m);
    INFO(angle_deg);
    // Spheres of 1 mm radius on the cone lift its surface by 1 mm over the cosine of the slope.
    const double lifted_m = 1e-3 * std::sqrt(1 + slope * slope);
    for (const double floor_m : {0.003, 0.008}) {
      const double expected_m = (height_m + lifted_m - floor_m) / slope;
      CHECK(heap_radius_m(grains, floor_m) == Approx(expected_m).margin(2.2e-3));  // rings of 2 mm
    }
    sim::Grain far;  // one that rolled away does not widen the heap
    far.radius_m = 2e-3, far.p_m = {0.3, 0, 2e-3};
    grains.push_back(far);
    CHECK(heap_radius_m(grains, 0.003) < 0.045);
    CHECK_THROWS_AS(heap_radius_m(grains, 0.2), std::invalid_argument);
  }
}

TEST_CASE("heap angle: what lies beside or under the dish is left out; nothing is no heap") {
  std::vector<sim::Grain> grains = cone(30);
  const HeapAngle before = heap_angle(grains, kDish_m);
  sim::Grain stray;
  stray.radius_m = 3e-3;
  stray.p_m = {0.041, 0, 0.1};
  grains.push_back(stray);
  stray.p_m = {0.01, 0, -0.02};
  grains.push_back(stray);
  CHECK(heap_angle(grains, kDish_m).ring_deg == before.ring_deg);
  CHECK(heap_angle(grains, kDish_m).grains_in_it == before.grains_in_it);
  CHECK_THROWS_AS(heap_angle({}, kDish_m), std::invalid_argument);
  CHECK_THROWS_AS(heap_angle(grains, 1e-3), std::invalid_argument);
}

TEST_CASE("a surface of revolution is closed, points outward and has the volume of its polygon") {
  struct Shape {
    std::vector<std::pair<double, double>> polygon;
    double r2_dz;  // integral of r^2 dz around the polygon
  };
  // Cylinder of r 2, h 3; ring between r 1 and 2, h 3; cone of r 2, h 3: r^2 h / 3.
  const std::vector<Shape> shapes = {{{{0, 0}, {2, 0}, {2, 3}, {0, 3}}, 12},
                                     {{{1, 0}, {2, 0}, {2, 3}, {1, 3}}, 9},
                                     {{{0, 0}, {2, 0}, {0, 3}}, 4}};
  for (const Shape& shape : shapes) {
    for (const int segments : {3, 48}) {
      const sim::TriangleMesh mesh = revolved(shape.polygon, segments);
      std::map<std::pair<int, int>, int> edges;
      double volume = 0;
      for (const auto& t : mesh.triangles) {
        for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
        const auto& v = mesh.vertices_m;
        volume += v[std::size_t(t[0])].dot(v[std::size_t(t[1])].cross(v[std::size_t(t[2])])) / 6;
      }
      for (const auto& [edge, count] : edges) {
        CHECK(count == 1);
        CHECK(edges.count({edge.second, edge.first}) == 1);
      }
      const double area = 0.5 * segments * std::sin(2 * std::numbers::pi / segments);  // for r 1
      CHECK(volume == Approx(area * shape.r2_dz).epsilon(1e-12));
    }
  }
}

TEST_CASE("heaps: the same from one thread and two, in any order; kept ones are not made again") {
  const tests::ScratchFolder scratch;
  const auto cases = repose_cases(kPaper, small());
  REQUIRE(cases.size() == 2);
  const auto one = make_heaps(cases, scratch.path() / "one", 1, {});
  const auto two = make_heaps(cases, scratch.path() / "two", 2, {});
  REQUIRE(one.size() == 2);
  REQUIRE(two.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) CHECK(same(one[i], two[i]));
  CHECK_FALSE(same(one[0], one[1]));
  // A heap of so few is no more than a rough one.
  CHECK(one[0].angle.grains_in_it > 60);  // the others rolled away over the plate
  CHECK(one[0].angle.ring_deg > 5);
  CHECK(one[0].angle.ring_deg < 60);
  bool made = false;
  const auto again = make_heaps(cases, scratch.path() / "one", 1, [&](double, const std::string&) {
    made = true;
    return true;
  });
  CHECK_FALSE(made);
  CHECK(same(again[1], one[1]));
}

TEST_CASE("heaps: one that is stopped goes on to the same bytes, a damaged snapshot begins anew") {
  const tests::ScratchFolder scratch;
  ReposeSettings settings = small();
  settings.seeds = 1;
  const auto cases = repose_cases(kPaper, settings);
  const auto whole = make_heaps(cases, scratch.path() / "whole", 1, {});
  const auto stopped_after = [&](const std::string& folder, int pieces) {
    int n = 0;
    return make_heaps(cases, scratch.path() / folder, 1,
                      [&](double, const std::string&) { return ++n < pieces; });
  };
  CHECK(stopped_after("cut", 12).empty());
  CHECK(stopped_after("cut", 9).empty());
  int rest = 0;
  const auto resumed =
      make_heaps(cases, scratch.path() / "cut", 1, [&](double, const std::string&) {
        ++rest;
        return true;
      });
  REQUIRE(resumed.size() == 1);
  CHECK(same(resumed[0], whole[0]));
  CHECK(rest == std::lround(whole[0].time_s / 0.01) - 12 - 9);
  for (const auto& entry : std::filesystem::directory_iterator(scratch.path() / "cut")) {
    CHECK(entry.path().extension() == ".txt");
  }
  CHECK(stopped_after("damaged", 12).empty());
  for (const auto& entry : std::filesystem::directory_iterator(scratch.path() / "damaged")) {
    std::string bytes = read_file(entry.path());
    bytes[bytes.size() / 2] ^= 1;
    write_file(entry.path(), bytes);
  }
  CHECK(same(make_heaps(cases, scratch.path() / "damaged", 1, {})[0], whole[0]));
}

TEST_CASE("heaps: one that tells no angle is refused and says why") {
  const tests::ScratchFolder scratch;
  sim::Materials dull = kPaper;  // nothing bounces over the rim
  dull.sand_sand.restitution.value = dull.sand_abs.restitution.value = 0.05;
  // The heap itself refuses; the runner keeps that as a result, with its reason.
  const auto make = [&](const HeapTest& test) {
    HeapMaking heap(dull, test);
    while (heap.advance()) {
    }
  };
  HeapTest filled = small().test;  // a dish with room for all
  filled.rim = 3, filled.overflow = 1;
  CHECK_THROWS_WITH(make(filled), Catch::Contains("grains ran over the rim (seed 1)") &&
                                      Catch::Contains("raise --overflow"));
  HeapTest low = small().test;
  low.drop = 0.5;
  CHECK_THROWS_WITH(make(low),
                    Catch::Contains("reaches the outlet") && Catch::Contains("raise --drop"));
  const std::vector<HeapCase> cases = {{"low", dull, low}, {"heap", kPaper, small().test}};
  const auto made = make_heaps(cases, scratch.path(), 1, {});
  REQUIRE(made.size() == 2);  // the one that follows is made all the same
  CHECK(made[0].no_angle == "grown into the outlet");
  CHECK_THAT(made[0].why, Catch::Contains("raise --drop"));
  CHECK(std::isnan(made[0].angle.ring_deg));
  CHECK(made[1].tells());
  bool again = false;
  const auto kept = make_heaps(cases, scratch.path(), 1, [&](double, const std::string&) {
    again = true;
    return true;
  });
  CHECK_FALSE(again);
  CHECK(kept[0].no_angle == made[0].no_angle);
  CHECK(kept[0].why == made[0].why);
  CHECK(kept[0].time_s == made[0].time_s);
  CHECK(same(kept[1], made[1]));
}

TEST_CASE("repose: rows without an angle have no part in rms and correlations, and say why") {
  ReposeSettings settings;
  settings.table2 = true;
  const auto cases = repose_cases(kPaper, settings);
  std::vector<HeapResult> results(cases.size());
  const auto rows = repose_combinations();
  const auto refuse = [](HeapResult& r, const std::string& kind) {
    r.no_angle = kind, r.why = "repose: " + kind, r.angle.ring_deg = std::nan("");
  };
  for (std::size_t i = 0; i < results.size(); ++i) {
    const std::size_t row = i / 5;  // 0: the material's own
    results[i].angle.ring_deg = row == 0 ? 38 : rows[row - 1].angle_deg + 2;
    if (row == 3) refuse(results[i], "blocked");
    if (row == 5 && i % 5 < 2) refuse(results[i], "no heap");
  }
  refuse(results[1], "blocked");
  const Findings f = find_repose(kPaper, settings, cases, results);
  CHECK(f.targets[0].name.find("mean of 4 heaps") != std::string::npos);
  CHECK_FALSE(f.targets[0].has_band());
  CHECK(f.about.back() == "4 of 5 heaps told an angle of repose; blocked 1.");
  REQUIRE(f.targets.size() == 10);
  CHECK(f.targets[5].name.find("12 of its 13 combinations") != std::string::npos);
  CHECK(f.targets[5].ours == Approx(2));  // of the 12 that tell
  CHECK(f.targets[6].ours == Approx(2));
  CHECK(f.targets[7].ours == Approx(1));
  CHECK(f.targets[8].ours == Approx(1));
  CHECK(f.targets[9].name.find("of 65") != std::string::npos);
  CHECK(f.targets[9].ours == 58);  // 65 - 5 - 2
  const tests::ScratchFolder scratch;
  write_findings(f, kPaper, scratch.path());
  const std::string csv = read_file(scratch.path() / "table2.csv");
  CHECK(csv.find(",nan,nan,nan,0,blocked 5\n") != std::string::npos);
  CHECK(csv.find(",3,no heap 2\n") != std::string::npos);
  const std::string design = read_file(scratch.path() / "design.csv");
  CHECK(std::count(design.begin(), design.end(), '\n') == 66);
  CHECK(design.find(",nan,blocked,3000,36,") != std::string::npos);
}

TEST_CASE("repose: sand that rolls out to a layer has an angle of 0, and a row that says so") {
  std::vector<HeapResult> three(3);
  three[1].angle.ring_deg = 38;
  CHECK(untold_text(three, 0, 3) == "layer of 0 degrees 2");
  CHECK(told_angles_deg(three, 0, 3) == std::vector<double>{0, 38, 0});
}

TEST_CASE("repose: the band of a correlation holds it, is the same again, and narrows with order") {
  const std::vector<double> paper = {1, 2, 3, 4, 5, 6, 7, 8};
  std::vector<std::vector<double>> close, mixed;
  for (const double p : paper) {
    close.push_back({p - 0.1, p, p + 0.1});
    mixed.push_back({9 - p, p, 2 * p});
  }
  const CorrelationBand sure = correlation_band(paper, close, rank_correlation);
  CHECK(sure.high == Approx(1));
  CHECK(sure.low > 0.9);  // rows drawn twice are ties of the paper that heaps break
  const CorrelationBand loose = correlation_band(paper, mixed, rank_correlation);
  CHECK(loose.low < 0.8);
  const CorrelationBand again = correlation_band(paper, mixed, rank_correlation);
  CHECK(loose.low == again.low);
  CHECK(loose.high == again.high);
  const CorrelationBand pairs = correlation_band(paper, mixed, kendall_correlation);
  CHECK(pairs.low >= -1);
  CHECK(pairs.low < pairs.high);
  CHECK(std::isnan(correlation_band({1, 2}, {{1}, {2}}, rank_correlation).low));
}

TEST_CASE("heaps: what decides the outcome is in the key; cases are those of table 2") {
  ReposeSettings settings;
  settings.seeds = 2;
  settings.table2 = true;
  const auto cases = repose_cases(kPaper, settings);
  CHECK(cases.size() == 2 * (1 + 13));  // 17 runs, five of them one combination
  CHECK(cases[1].test.seed == 2);
  std::map<std::string, int> keys;
  for (const HeapCase& c : cases) ++keys[heap_key(c)];
  CHECK(keys.size() == cases.size());
  HeapCase other = cases[0];
  other.test.outlet_m *= 1.01;
  CHECK(heap_key(other) != heap_key(cases[0]));
  other = cases[0];
  other.test.rim = 1;
  CHECK(heap_key(other) != heap_key(cases[0]));
  other = cases[0];
  other.materials.sand_abs.rolling_friction.value = 0.05;
  CHECK(heap_key(other) != heap_key(cases[0]));
  settings.test.grains = 99;
  CHECK_THROWS_WITH(repose_cases(kPaper, settings), "--grains = 99, must be from 100 to 200000");
  settings = {};
  settings.seeds = 0;
  CHECK_THROWS_WITH(repose_cases(kPaper, settings), "--seeds = 0, must be from 1 to 1000");
}

TEST_CASE("repose: table 2 beside the paper's, with rms, mean difference and rank correlation") {
  ReposeSettings settings;
  settings.table2 = true;
  const auto cases = repose_cases(kPaper, settings);
  std::vector<HeapResult> results(cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const sim::ContactPair& p = cases[i].materials.sand_sand;
    // The paper's own fit and one degree more, in heaps that differ by a degree: its residuals have
    // an rms of 0.5 degrees over the combinations (0.78 over 17 runs with 7 degrees of freedom).
    results[i].angle.ring_deg = paper_repose_fit_deg(p.restitution.value, p.rolling_friction.value,
                                                     p.static_friction.value) +
                                1 + double(i % 5) - 2;
  }
  const Findings f = find_repose(kPaper, settings, cases, results);
  REQUIRE(f.targets.size() == 10);
  CHECK(f.targets[5].ours == Approx(std::hypot(1, 0.5)).margin(0.1));
  CHECK(f.targets[6].ours == Approx(1).margin(0.05));  // residuals of a fit have no mean
  CHECK(f.targets[7].ours > 0.97);
  CHECK(f.targets[8].ours > 0.9);
  CHECK(f.targets[9].ours == 65);
  REQUIRE(f.rows.has_value());
  CHECK(f.rows->rows() == 13);
  const tests::ScratchFolder scratch;
  write_findings(f, kPaper, scratch.path());
  const std::string csv = read_file(scratch.path() / "table2.csv");
  CHECK(
      csv.find("restitution_ratio,rolling_friction_ratio,static_friction_ratio,paper_deg,ours_deg,"
               "deviation_deg,half95_deg,heaps_that_tell_count,no_angle_name") == 0);
  // Five heaps one degree apart: deviation sqrt(2.5), half width t(4) sqrt(0.5) = 1.963.
  CHECK(csv.find(",1.58113883008") != std::string::npos);
}

TEST_CASE("repose: the mean of five heaps is judged, of fewer it is not") {
  ReposeSettings settings;
  for (const auto& [angle_deg, inside] :
       {std::pair(35.9, true), {39.7, true}, {35.7, false}, {39.9, false}}) {
    settings.seeds = 5;
    auto cases = repose_cases(kPaper, settings);
    std::vector<HeapResult> results(5);
    for (std::size_t i = 0; i < 5; ++i) results[i].angle.ring_deg = angle_deg + double(i) - 2;
    const Findings f = find_repose(kPaper, settings, cases, results);
    CHECK(f.targets[0].ours == Approx(angle_deg));
    CHECK(f.targets[0].has_band());
    CHECK(f.targets[0].inside() == inside);
    CHECK(f.targets[2].ours == Approx(std::sqrt(2.5)));  // of -2..2
    settings.seeds = 4;
    cases.pop_back(), results.pop_back();
    CHECK_FALSE(find_repose(kPaper, settings, cases, results).targets[0].has_band());
  }
}
