#include "sim/dem/boundary.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "sim/dem/closest_point.h"

namespace hoof::sim {
namespace {

Vec3<double> bare(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}
Eigen::Vector3d eigen(const Vec3<double>& v) {
  return {v.x, v.y, v.z};
}

Eigen::Quaterniond turned(const Eigen::Quaterniond& q, const Eigen::Vector3d& rotation_rad) {
  const double angle = rotation_rad.norm();
  if (angle == 0) return q;
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation_rad / angle)) * q;
}

/// Middle of a triangle's bounding box: no part of it is further than half its span away.
Eigen::Vector3d middle(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                       const Eigen::Vector3d& c) {
  return 0.5 * (a.cwiseMin(b).cwiseMin(c) + a.cwiseMax(b).cwiseMax(c));
}

/// The image of p closest to `centre` across periodic sides.
Eigen::Vector3d nearest_image(Eigen::Vector3d p, const Eigen::Vector3d& centre, const Domain& d) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!d.periodic[axis]) continue;
    const double length = d.length_m(axis);
    p[axis] -= length * std::round((p[axis] - centre[axis]) / length);
  }
  return p;
}

}  // namespace

struct Boundary::Grain {
  Eigen::Vector3d p_m, v_m_s, w_rad_s;
  double radius_m, mass_kg, dt_s;
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero(), torque_Nm = Eigen::Vector3d::Zero();
  double rolling_N = 0;                                 // kOwnSpin: sum of mu_r F_n
  Eigen::Vector3d f_point_N = Eigen::Vector3d::Zero();  // of the last touch, on the grain
  int touched = 0;
  std::array<Memory, kMaxContacts> memory;
};

int Boundary::add_mesh(const TriangleMesh& mesh) {
  if (mesh_count() == kMaxMeshes) throw std::length_error("a bed takes at most 4 meshes");
  Mesh m;
  m.mesh = mesh;
  m.first_vertex = std::uint32_t(vertices_m_.size());
  for (const Eigen::Vector3d& v : mesh.vertices_m) m.radius_m = std::max(m.radius_m, v.norm());
  vertices_m_.insert(vertices_m_.end(), mesh.vertices_m.begin(), mesh.vertices_m.end());
  for (const auto& t : mesh.triangles) {
    triangles_.push_back({mesh_count(), m.first_vertex + std::uint32_t(t[0]),
                          m.first_vertex + std::uint32_t(t[1]),
                          m.first_vertex + std::uint32_t(t[2])});
  }
  meshes_.push_back(std::move(m));
  return mesh_count() - 1;
}

void Boundary::set_motion(int mesh, const MeshMotion& motion) {
  meshes_[mesh].motion = motion;
}

void Boundary::place_meshes(double time_s) {
  for (Mesh& m : meshes_) {
    m.origin_m = m.motion.p_WB_m + time_s * m.motion.v_WB_m_s;
    const Eigen::Matrix3d R =
        turned(m.motion.q_WB, time_s * m.motion.w_WB_rad_s).toRotationMatrix();
    for (std::size_t i = 0; i < m.mesh.vertices_m.size(); ++i) {
      vertices_m_[m.first_vertex + i] = m.origin_m + R * m.mesh.vertices_m[i];
    }
  }
}

double Boundary::fastest_vertex_m_s() const {
  double fastest = 0;
  for (const Mesh& m : meshes_) {
    fastest = std::max(fastest, m.motion.v_WB_m_s.norm() + m.motion.w_WB_rad_s.norm() * m.radius_m);
  }
  return fastest;
}

void Boundary::flush_loads() {
  for (Load& l : loads_) {
    for (int m = 0; m < mesh_count(); ++m) {
      meshes_[m].load.impulse_W_Ns += l.of_mesh[m].impulse_W_Ns;
      meshes_[m].load.angular_impulse_Bo_W_Nms += l.of_mesh[m].angular_impulse_Bo_W_Nms;
      meshes_[m].load.work_J += l.of_mesh[m].work_J;
    }
    deepest_ratio_ = std::max(deepest_ratio_, l.deepest_ratio);
    l = {};
  }
}

