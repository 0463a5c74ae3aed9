#include "sim/dem/boundary.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

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

}  // namespace

struct Boundary::Grain {
  Eigen::Vector3d p_m;
  Eigen::Vector3d moved_m;  // since it was listed, and the part of its position below one step
  Vec3<double> v_m_s, w_rad_s;
  double radius_m, mass_kg, dt_s;
  Vec3<double> force_N{}, torque_Nm{};
  double rolling_N = 0;  // kOwnSpin: sum of mu_r F_n
};

int Boundary::add_mesh(const TriangleMesh& mesh) {
  if (mesh_count() == kMaxMeshes) throw std::length_error("a bed takes at most 4 meshes");
  meshes_.push_back({MeshSurface(mesh), {}, {}, {}, {}, {}});
  searched_ = false;
  return mesh_count() - 1;
}

void Boundary::set_motion(int mesh, const MeshMotion& motion) {
  meshes_[std::size_t(mesh)].motion = motion;
}

void Boundary::place_meshes(double time_s) {
  for (Mesh& m : meshes_) {
    m.now.origin_m = m.motion.p_WB_m + time_s * m.motion.v_WB_m_s;
    m.now.R_WB = turned(m.motion.q_WB, time_s * m.motion.w_WB_rad_s).toRotationMatrix();
  }
}

void Boundary::flush_loads() {
  for (Patch& p : patches_) {
    MeshLoad& load = meshes_[p.mesh].load;
    load.impulse_W_Ns += eigen(p.load.impulse_Ns);
    load.angular_impulse_Bo_W_Nms += eigen(p.load.angular_impulse_Nms);
    load.work_J += p.load.work_J;
    deepest_ratio_ = std::max(deepest_ratio_, p.load.deepest_ratio);
    p.load = {};
  }
}

MeshLoad Boundary::take_load(int mesh) {
  flush_loads();
  return std::exchange(meshes_[std::size_t(mesh)].load, {});
}

double Boundary::take_deepest_ratio() {
  for (Patch& p : patches_) {
    deepest_ratio_ = std::max(deepest_ratio_, std::exchange(p.load.deepest_ratio, 0.0));
  }
  return std::exchange(deepest_ratio_, 0.0);
}

/// One contact: adds to the grain's force and torque. @return the force on the grain
Vec3<double> Boundary::push(Grain& g, const Vec3<double>& n, double delta_m,
                            const Vec3<double>& v_point_m_s, Vec3<double>& xi_m) const {
  const double arm_m = g.radius_m - 0.5 * delta_m;
  Touch<double> c;
  c.delta = delta_m;
  c.R_eff = g.radius_m;
  c.m_eff = g.mass_kg;
  c.n = n;
  c.v_rel = g.v_m_s - v_point_m_s;
  c.w_arm = arm_m * g.w_rad_s;
  const TouchForce<double> f =
      touch_force<double, double>(settings_.law, settings_.cap, g.dt_s, c, xi_m);
  const Vec3<double> force_N = f.f_normal + f.f_tangential;
  g.force_N = g.force_N + force_N;
  g.torque_Nm = g.torque_Nm + arm_m * cross(f.f_tangential, n);
  const double rolling_N = settings_.law.mu_r * f.F_n_elastic;
  if (settings_.rolling == RollingLaw::kOwnSpin) {
    g.rolling_N += rolling_N;
  } else if (const double w = std::sqrt(dot(g.w_rad_s, g.w_rad_s)); w > 0) {
    g.torque_Nm = g.torque_Nm - rolling_N * g.radius_m / w * (g.w_rad_s - dot(g.w_rad_s, n) * n);
  }
  return force_N;
}

void Boundary::touch_walls(const NearGrain& b, Grain& g) {
  for (std::uint32_t i = b.wall_begin; i < b.wall_end; ++i) {
    WallContact& c = wall_contacts_[i];
    const Wall& wall = settings_.walls[std::size_t(c.wall)];
    const double delta_m = g.radius_m - (wall.normal.dot(g.p_m) - wall.offset_m);
    c.touching = delta_m > 0;
    if (c.touching) {
      push(g, bare(wall.normal), delta_m, {}, c.xi_m);
    } else {
      c.xi_m = {};
    }
  }
}

