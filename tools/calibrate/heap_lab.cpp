#include "tools/calibrate/heap_lab.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "sim/config/settings.h"
#include "sim/dem/byte_archive.h"
#include "sim/dem/sand_bed.h"
#include "sim/terrain/bed_grading.h"
#include "sim/terrain/random.h"
#include "tools/calibrate/lab_formulas.h"
#include "tools/calibrate/lab_rules.h"
#include "tools/calibrate/lab_text.h"
#include "tools/calibrate/lane_bed.h"
#include "tools/run/csv_writer.h"

namespace hoof::tools {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kShareOfSolids = 0.58;  // of a heap, for its size only
constexpr double kConeAngle = 38 * kDegree;
constexpr double kSteepest = 55 * kDegree;  // of the paper's table 2: heaps that the outlet clears
constexpr double kPlateOverHeap = 3;        // radius, over that of a cone of 38 degrees
constexpr double kWall_m = 6e-3;            // of base and funnel: thicker than any overlap
constexpr double kFloorBelow_m = 0.02;      // of the ground under the dish's floor
constexpr double kPlace_m = 6.6e-3;  // of the lattice above the funnel: the largest grain fits
constexpr double kPiece_s = 0.01;
constexpr int kSegments = 48;
// At rest: the mean kinetic energy of the heap's grains lifts none by a thousandth of its diameter,
// for 50 ms.
constexpr double kQuiet = 1e-3;
constexpr int kQuietPieces = 5;
constexpr int kBlockedPieces = 30;  // 0.3 s without a grain that leaves; a fall takes 0.1 s
// A dish from which less runs over is not filled to the slope that its sand can hold.
constexpr double kLeastOverflow = 0.03;

sim::BedSettings grading() {
  const sim::Settings paper =
      sim::Settings::load_file(sim::default_config_dir() / "beds" / "paper.toml");
  return sim::read_bed(sim::Reader(paper));
}

double solids_m3(const std::vector<double>& diameters_m) {
  double sum = 0;
  for (const double d : diameters_m) sum += sim::sphere_m3(d);
  return sum;
}

/// The funnel's inner radius at a height at or above the outlet.
double funnel_radius_m(const HeapTest& t, const HeapGeometry& g, double z_m) {
  return std::min(g.funnel_radius_m,
                  0.5 * t.outlet_m + (z_m - g.outlet_z_m) * std::tan(t.funnel_half_angle_rad));
}

/// Free places in the funnel, from below: layers of a square lattice that keep clear of its wall.
std::vector<Eigen::Vector3d> places(const HeapTest& t, const HeapGeometry& g, std::size_t n) {
  std::vector<Eigen::Vector3d> out;
  for (double z = g.outlet_z_m + kPlace_m; out.size() < n; z += kPlace_m) {
    const double room_m =
        funnel_radius_m(t, g, z - 0.5 * kPlace_m) - kPlace_m / std::cos(t.funnel_half_angle_rad);
    const int reach = int(std::floor(std::max(0.0, room_m) / kPlace_m));
    for (int i = -reach; i <= reach; ++i) {
      for (int j = -reach; j <= reach; ++j) {
        const Eigen::Vector3d p(i * kPlace_m, j * kPlace_m, z);
        if (p.head<2>().norm() <= room_m) out.push_back(p);
      }
    }
  }
  out.resize(n);
  return out;
}

sim::BedState hopper(const HeapTest& t, const HeapGeometry& g, std::vector<double> diameters_m) {
  sim::Random random(t.seed);
  for (std::size_t i = diameters_m.size(); i > 1; --i) {  // Fisher and Yates
    std::swap(diameters_m[i - 1], diameters_m[std::size_t(random.next() % i)]);
  }
  const auto where = places(t, g, diameters_m.size());
  sim::BedState state;
  for (std::size_t i = 0; i < where.size(); ++i) {
    sim::Grain grain;
    grain.id = std::uint32_t(i);
    grain.radius_m = diameters_m[i] / 2;
    const double play_m = 0.5 * (kPlace_m - diameters_m[i]);
    grain.p_m = where[i] + play_m * Eigen::Vector3d(random.between(-1, 1), random.between(-1, 1),
                                                    random.between(-1, 1));
    state.grains.push_back(grain);
  }
  return state;
}

/// Of a cone of that solid volume.
double cone_radius_m(double solids_m3, double angle_rad) {
  return std::cbrt(solids_m3 / kShareOfSolids * 3 / std::numbers::pi / std::tan(angle_rad));
}

sim::TriangleMesh base(const HeapGeometry& g) {
  const double r = g.base_radius_m, out = r + 0.5 * kWall_m;
  std::vector<std::pair<double, double>> polygon = {{0, -kWall_m}, {out, -kWall_m}};
  if (g.rim_m > 0) polygon.insert(polygon.end(), {{out, g.rim_m}, {r, g.rim_m}, {r, 0}});
  if (g.rim_m <= 0) polygon.emplace_back(out, 0);
  polygon.emplace_back(0, 0);
  return revolved(polygon, kSegments);
}

sim::TriangleMesh funnel(const HeapTest& t, const HeapGeometry& g) {
  const double out = 0.5 * t.outlet_m, top = g.funnel_radius_m;
  return revolved({{out, g.outlet_z_m},
                   {out + kWall_m, g.outlet_z_m},
                   {top + kWall_m, g.cone_top_z_m},
                   {top + kWall_m, g.funnel_top_z_m},
                   {top, g.funnel_top_z_m},
                   {top, g.cone_top_z_m}},
                  kSegments);
}

sim::DemSettings settings(const sim::Materials& materials, const HeapTest& t,
                          const HeapGeometry& g) {
  sim::DemSettings s = lab_settings(materials);
  s.dt_s = t.step_s;
  // What runs over may roll so far that a wall is the lesser evil.
  const double wall_m = (g.rim_m > 0 ? 3 : 1.2) * g.base_radius_m + 0.03;
  s.low_m = {-wall_m - 0.02, -wall_m - 0.02, -kFloorBelow_m - 0.02};
  s.high_m = {wall_m + 0.02, wall_m + 0.02, g.funnel_top_z_m + 0.05};
  s.walls = {{Eigen::Vector3d::UnitZ(), -kFloorBelow_m},
             {Eigen::Vector3d::UnitX(), -wall_m},
             {-Eigen::Vector3d::UnitX(), -wall_m},
             {Eigen::Vector3d::UnitY(), -wall_m},
             {-Eigen::Vector3d::UnitY(), -wall_m}};
  return s;
}

}  // namespace