MeshLoad Boundary::take_load(int mesh) {
  flush_loads();
  return std::exchange(meshes_[mesh].load, {});
}

double Boundary::take_deepest_ratio() {
  flush_loads();
  return std::exchange(deepest_ratio_, 0.0);
}

void Boundary::reorder(const std::vector<std::uint32_t>& old_row) {
  std::vector<std::int32_t> grain_of_old(old_row.size(), -1);
  for (std::size_t i = 0; i < grains_.size(); ++i) {
    grain_of_old[grains_[i].row] = std::int32_t(i);
  }
  flush_loads();
  std::vector<BoundaryGrain> moved;
  moved.reserve(grains_.size());
  for (std::uint32_t row = 0; row < old_row.size(); ++row) {
    if (const std::int32_t i = grain_of_old[old_row[row]]; i >= 0) {
      moved.push_back(grains_[i]);
      moved.back().row = row;
    }
  }
  grains_.swap(moved);
}

template <typename Real>
void Boundary::list_walls(const typename NeighbourList<Real>::Records& records, std::uint32_t count,
                          const Domain& domain) {
  wall_pairs_.clear();
  if (settings_.walls.empty()) return;
  for (std::uint32_t row = 0; row < count; ++row) {
    const Eigen::Vector3d p = domain.position_m(records[row]);
    std::uint32_t near = 0;
    for (std::size_t w = 0; w < settings_.walls.size(); ++w) {
      const Wall& wall = settings_.walls[w];
      if (wall.normal.dot(p) - wall.offset_m < double(records[row].radius_m) + settings_.skin_m) {
        near |= 1u << w;
      }
    }
    if (near != 0) wall_pairs_.emplace_back(row, near);
  }
}

template <typename Real>
void Boundary::list_triangles(const typename NeighbourList<Real>::Records& records,
                              const CellGrid& cells, const Domain& domain, double largest_radius_m,
                              double grain_drift_m) {
  triangle_pairs_.clear();
  // Grains are filed under the cell where they were at the last sort.
  const double reach = largest_radius_m + settings_.skin_m + grain_drift_m;
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    const Eigen::Vector3d &a = vertices_m_[triangles_[t].a], &b = vertices_m_[triangles_[t].b],
                          &c = vertices_m_[triangles_[t].c];
    std::array<int, 3> low{}, high{};
    for (int axis = 0; axis < 3; ++axis) {
      const double scale = cells.count[axis] / domain.length_m(axis);
      const double lo = std::min({a[axis], b[axis], c[axis]}) - reach - domain.origin_m[axis];
      const double hi = std::max({a[axis], b[axis], c[axis]}) + reach - domain.origin_m[axis];
      low[axis] = int(std::floor(lo * scale));
      high[axis] = int(std::floor(hi * scale));
      if (domain.periodic[axis]) {
        high[axis] = std::min(high[axis], low[axis] + cells.count[axis] - 1);
      } else {
        low[axis] = std::max(low[axis], 0);
        high[axis] = std::min(high[axis], cells.count[axis] - 1);
      }
    }
    const auto wrap = [&](int axis, int i) {
      return (i % cells.count[axis] + cells.count[axis]) % cells.count[axis];
    };
    for (int z = low[2]; z <= high[2]; ++z) {
      for (int y = low[1]; y <= high[1]; ++y) {
        for (int x = low[0]; x <= high[0]; ++x) {
          const std::size_t cell = cells.index(wrap(0, x), wrap(1, y), wrap(2, z));
          for (std::uint32_t place = cells.begin[cell]; place < cells.end[cell]; ++place) {
            const std::uint32_t row = cells.rows[place];
            const Eigen::Vector3d p =
                nearest_image(domain.position_m(records[row]), middle(a, b, c), domain);
            const double near = double(records[row].radius_m) + settings_.skin_m;
            if ((p - closest_point_on_triangle(p, a, b, c)).squaredNorm() < near * near) {
              triangle_pairs_.emplace_back(row, t);
            }
          }
        }
      }
    }
  }
  std::sort(triangle_pairs_.begin(), triangle_pairs_.end());
}

