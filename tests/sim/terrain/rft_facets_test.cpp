#include "sim/terrain/rft_facets.h"

#include <catch2/catch.hpp>

#include "tests/sim/terrain/soil_plate.h"

using namespace hoof::sim;
using Eigen::Vector3d;

namespace {

double area_m2(const std::vector<RftFacet>& facets) {
  double sum = 0;
  for (const RftFacet& f : facets) sum += f.area_m2;
  return sum;
}

}  // namespace

TEST_CASE("facets keep area, closure and place of a box, whatever their size") {
  const TriangleMesh box = test::box({0.10, 0.06, 0.02});
  for (const double size_m : {0.005, 0.01, 0.03, 0.5}) {
    CAPTURE(size_m);
    const auto facets = make_facets(box, size_m);
    Vector3d closure = Vector3d::Zero(), moment = Vector3d::Zero();
    for (const RftFacet& f : facets) {
      CHECK(f.normal_B.norm() == Approx(1));
      CHECK(f.normal_B.dot(f.centre_B_m) > 0);  // out of the box
      closure += f.area_m2 * f.normal_B;
      moment += f.area_m2 * f.centre_B_m;
    }
    CHECK(area_m2(facets) == Approx(2 * (0.006 + 0.002 + 0.0012)));
    CHECK(closure.norm() < 1e-15);
    CHECK(moment.norm() < 1e-15);
  }
  CHECK(make_facets(box, 0.5).size() == 6);
  CHECK(make_facets(box, 0.01).size() > 100);
}

TEST_CASE("a fine mesh becomes few facets") {
  TriangleMesh fine;
  constexpr int n = 100;  // 10,000 squares of 1 mm
  for (int i = 0; i <= n; ++i) {
    for (int k = 0; k <= n; ++k) fine.vertices_m.push_back({i * 1e-3, k * 1e-3, 0});
  }
  const auto at = [](int i, int k) { return std::int32_t(i * (n + 1) + k); };
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) {
      fine.triangles.push_back({at(i, k), at(i, k + 1), at(i + 1, k)});
      fine.triangles.push_back({at(i + 1, k), at(i, k + 1), at(i + 1, k + 1)});
    }
  }
  const auto facets = make_facets(fine, 0.01);
  CHECK(facets.size() <= 450);  // 10 mm across each, of 20,000 triangles
  CHECK(area_m2(facets) == Approx(0.01));
  CHECK_THROWS_WITH(make_facets({}, 0.01), "a body on fast soil has no surface");
}