/// The patches of one mesh are looked at together, whatever images of the grain they are near.
void Boundary::touch_meshes(const NearGrain& b, Grain& g, std::vector<MeshSpot>& spots) {
  Memory& memory = memories_[std::size_t(b.memory)];
  const Memory before = memory;
  memory.count = 0;
  std::uint32_t patch = b.patch_begin;
  while (patch < b.patch_end) {
    Patch& first = patches_[patch];
    const Mesh& mesh = meshes_[first.mesh];
    spots.clear();
    for (; patch < b.patch_end && patches_[patch].mesh == first.mesh; ++patch) {
      const Patch& near = patches_[patch];
      const Eigen::Vector3d p_B_m =
          mesh.now.R_WB.transpose() * (eigen(near.p_m) + g.moved_m - mesh.now.origin_m);
      for (std::uint32_t i = near.facet_begin; i < near.facet_end; ++i) {
        MeshSpot spot;
        if (mesh.surface.find_spot(near_facets_[i], p_B_m, g.radius_m, spot)) {
          spots.push_back(spot);
        }
      }
    }
    if (spots.empty()) continue;
    const bool inner = is_inner(before, first.mesh, spots);
    if (inner) turn_inside_out(spots);
    keep_distinct(spots, g.radius_m);
    touch_spots(first, before, spots, inner, g, memory);
  }
}

/// Which side of the surface a grain belongs to is settled when contact begins, and lasts as long:
/// a centre that is pressed through a face is pushed back where it came from. A grain that was put
/// inside a body stays inside.
bool Boundary::is_inner(const Memory& before, std::uint32_t mesh,
                        const std::vector<MeshSpot>& spots) {
  for (std::int32_t i = 0; i < before.count; ++i) {
    if (before.contacts[std::size_t(i)].mesh == mesh) return before.contacts[std::size_t(i)].inner;
  }
  return nearest(spots).distance_m < 0;
}

void Boundary::touch_spots(Patch& patch, const Memory& before, const std::vector<MeshSpot>& spots,
                           bool inner, Grain& g, Memory& memory) const {
  const Mesh& mesh = meshes_[patch.mesh];
  for (const MeshSpot& spot : spots) {
    const Vec3<double> n = bare(mesh.now.R_WB * spot.normal);
    const Vec3<double> arm_m = bare(mesh.now.R_WB * spot.point_m);
    const Vec3<double> v_WB_m_s = bare(mesh.motion.v_WB_m_s);
    const Vec3<double> w_WB_rad_s = bare(mesh.motion.w_WB_rad_s);
    Vec3<double> xi_m = remembered(before, patch.mesh, n);
    const Vec3<double> force_N =
        push(g, n, spot.overlap_m, v_WB_m_s + cross(w_WB_rad_s, arm_m), xi_m);
    const Vec3<double> impulse_Ns = -g.dt_s * force_N;
    const Vec3<double> angular_impulse_Nms = cross(arm_m, impulse_Ns);
    Load& load = patch.load;
    load.impulse_Ns = load.impulse_Ns + impulse_Ns;
    load.angular_impulse_Nms = load.angular_impulse_Nms + angular_impulse_Nms;
    load.work_J += dot(impulse_Ns, v_WB_m_s) + dot(angular_impulse_Nms, w_WB_rad_s);
    load.deepest_ratio = std::max(load.deepest_ratio, spot.overlap_m / g.radius_m);
    if (memory.count < kMaxContacts) {
      memory.contacts[std::size_t(memory.count++)] = {patch.mesh, inner, n, xi_m};
    }
  }
}