void Boundary::merge_lists(std::uint32_t group_count) {
  grains_.swap(old_grains_);
  grains_.clear();
  near_triangles_.clear();
  std::int32_t load_count = 0;
  std::size_t w = 0, t = 0;
  while (w < wall_pairs_.size() || t < triangle_pairs_.size()) {
    BoundaryGrain b;
    constexpr std::uint32_t kNone = 0xffffffff;
    const std::uint32_t wall_row = w < wall_pairs_.size() ? wall_pairs_[w].first : kNone;
    const std::uint32_t mesh_row = t < triangle_pairs_.size() ? triangle_pairs_[t].first : kNone;
    b.row = std::min(wall_row, mesh_row);
    if (wall_row == b.row) b.walls = wall_pairs_[w++].second;
    b.triangle_begin = std::uint32_t(near_triangles_.size());
    for (; t < triangle_pairs_.size() && triangle_pairs_[t].first == b.row; ++t) {
      near_triangles_.push_back(triangle_pairs_[t].second);
    }
    b.triangle_end = std::uint32_t(near_triangles_.size());
    if (b.triangle_end > b.triangle_begin) b.load = load_count++;
    grains_.push_back(b);
  }
  loads_.assign(load_count, {});

  grain_begin_.assign(group_count + 1, std::uint32_t(grains_.size()));
  force_of_group_.assign(group_count, -1);
  std::int32_t forces = 0;
  for (std::uint32_t i = std::uint32_t(grains_.size()); i-- > 0;) {
    grain_begin_[grains_[i].row / kLanes] = i;
  }
  for (std::uint32_t g = group_count; g-- > 0;) {
    grain_begin_[g] = std::min(grain_begin_[g], grain_begin_[g + 1]);
  }
  for (std::uint32_t g = 0; g < group_count; ++g) {
    if (grain_begin_[g] < grain_begin_[g + 1]) force_of_group_[g] = forces++;
  }
}

void Boundary::carry_memory() {
  std::size_t old = 0;
  for (BoundaryGrain& b : grains_) {
    while (old < old_grains_.size() && old_grains_[old].row < b.row) ++old;
    if (old == old_grains_.size()) return;
    if (old_grains_[old].row != b.row) continue;
    b.contacts = old_grains_[old].contacts;
    b.memory = old_grains_[old].memory;
  }
}

template <typename Real>
void Boundary::rebuild(const typename NeighbourList<Real>::Records& records, std::uint32_t count,
                       const CellGrid& cells, const Domain& domain, double largest_radius_m,
                       double grain_drift_m) {
  flush_loads();
  list_walls<Real>(records, count, domain);
  list_triangles<Real>(records, cells, domain, largest_radius_m, grain_drift_m);
  merge_lists((count + kLanes - 1) / kLanes);
  carry_memory();
  std::int32_t forces = 0;
  for (const std::int32_t f : force_of_group_) forces = std::max(forces, f + 1);
  if constexpr (sizeof(Real) == 4) {
    forces_float_.assign(forces, {});
  } else {
    forces_double_.assign(forces, {});
  }
}

Eigen::Vector3d Boundary::remembered(const BoundaryGrain& b, std::int32_t partner,
                                     const Eigen::Vector3d& n) const {
  // A grain that rolls over an edge keeps its contact: the normal turns little from step to step.
  constexpr double kSameContact = 0.8;  // cos 37 degrees
  double best = kSameContact;
  Eigen::Vector3d xi = Eigen::Vector3d::Zero();
  for (int i = 0; i < b.contacts; ++i) {
    if (b.memory[i].partner != partner) continue;
    if (const double alike = b.memory[i].n.dot(n); alike > best) {
      best = alike;
      xi = b.memory[i].xi_m;
    }
  }
  return xi;
}

