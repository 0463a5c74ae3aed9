// The same oblique collision, all friction on, seen otherwise: moved along, turned, mirrored, with
// the grains' names exchanged. Both precisions.
#include <catch2/catch.hpp>
#include <functional>

#include "tests/sim/dem/paper_bed.h"

using namespace hoof::sim;
using namespace hoof::sim::test;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

std::vector<Grain> collision() {
  return {grain_at(0, 4e-3, {0.3e-3, -0.4e-3, 0.2e-3}, {0.3, 0.2, -0.1}, {40, -60, 20}),
          grain_at(1, 2.4e-3, {3.45e-3, -0.3e-3, 0.1e-3}, {-0.1, 0.05, 0.1}, {-30, 10, 90})};
}

/// Both grains once they have parted.
std::vector<Grain> run(const std::vector<Grain>& grains, Precision precision,
                       RollingLaw rolling_law) {
  DemSettings s = paper_settings(0.01);
  s.precision = precision;
  s.rolling_law = rolling_law;
  BedState start;
  start.grains = grains;
  SandBed bed(s, start);
  bed.advance(100);
  REQUIRE(bed.coordination_number() == 0);
  return bed.state().grains;
}

using Change = std::function<void(Grain&)>;

/// `change` before the run and `undo` after it leave what the run itself gives.
void check_same(const Change& change, const Change& undo) {
  for (const RollingLaw rolling_law : {RollingLaw::kOwnSpin, RollingLaw::kRelativeSpin}) {
    for (const Precision precision : {Precision::kMixed, Precision::kDouble}) {
      std::vector<Grain> changed = collision();
      for (Grain& g : changed) change(g);
      const std::vector<Grain> plain = run(collision(), precision, rolling_law);
      changed = run(changed, precision, rolling_law);
      for (std::size_t i = 0; i < 2; ++i) {
        undo(changed[i]);
        INFO("grain " << i << " precision " << int(precision) << " rolling " << int(rolling_law));
        // Sums in another order round otherwise. Mixed: 5 pm steps and single-precision speeds,
        // some 40 steps of contact, an overlap of some 10 um.
        const double tolerance = precision == Precision::kDouble ? 1e-11 : 1e-5;
        CHECK((changed[i].v_m_s - plain[i].v_m_s).norm() < tolerance);
        CHECK((changed[i].w_rad_s - plain[i].w_rad_s).norm() * plain[i].radius_m < tolerance);
        CHECK((changed[i].p_m - plain[i].p_m).norm() < tolerance * 3e-4);
      }
    }
  }
}

void turn(Grain& g, const Matrix3d& R) {
  g.p_m = R * g.p_m, g.v_m_s = R * g.v_m_s, g.w_rad_s = R * g.w_rad_s;
}

}  // namespace

TEST_CASE("the collision tested for symmetry is one: everything changes in it") {
  const auto before = collision();
  const auto after = run(before, Precision::kDouble, RollingLaw::kOwnSpin);
  for (std::size_t i = 0; i < 2; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      CHECK(std::abs(after[i].v_m_s[axis] - before[i].v_m_s[axis]) > 1e-3);
      CHECK(std::abs(after[i].w_rad_s[axis] - before[i].w_rad_s[axis]) > 1);
    }
  }
}

TEST_CASE("a collision in a moving frame is the same (Galileo)") {
  const Vector3d v_m_s(0.7, -0.4, 0.25);
  const double time_s = 100 * 2.8e-6;
  check_same([&](Grain& g) { g.v_m_s += v_m_s; },
             [&](Grain& g) { g.v_m_s -= v_m_s, g.p_m -= time_s * v_m_s; });
}

TEST_CASE("a collision elsewhere, or turned, is the same") {
  const Vector3d shift_m(2e-3, -3e-3, 1.5e-3);
  check_same([&](Grain& g) { g.p_m += shift_m; }, [&](Grain& g) { g.p_m -= shift_m; });
  for (const double angle_rad : {-2.0, 0.3, 1.5707963267948966}) {
    const Matrix3d R =
        Eigen::AngleAxisd(angle_rad, Vector3d(0.2, 0.9, -0.4).normalized()).toRotationMatrix();
    check_same([&](Grain& g) { turn(g, R); }, [&](Grain& g) { turn(g, R.transpose()); });
  }
}

TEST_CASE("a collision in a mirror is the same, spins being axial") {
  for (int axis = 0; axis < 3; ++axis) {
    const auto mirror = [&](Grain& g) {
      g.p_m[axis] *= -1, g.v_m_s[axis] *= -1;
      g.w_rad_s *= -1, g.w_rad_s[axis] *= -1;
    };
    check_same(mirror, mirror);
  }
}

TEST_CASE("a collision does not depend on which grain is called first") {
  for (const Precision precision : {Precision::kMixed, Precision::kDouble}) {
    std::vector<Grain> swapped = collision();
    std::swap(swapped[0], swapped[1]);
    swapped[0].id = 0, swapped[1].id = 1;
    const auto plain = run(collision(), precision, RollingLaw::kOwnSpin);
    const auto other = run(swapped, precision, RollingLaw::kOwnSpin);
    // Each grain computes the pair for itself, with the same operations: the same bits.
    CHECK(plain[0].v_m_s == other[1].v_m_s);
    CHECK(plain[1].w_rad_s == other[0].w_rad_s);
  }
}