/// Tangential displacement of the contact that was here at the last step.
Vec3<double> Boundary::remembered(const Memory& before, std::uint32_t mesh, const Vec3<double>& n) {
  // A grain that rolls over an edge keeps its contact: the normal turns little from step to step.
  constexpr double kSameContact = 0.8;  // cos 37 degrees
  double best = kSameContact;
  Vec3<double> xi_m{};
  for (std::int32_t i = 0; i < before.count; ++i) {
    const MeshContact& c = before.contacts[std::size_t(i)];
    if (c.mesh != mesh) continue;
    if (const double alike = dot(c.n, n); alike > best) {
      best = alike;
      xi_m = c.xi_m;
    }
  }
  return xi_m;
}

template <typename Real>
void Boundary::compute(const GrainRecord<Real>* records, const Domain& domain, double dt_s,
                       std::uint32_t group_begin, std::uint32_t group_end) {
  auto& forces = forces_of<Real>();
  std::vector<MeshSpot> spots;
  const auto first_of = [&](std::uint32_t group) {
    return std::lower_bound(grains_.begin(), grains_.end(), group * kLanes,
                            [](const NearGrain& b, std::uint32_t row) { return b.row < row; });
  };
  const auto end = first_of(group_end);
  for (auto b = first_of(group_begin); b != end; ++b) {
    const GrainRecord<Real>& r = records[b->row];
    Grain g;
    g.p_m = domain.position_m(r);
    g.v_m_s = {double(r.vx), double(r.vy), double(r.vz)};
    g.w_rad_s = {double(r.wx), double(r.wy), double(r.wz)};
    g.radius_m = double(r.radius_m);
    g.mass_kg = double(r.mass_kg);
    g.dt_s = dt_s;
    touch_walls(*b, g);
    if (b->memory >= 0) {
      g.moved_m = moved_m(r, b->listed_at, domain) +
                  domain.lsb_m.cwiseProduct(Eigen::Vector3d(r.rx, r.ry, r.rz));
      touch_meshes(*b, g, spots);
    }
    BoundaryForce<Real>& out = forces[std::size_t(b->force)];
    const std::uint32_t lane = b->row % kLanes;
    out.fx[lane] = Real(g.force_N.x), out.fy[lane] = Real(g.force_N.y);
    out.fz[lane] = Real(g.force_N.z), out.tx[lane] = Real(g.torque_Nm.x);
    out.ty[lane] = Real(g.torque_Nm.y), out.tz[lane] = Real(g.torque_Nm.z);
    out.rolling_N[lane] = Real(g.rolling_N);
  }
}

template <>
const Boundary::Forces<float>& Boundary::forces<float>() const {
  return forces_float_;
}
template <>
const Boundary::Forces<double>& Boundary::forces<double>() const {
  return forces_double_;
}

/// The place of grain `row` on wall `wall` in wall_contacts_, or -1.
std::ptrdiff_t Boundary::find_wall_contact(std::uint32_t row, int wall) const {
  const auto b = std::lower_bound(grains_.begin(), grains_.end(), row,
                                  [](const NearGrain& g, std::uint32_t r) { return g.row < r; });
  if (b == grains_.end() || b->row != row) return -1;
  for (std::uint32_t i = b->wall_begin; i < b->wall_end; ++i) {
    if (wall_contacts_[i].wall == wall) return std::ptrdiff_t(i);
  }
  return -1;
}

bool Boundary::wall_history(std::uint32_t row, int wall, Eigen::Vector3d& xi_m) const {
  const std::ptrdiff_t i = find_wall_contact(row, wall);
  if (i < 0 || !wall_contacts_[std::size_t(i)].touching) return false;
  xi_m = eigen(wall_contacts_[std::size_t(i)].xi_m);
  return true;
}

void Boundary::set_wall_history(std::uint32_t row, int wall, const Eigen::Vector3d& xi_m) {
  const std::ptrdiff_t i = find_wall_contact(row, wall);
  if (i >= 0) wall_contacts_[std::size_t(i)] = {wall, 1, bare(xi_m)};
}

template void Boundary::compute<float>(const GrainRecord<float>*, const Domain&, double,
                                       std::uint32_t, std::uint32_t);
template void Boundary::compute<double>(const GrainRecord<double>*, const Domain&, double,
                                        std::uint32_t, std::uint32_t);

}  // namespace hoof::sim