void Boundary::touch_point(const BoundaryGrain& b, std::int32_t partner, const Eigen::Vector3d& n,
                           double delta_m, const Eigen::Vector3d& v_point_m_s, Grain& g) {
  Touch<double> c;
  c.delta = delta_m;
  c.R_eff = g.radius_m;
  c.m_eff = g.mass_kg;
  c.n = bare(n);
  c.v_rel = bare(g.v_m_s - v_point_m_s);
  const double arm_m = g.radius_m - 0.5 * delta_m;
  c.w_arm = bare(arm_m * g.w_rad_s);
  Vec3<double> xi = bare(remembered(b, partner, n));
  const TouchForce<double> f =
      touch_force<double, double>(settings_.law, settings_.cap, g.dt_s, c, xi);
  const Eigen::Vector3d f_t = eigen(f.f_tangential);
  g.f_point_N = eigen(f.f_normal) + f_t;
  g.force_N += g.f_point_N;
  g.torque_Nm += arm_m * f_t.cross(n);
  const double rolling_N = settings_.law.mu_r * f.F_n_elastic;
  if (settings_.rolling == RollingLaw::kOwnSpin) {
    g.rolling_N += rolling_N;
  } else if (const double w = g.w_rad_s.norm(); w > 0) {
    g.torque_Nm -= rolling_N * g.radius_m / w * (g.w_rad_s - g.w_rad_s.dot(n) * n);
  }
  if (g.touched < kMaxContacts) g.memory[g.touched++] = {partner, n, eigen(xi)};
}

void Boundary::touch_walls(BoundaryGrain& b, Grain& g) {
  for (std::size_t w = 0; w < settings_.walls.size(); ++w) {
    if (!(b.walls >> w & 1)) continue;
    const Wall& wall = settings_.walls[w];
    const double delta = g.radius_m - (wall.normal.dot(g.p_m) - wall.offset_m);
    if (delta > 0) {
      touch_point(b, -1 - std::int32_t(w), wall.normal, delta, Eigen::Vector3d::Zero(), g);
    }
  }
}

void Boundary::touch_meshes(BoundaryGrain& b, Grain& g, const Domain& domain) {
  std::array<Found, 32> found;
  int count = 0;
  for (std::uint32_t i = b.triangle_begin; i < b.triangle_end && count < int(found.size()); ++i) {
    const Triangle& t = triangles_[near_triangles_[i]];
    const Eigen::Vector3d &v0 = vertices_m_[t.a], &v1 = vertices_m_[t.b], &v2 = vertices_m_[t.c];
    const Eigen::Vector3d p = nearest_image(g.p_m, middle(v0, v1, v2), domain);
    const Eigen::Vector3d point = closest_point_on_triangle(p, v0, v1, v2);
    const double distance = (p - point).norm();
    if (distance < g.radius_m && distance > 0) {
      found[count++] = {distance, point + (g.p_m - p), t.mesh};
    }
  }
  std::stable_sort(found.begin(), found.begin() + count,
                   [](const Found& x, const Found& y) { return x.distance_m < y.distance_m; });
  // A face, the edges around it and their vertices are one flattened spot, not several contacts.
  // Nearest first, a point counts only if it stands out of the tangent plane of every contact
  // already accepted on the same mesh: at a convex edge or on a flat it never does, in a concave
  // corner, or between two spines, it does.
  int accepted = 0;
  for (int k = 0; k < count; ++k) {
    const Found& f = found[k];
    bool distinct = true;
    for (int a = 0; a < accepted && distinct; ++a) {
      if (found[a].mesh != f.mesh) continue;
      const Eigen::Vector3d n_a = (g.p_m - found[a].point_m) / found[a].distance_m;
      distinct = (f.point_m - found[a].point_m).dot(n_a) > 1e-4 * g.radius_m;
    }
    if (!distinct) continue;
    found[accepted++] = f;
  }
  for (int k = 0; k < accepted; ++k) {
    const Found& f = found[k];
    const Mesh& m = meshes_[f.mesh];
    const Eigen::Vector3d arm = f.point_m - nearest_image(m.origin_m, f.point_m, domain);
    const double delta = g.radius_m - f.distance_m;
    touch_point(b, f.mesh, (g.p_m - f.point_m) / f.distance_m, delta,
                m.motion.v_WB_m_s + m.motion.w_WB_rad_s.cross(arm), g);
    Load& load = loads_[b.load];
    const Eigen::Vector3d impulse = -g.dt_s * g.f_point_N;
    const Eigen::Vector3d angular = arm.cross(impulse);
    load.of_mesh[f.mesh].impulse_W_Ns += impulse;
    load.of_mesh[f.mesh].angular_impulse_Bo_W_Nms += angular;
    load.of_mesh[f.mesh].work_J +=
        impulse.dot(m.motion.v_WB_m_s) + angular.dot(m.motion.w_WB_rad_s);
    load.deepest_ratio = std::max(load.deepest_ratio, delta / g.radius_m);
  }
}

