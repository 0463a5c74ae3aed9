#include "tests/sim/dem/liggghts/cases.h"

#include <array>
#include <cmath>
#include <numbers>

namespace hoof::sim::test {
namespace {

using Eigen::Vector3d;

constexpr double kDt_s = 2.8e-6;
// Flight before contact: not a whole number of steps, so that the first overlap is a part of one.
constexpr double kApproach_s = 3.3 * kDt_s;
// The slowest pair (0.05 m/s at 80 degrees, 4 mm) touches for 160 steps.
constexpr int kSteps = 200;
constexpr std::array<double, 3> kSpeeds_m_s = {0.5, 0.05, 3};
constexpr int kAngles = 17;  // -80 to 80 degrees
// Head on every grain gets a spin: without, the rolling friction of 'cdt' works against a spin that
// is nothing but rounding, along its arbitrary direction, and no two programs agree.
constexpr int kHeadOn = kAngles / 2;

double angle_rad(int index) {
  return (index - kHeadOn) * 10 * std::numbers::pi / 180;
}

/// Some rotation, another for each case.
Eigen::Quaterniond turn(int index) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(0.7 * index, Vector3d(1, 2, 3).normalized()));
}

/// A spin whose rim moves at `rim_m_s`.
Vector3d spin(double rim_m_s, double radius_m, const Vector3d& axis) {
  return rim_m_s / radius_m * axis.normalized();
}

std::string label(const char* what, int degrees, double speed_m_s, double diameter_m) {
  return std::string(what) + " at " + std::to_string(degrees) + " degrees, " +
         std::to_string(speed_m_s) + " m/s, diameter " + std::to_string(1e3 * diameter_m) + " mm";
}

int degrees(int angle) {
  return (angle - kHeadOn) * 10;
}

TriangleMesh moved(TriangleMesh mesh, const Vector3d& by_m) {
  for (Vector3d& v : mesh.vertices_m) v += by_m;
  return mesh;
}

FreeCase oblique_impacts(const std::string& name, Partner partner) {
  FreeCase c;
  c.name = name;
  c.partner = partner;
  c.steps = kSteps;
  c.traced = kAngles;
  int index = 0;
  for (const double speed_m_s : kSpeeds_m_s) {
    for (const double d : {2e-3, 6.4e-3}) {
      for (int angle = 0; angle < kAngles; ++angle, ++index) {
        const double a = angle_rad(angle), heading = 0.9 * index;
        const Vector3d v = speed_m_s * Vector3d(std::sin(a) * std::cos(heading),
                                                std::sin(a) * std::sin(heading), -std::cos(a));
        const Vector3d w = index % 2 && angle != kHeadOn
                               ? Vector3d::Zero()
                               : spin(speed_m_s, d / 2, turn(index) * Vector3d(0.3, -0.8, 0.5));
        // Along the box's diagonal x = y a grain in eleven meets the seam of two triangles.
        const Vector3d spot(10.5e-3 * (index % 11 - 5), 10.5e-3 * (index / 11 - 5), d / 2);
        c.grains.push_back(grain_at(std::uint32_t(index), d, spot - kApproach_s * v, v, w));
        c.labels.push_back(label("impact", degrees(angle), speed_m_s, d));
      }
    }
  }
  return c;
}

}  // namespace