void HeapTest::validate() const {
  require_within("grains", grains, 100, 200000, "");
  require_within("outlet", 1e3 * outlet_m, 15, 200, "mm");
  require_within("funnel-angle", funnel_half_angle_rad / kDegree, 10, 60, "deg");
  require_within("step", 1e6 * step_s, 0.5, 8, "us");
  require_within("rim", rim, 0, 3, "");
  require_within("overflow", overflow, 1, 5, "");
  require_within("drop", drop, 0.5, 5, "");
}

HeapGeometry heap_geometry(const HeapTest& t) {
  const sim::BedSettings bed = grading();
  const double solids = solids_m3(sim::graded_diameters(bed, std::size_t(t.grains)));
  HeapGeometry g;
  g.d50_m = bed.d50_m();
  g.rim_m = t.rim * g.d50_m;
  const bool dish = t.rim > 0;
  const double held_m3 = dish ? solids / t.overflow : solids;
  g.base_radius_m = (dish ? 1 : kPlateOverHeap) * cone_radius_m(held_m3, kConeAngle);
  // Over a dish the heap's foot is the rim, on the plate the heap is the narrower the steeper.
  const double foot_m = dish ? g.base_radius_m : cone_radius_m(solids, kSteepest);
  g.outlet_z_m = t.drop * (g.rim_m + foot_m * std::tan(kSteepest));
  g.funnel_radius_m = std::max(1.2 * cone_radius_m(held_m3, kConeAngle), t.outlet_m);
  g.cone_top_z_m =
      g.outlet_z_m + (g.funnel_radius_m - 0.5 * t.outlet_m) / std::tan(t.funnel_half_angle_rad);
  const double highest_m = places(t, g, std::size_t(t.grains)).back().z();
  g.funnel_top_z_m = std::max(g.cone_top_z_m, highest_m) + 2 * kPlace_m;
  return g;
}

sim::TriangleMesh revolved(const std::vector<std::pair<double, double>>& polygon, int segments) {
  sim::TriangleMesh mesh;
  std::vector<std::int32_t> first;  // of the ring that each point makes; one vertex on the axis
  for (const auto& [r, z] : polygon) {
    first.push_back(std::int32_t(mesh.vertices_m.size()));
    const int n = r > 0 ? segments : 1;
    for (int i = 0; i < n; ++i) {
      const double a = 2 * std::numbers::pi * i / segments;
      mesh.vertices_m.emplace_back(r * std::cos(a), r * std::sin(a), z);
    }
  }
  const auto vertex = [&](std::size_t point, int i) {
    return first[point] + (polygon[point].first > 0 ? i % segments : 0);
  };
  for (std::size_t p = 0; p < polygon.size(); ++p) {
    const std::size_t q = (p + 1) % polygon.size();
    for (int i = 0; i < segments; ++i) {
      const std::int32_t p0 = vertex(p, i), p1 = vertex(p, i + 1);
      const std::int32_t q0 = vertex(q, i), q1 = vertex(q, i + 1);
      if (p0 != p1) mesh.triangles.push_back({p0, p1, q1});
      if (q0 != q1) mesh.triangles.push_back({p0, q1, q0});
    }
  }
  return mesh;
}