template <typename Real>
const std::vector<BoundaryForce<Real>, AlignedAllocator<BoundaryForce<Real>>>& Boundary::forces()
    const {
  if constexpr (sizeof(Real) == 4) {
    return forces_float_;
  } else {
    return forces_double_;
  }
}

template <typename Real>
void Boundary::compute(const GrainRecord<Real>* records, const Domain& domain, double dt_s,
                       std::uint32_t group_begin, std::uint32_t group_end) {
  auto& forces =
      const_cast<std::vector<BoundaryForce<Real>, AlignedAllocator<BoundaryForce<Real>>>&>(
          this->forces<Real>());
  for (std::uint32_t group = group_begin; group < group_end; ++group) {
    if (force_of_group_[group] < 0) continue;
    BoundaryForce<Real>& out = forces[force_of_group_[group]];
    for (std::uint32_t i = grain_begin_[group]; i < grain_begin_[group + 1]; ++i) {
      BoundaryGrain& b = grains_[i];
      const GrainRecord<Real>& r = records[b.row];
      Grain g;
      g.p_m = domain.position_m(r);
      g.v_m_s = {double(r.vx), double(r.vy), double(r.vz)};
      g.w_rad_s = {double(r.wx), double(r.wy), double(r.wz)};
      g.radius_m = double(r.radius_m);
      g.mass_kg = double(r.mass_kg);
      g.dt_s = dt_s;
      touch_walls(b, g);
      if (b.load >= 0) touch_meshes(b, g, domain);
      b.contacts = g.touched;
      std::copy_n(g.memory.begin(), g.touched, b.memory.begin());
      const std::uint32_t lane = b.row % kLanes;
      out.fx[lane] = Real(g.force_N.x()), out.fy[lane] = Real(g.force_N.y());
      out.fz[lane] = Real(g.force_N.z()), out.tx[lane] = Real(g.torque_Nm.x());
      out.ty[lane] = Real(g.torque_Nm.y()), out.tz[lane] = Real(g.torque_Nm.z());
      out.rolling_N[lane] = Real(g.rolling_N);
    }
  }
}

bool Boundary::wall_history(std::uint32_t row, int wall, Eigen::Vector3d& xi_m) const {
  const auto b =
      std::lower_bound(grains_.begin(), grains_.end(), row,
                       [](const BoundaryGrain& g, std::uint32_t r) { return g.row < r; });
  if (b == grains_.end() || b->row != row) return false;
  for (int i = 0; i < b->contacts; ++i) {
    if (b->memory[i].partner == -1 - wall) {
      xi_m = b->memory[i].xi_m;
      return true;
    }
  }
  return false;
}

void Boundary::set_wall_history(std::uint32_t row, int wall, const Eigen::Vector3d& xi_m) {
  const auto b =
      std::lower_bound(grains_.begin(), grains_.end(), row,
                       [](const BoundaryGrain& g, std::uint32_t r) { return g.row < r; });
  if (b == grains_.end() || b->row != row || b->contacts >= kMaxContacts) return;
  b->memory[b->contacts++] = {-1 - wall, settings_.walls[std::size_t(wall)].normal, xi_m};
}

#define HOOF_INSTANTIATE(Real)                                                              \
  template void Boundary::rebuild<Real>(const NeighbourList<Real>::Records&, std::uint32_t, \
                                        const CellGrid&, const Domain&, double, double);    \
  template void Boundary::compute<Real>(const GrainRecord<Real>*, const Domain&, double,    \
                                        std::uint32_t, std::uint32_t);                      \
  template const std::vector<BoundaryForce<Real>, AlignedAllocator<BoundaryForce<Real>>>&   \
  Boundary::forces<Real>() const;
HOOF_INSTANTIATE(float)
HOOF_INSTANTIATE(double)
#undef HOOF_INSTANTIATE

}  // namespace hoof::sim