FreeCase oblique_pairs() {
  FreeCase c;
  c.name = "pairs";
  c.steps = kSteps;
  c.traced = 2 * kAngles;
  struct Sizes {
    double d1_m, d2_m;
    bool spinning;
  };
  constexpr std::array<Sizes, 4> kSizes = {
      {{2e-3, 6.4e-3, true}, {6.4e-3, 3e-3, false}, {4e-3, 4e-3, true}, {2e-3, 2e-3, false}}};
  int index = 0;
  for (const double speed_m_s : kSpeeds_m_s) {
    for (const Sizes& s : kSizes) {
      for (int angle = 0; angle < kAngles; ++angle, ++index) {
        const double a = angle_rad(angle), r1 = s.d1_m / 2, r2 = s.d2_m / 2;
        const Vector3d n = turn(index) * Vector3d::UnitX();  // from the first to the second
        const Vector3d approach = speed_m_s * (turn(index) * Vector3d(std::cos(a), std::sin(a), 0));
        const Vector3d place =
            16e-3 * (Vector3d(index % 6, index / 6 % 6, index / 36) - Vector3d::Constant(2.5));
        const Vector3d apart = (r1 + r2) * n + kApproach_s * approach;
        const double rim_m_s = s.spinning || angle == kHeadOn ? speed_m_s : 0;
        c.grains.push_back(grain_at(std::uint32_t(2 * index), s.d1_m, place - 0.5 * apart,
                                    0.7 * approach, spin(rim_m_s, r1, {0.3, -0.8, 0.5})));
        c.grains.push_back(grain_at(std::uint32_t(2 * index + 1), s.d2_m, place + 0.5 * apart,
                                    -0.3 * approach, spin(rim_m_s, r2, {-0.6, 0.2, 0.7})));
        c.labels.push_back(label("pair, first", degrees(angle), speed_m_s, s.d1_m));
        c.labels.push_back(label("pair, second", degrees(angle), speed_m_s, s.d2_m));
      }
    }
  }
  return c;
}

FreeCase oblique_impacts_on_plane() {
  return oblique_impacts("plane", Partner::kPlane);
}

FreeCase oblique_impacts_on_mesh() {
  FreeCase c = oblique_impacts("mesh", Partner::kMesh);
  c.mesh = moved(box_mesh({0.065, 0.065, 2e-3}), {0, 0, -2e-3});
  return c;
}

FreeCase impacts_on_edges() {
  FreeCase c;
  c.name = "edges";
  c.partner = Partner::kMesh;
  c.steps = kSteps;
  const double half_m = 0.02;
  c.mesh = box_mesh({half_m, half_m, half_m});
  const double speed_m_s = 0.5, d = 4e-3;
  const auto add = [&](const std::string& what, const Vector3d& spot, const Vector3d& outward) {
    const auto id = std::uint32_t(c.grains.size());
    const Vector3d u = outward.normalized();
    const Vector3d sideways = u.cross(turn(int(id)) * Vector3d(0.2, 0.5, -0.9)).normalized();
    const Vector3d v = speed_m_s * (-u + 0.8 * sideways).normalized();
    c.grains.push_back(grain_at(id, d, spot + d / 2 * u - kApproach_s * v, v,
                                spin(speed_m_s, d / 2, turn(int(id)) * Vector3d::UnitZ())));
    c.labels.push_back(what);
  };
  // Upper edges, met from 15 to 75 degrees off the side's normal.
  for (int i = 0; i < 5; ++i) {
    const double lean_rad = (15 + 15 * i) * std::numbers::pi / 180, at_m = 6e-3 * (i - 2);
    const double out = std::cos(lean_rad), up = std::sin(lean_rad);
    for (const int side : {-1, 1}) {
      add("edge along y", {side * half_m, at_m, half_m}, {side * out, 0, up});
      add("edge along x", {at_m, side * half_m, half_m}, {0, side * out, up});
    }
  }
  for (const int x : {-1, 1}) {
    for (const int y : {-1, 1}) {
      add("corner", {x * half_m, y * half_m, -half_m}, {1.0 * x, 0.6 * y, -0.8});
    }
  }
  return c;
}

DemSettings settings_of(const FreeCase& c, Precision precision) {
  DemSettings s = paper_settings(0.075);
  s.dt_s = kDt_s;
  s.rolling_law = RollingLaw::kRelativeSpin;  // LIGGGHTS cdt
  s.precision = precision;
  if (c.partner == Partner::kPlane) s.walls = {{Vector3d::UnitZ(), 0}};
  return s;
}

}  // namespace hoof::sim::test