struct HeapMaking::Parts {
  Parts(const sim::Materials& materials, const HeapTest& t, const HeapGeometry& g)
      : bed(settings(materials, t, g),
            hopper(t, g, sim::graded_diameters(grading(), std::size_t(t.grains)))) {
    bed.add_mesh(base(g), Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity());
    bed.add_mesh(funnel(t, g), Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity());
  }

  sim::SandBed bed;
};

HeapMaking::HeapMaking(const sim::Materials& materials, const HeapTest& test) : test_(test) {
  test.validate();
  geometry_ = heap_geometry(test);
  parts_ = std::make_unique<Parts>(materials, test, geometry_);
}

HeapMaking::~HeapMaking() = default;

double HeapMaking::time_s() const {
  return parts_->bed.health().time_s;
}

std::vector<sim::Grain> HeapMaking::grains() const {
  return parts_->bed.state().grains;
}

bool HeapMaking::advance() {
  parts_->bed.advance(int(std::lround(kPiece_s / test_.step_s)));
  std::size_t inside = 0, heap = 0;
  double ratio = 0;
  for (const sim::Grain& g : parts_->bed.state().grains) {
    if (g.p_m.z() > geometry_.outlet_z_m) ++inside;
    if (g.p_m.z() < 0 || g.p_m.head<2>().norm() > geometry_.base_radius_m) continue;
    ++heap;
    const double energy_m2_s2 =
        0.5 * g.v_m_s.squaredNorm() + 0.2 * g.radius_m * g.radius_m * g.w_rad_s.squaredNorm();
    ratio += energy_m2_s2 / (kGravity_m_s2 * 2 * g.radius_m);
  }
  const double poured = 1 - double(inside) / double(test_.grains);
  still_pieces_ = inside > 0 && poured <= share_poured_ ? still_pieces_ + 1 : 0;
  share_poured_ = std::max(share_poured_, poured);
  if (still_pieces_ >= kBlockedPieces) {
    require_room();
    throw NoAngle("blocked", std::to_string(inside) + " grains block the outlet of " +
                                 text("%g", 1e3 * test_.outlet_m) + " mm" + of_seed() +
                                 "; raise --outlet");
  }
  const bool quiet = inside == 0 && heap > 0 && ratio < kQuiet * double(heap);
  quiet_pieces_ = quiet ? quiet_pieces_ + 1 : 0;
  if (quiet_pieces_ >= kQuietPieces) {
    require_an_angle();
    return false;
  }
  if (time_s() > test_.longest_s) {
    throw NoAngle("not at rest",
                  "not at rest after " + format_number(test_.longest_s) + " s" + of_seed());
  }
  return true;
}

std::string HeapMaking::of_seed() const {
  return " (seed " + std::to_string(test_.seed) + ")";
}

void HeapMaking::require_room() const {
  for (const sim::Grain& g : parts_->bed.state().grains) {
    const bool beside = g.p_m.head<2>().norm() > 0.5 * test_.outlet_m;
    const double top_m = g.p_m.z() + g.radius_m;
    if (beside || top_m > geometry_.outlet_z_m || top_m < geometry_.outlet_z_m - kPlace_m) continue;
    throw NoAngle("grown into the outlet",
                  "the heap reaches the outlet of the funnel" + of_seed() + "; raise --drop");
  }
}

void HeapMaking::require_an_angle() const {
  require_room();
  if (test_.rim <= 0) return;
  std::size_t over = 0;
  for (const sim::Grain& g : parts_->bed.state().grains) {
    if (g.p_m.z() < 0 || g.p_m.head<2>().norm() > geometry_.base_radius_m) ++over;
  }
  if (double(over) < kLeastOverflow * test_.grains) {
    throw NoAngle("not run over", std::to_string(over) + " of " + std::to_string(test_.grains) +
                                      " grains ran over the rim" + of_seed() +
                                      ": the slope is that of the filling; raise --overflow");
  }
}

std::string HeapMaking::snapshot() const {
  sim::ByteWriter out;
  out.put(share_poured_), out.put(quiet_pieces_), out.put(still_pieces_);
  return out.take() + parts_->bed.snapshot();
}

void HeapMaking::restore(std::string_view snapshot) {
  sim::ByteReader in(snapshot);
  in.get(share_poured_), in.get(quiet_pieces_), in.get(still_pieces_);
  parts_->bed.restore(
      snapshot.substr(sizeof share_poured_ + sizeof quiet_pieces_ + sizeof still_pieces_));
}

}  // namespace hoof::tools
