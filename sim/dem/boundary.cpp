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
  ContactEnergy energy;  // stored now, lost in this step
};

/// Room for the mesh contacts of one grain, kept from grain to grain.
struct Boundary::Workspace {
  std::vector<MeshSpot> spots;
  Memory before;  // contacts of the last step, taken over one by one
  MemoryAccounts accounts_before;
  std::uint32_t taken_over;  // a bit each
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

Boundary::Pose Boundary::pose_at(const MeshMotion& motion, double time_s) {
  return {motion.p_WB_m + time_s * motion.v_WB_m_s,
          turned(motion.q_WB, time_s * motion.w_WB_rad_s).toRotationMatrix()};
}

void Boundary::place_meshes(double time_s) {
  for (Mesh& m : meshes_) m.now = pose_at(m.motion, time_s);
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

double Boundary::pending_work_J() const {
  double work_J = 0;
  for (const Mesh& m : meshes_) work_J += m.load.work_J;
  for (const Patch& p : patches_) work_J += p.load.work_J;
  return work_J;
}

double Boundary::take_deepest_ratio() {
  for (Patch& p : patches_) {
    deepest_ratio_ = std::max(deepest_ratio_, std::exchange(p.load.deepest_ratio, 0.0));
  }
  return std::exchange(deepest_ratio_, 0.0);
}

/// One contact: adds to the grain's force and torque. @return the force on the grain
Vec3<double> Boundary::push(Grain& g, const Vec3<double>& n, double delta_m,
                            const Vec3<double>& v_point_m_s, Vec3<double>& xi_m,
                            Account& account) const {
  const double arm_m = g.radius_m - 0.5 * delta_m;
  Touch<double> c;
  c.delta = delta_m;
  c.n = n;
  c.v_rel = g.v_m_s - v_point_m_s;
  c.w_arm = arm_m * g.w_rad_s;
  // Against a flat wall R_eff and m_eff are the grain's own.
  const TouchForce<double> f =
      touch_force_of(settings_.law, settings_.cap, g.dt_s, c, g.radius_m, g.mass_kg, xi_m);
  const Vec3<double> force_N = f.f_normal + f.f_tangential;
  g.force_N = g.force_N + force_N;
  g.torque_Nm = g.torque_Nm + arm_m * cross(f.f_tangential, n);
  const double rolling_N = settings_.law.mu_r * f.F_n_elastic;
  if (settings_.rolling == RollingLaw::kOwnSpin) {
    g.rolling_N += rolling_N;
  } else if (const double w = std::sqrt(dot(g.w_rad_s, g.w_rad_s)); w > 0) {
    const Vec3<double> torque_Nm =
        -rolling_N * g.radius_m / w * (g.w_rad_s - dot(g.w_rad_s, n) * n);
    g.torque_Nm = g.torque_Nm + torque_Nm;
    g.energy.lost_rolling_J -= g.dt_s * dot(torque_Nm, g.w_rad_s);
  }
  if (settings_.account_energy) {
    g.energy.stored_normal_J += 0.4 * f.F_n_elastic * delta_m;
    account_work(
        g, c, {dot(f.f_normal, n) - f.F_n_elastic, f.f_tangential, 0.5 * f.S_t * dot(xi_m, xi_m)},
        account);
  }
  return force_N;
}

/// In the leapfrog a force changes the kinetic energy by itself times the mean of the displacements
/// before and after it. Summed over a contact that is the displacement of each step times the mean
/// of the forces at its ends.
void Boundary::account_work(Grain& g, const Touch<double>& c, const Account& now, Account& last) {
  const double v_n = dot(c.v_rel, c.n);
  const Vec3<double> v_t = c.v_rel - v_n * c.n - cross(c.w_arm, c.n);
  const double half_dt_s = 0.5 * g.dt_s;
  g.energy.stored_tangential_J += now.stored_tangential_J;
  g.energy.lost_normal_dashpot_J -= half_dt_s * (now.damping_N + last.damping_N) * v_n;
  g.energy.lost_tangential_J -= half_dt_s * dot(now.f_tangential_N + last.f_tangential_N, v_t) +
                                now.stored_tangential_J - last.stored_tangential_J;
  last = now;
}

/// What a contact did in the step in which it ended.
void Boundary::end_contact(Grain& g, const Vec3<double>& n, const Vec3<double>& v_point_m_s,
                           Account& account) {
  Touch<double> c{};
  c.n = n;
  c.v_rel = g.v_m_s - v_point_m_s;
  c.w_arm = g.radius_m * g.w_rad_s;
  account_work(g, c, {}, account);
}

/// Rolling friction by a grain's own spin is one brake for all its contacts, which the step
/// applies.
double Boundary::rolling_loss_J(const Grain& g) {
  const double inertia_kg_m2 = 0.4 * g.mass_kg * g.radius_m * g.radius_m;
  const double w = std::sqrt(dot(g.w_rad_s, g.w_rad_s));
  const double left = std::max(0.0, w - g.dt_s * g.rolling_N * g.radius_m / inertia_kg_m2);
  return 0.5 * inertia_kg_m2 * (w * w - left * left);
}

void Boundary::touch_walls(const NearGrain& b, Grain& g) {
  Account unused;
  for (std::uint32_t i = b.wall_begin; i < b.wall_end; ++i) {
    WallContact& c = wall_contacts_[i];
    Account& account = settings_.account_energy ? wall_accounts_[i] : unused;
    const Wall& wall = settings_.walls[std::size_t(c.wall)];
    const double delta_m = g.radius_m - (wall.normal.dot(g.p_m) - wall.offset_m);
    const bool ends = c.touching && !(delta_m > 0);
    c.touching = delta_m > 0;
    if (c.touching) {
      push(g, bare(wall.normal), delta_m, {}, c.xi_m, account);
    } else if (ends) {
      c.xi_m = {};
      if (settings_.account_energy) end_contact(g, bare(wall.normal), {}, account);
    }
  }
}

/// The patches of one mesh are looked at together, whatever images of the grain they are near.
void Boundary::touch_meshes(const NearGrain& b, Grain& g, Workspace& w) {
  Memory& memory = memories_[std::size_t(b.memory)];
  w.before.count = std::exchange(memory.count, 0);
  std::copy_n(memory.contacts.begin(), w.before.count, w.before.contacts.begin());
  if (settings_.account_energy) w.accounts_before = memory_accounts_[std::size_t(b.memory)];
  w.taken_over = 0;
  std::uint32_t patch = b.patch_begin;
  while (patch < b.patch_end) {
    Patch& first = patches_[patch];
    const bool inner = find_spots(b, g, meshes_[first.mesh].now, patch, w);
    if (!w.spots.empty()) touch_spots(b, first, inner, g, w);
    if (settings_.account_energy) end_mesh_contacts(first, g, w);
  }
}

/// @return whether the grain belongs inside the body
bool Boundary::find_spots(const NearGrain& b, const Grain& g, const Pose& pose,
                          std::uint32_t& patch, Workspace& w) const {
  const std::uint32_t mesh = patches_[patch].mesh;
  const MeshSurface& surface = meshes_[mesh].surface;
  w.spots.clear();
  for (; patch < b.patch_end && patches_[patch].mesh == mesh; ++patch) {
    const Patch& near = patches_[patch];
    const Eigen::Vector3d p_B_m =
        pose.R_WB.transpose() * (eigen(near.p_m) + g.moved_m - pose.origin_m);
    for (std::uint32_t i = near.facet_begin; i < near.facet_end; ++i) {
      MeshSpot spot;
      if (surface.find_spot(near_facets_[i], p_B_m, g.radius_m, spot)) w.spots.push_back(spot);
    }
  }
  if (w.spots.empty()) return false;
  const bool inner = is_inner(w, mesh);
  if (inner) turn_inside_out(w.spots);
  keep_distinct(w.spots, g.radius_m);
  return inner;
}

/// Which side of the surface a grain belongs to is settled when contact begins, and lasts as long:
/// a centre that is pressed through a face is pushed back where it came from. A grain that was put
/// inside a body stays inside.
bool Boundary::is_inner(const Workspace& w, std::uint32_t mesh) {
  for (std::size_t i = 0; i < w.before.count; ++i) {
    if (w.before.contacts[i].mesh == mesh) return w.before.contacts[i].inner;
  }
  return nearest(w.spots).distance_m < 0;
}

void Boundary::touch_spots(const NearGrain& b, Patch& patch, bool inner, Grain& g, Workspace& w) {
  const Mesh& mesh = meshes_[patch.mesh];
  Memory& memory = memories_[std::size_t(b.memory)];
  const Vec3<double> v_WB_m_s = bare(mesh.motion.v_WB_m_s);
  const Vec3<double> w_WB_rad_s = bare(mesh.motion.w_WB_rad_s);
  for (const MeshSpot& spot : w.spots) {
    const Vec3<double> n = bare(mesh.now.R_WB * spot.normal);
    const Vec3<double> arm_m = bare(mesh.now.R_WB * spot.point_m);
    MeshContact contact{patch.mesh, inner, n, {}};
    Account account;
    if (const int i = take_over(w, patch.mesh, n); i >= 0) {
      contact.xi_m = w.before.contacts[std::size_t(i)].xi_m;
      if (settings_.account_energy) account = w.accounts_before[std::size_t(i)];
    }
    const Vec3<double> force_N =
        push(g, n, spot.overlap_m, v_WB_m_s + cross(w_WB_rad_s, arm_m), contact.xi_m, account);
    const Vec3<double> impulse_Ns = -g.dt_s * force_N;
    const Vec3<double> angular_impulse_Nms = cross(arm_m, impulse_Ns);
    Load& load = patch.load;
    load.impulse_Ns = load.impulse_Ns + impulse_Ns;
    load.angular_impulse_Nms = load.angular_impulse_Nms + angular_impulse_Nms;
    load.work_J += dot(impulse_Ns, v_WB_m_s) + dot(angular_impulse_Nms, w_WB_rad_s);
    load.deepest_ratio = std::max(load.deepest_ratio, spot.overlap_m / g.radius_m);
    if (memory.count == kMaxContacts) continue;
    if (settings_.account_energy) {
      memory_accounts_[std::size_t(b.memory)][memory.count] = account;
    }
    memory.contacts[memory.count++] = contact;
  }
}

/// @return the contact of the last step that this one continues, or -1. Each is continued once:
/// where one contact becomes two, only the nearer one has its spring.
int Boundary::take_over(Workspace& w, std::uint32_t mesh, const Vec3<double>& n) {
  // A grain that rolls over an edge keeps its contact: the normal turns little from step to step.
  constexpr double kSameContact = 0.8;  // cos 37 degrees
  double best = kSameContact;
  int found = -1;
  for (int i = 0; i < int(w.before.count); ++i) {
    const MeshContact& c = w.before.contacts[std::size_t(i)];
    if (c.mesh != mesh || (w.taken_over >> i & 1)) continue;
    if (const double alike = dot(c.n, n); alike > best) {
      best = alike;
      found = i;
    }
  }
  if (found >= 0) w.taken_over |= 1u << found;
  return found;
}

void Boundary::end_mesh_contacts(const Patch& patch, Grain& g, Workspace& w) const {
  const Mesh& mesh = meshes_[patch.mesh];
  for (std::size_t i = 0; i < w.before.count; ++i) {
    const MeshContact& c = w.before.contacts[i];
    if (c.mesh != patch.mesh || (w.taken_over >> i & 1)) continue;
    const Eigen::Vector3d arm_m =
        eigen(patch.p_m) + g.moved_m - g.radius_m * eigen(c.n) - mesh.now.origin_m;
    end_contact(g, c.n, bare(mesh.motion.v_WB_m_s + mesh.motion.w_WB_rad_s.cross(arm_m)),
                w.accounts_before[i]);
  }
}

template <typename Real>
Boundary::Grain Boundary::grain_of(const GrainRecord<Real>& r, const Domain& domain) {
  Grain g;
  g.p_m = domain.position_m(r);
  g.v_m_s = {double(r.vx), double(r.vy), double(r.vz)};
  g.w_rad_s = {double(r.wx), double(r.wy), double(r.wz)};
  g.radius_m = double(r.radius_m);
  g.mass_kg = double(r.mass_kg);
  return g;
}

template <typename Real>
std::vector<MeshTouch> Boundary::mesh_touches(const GrainRecord<Real>* records,
                                              const Domain& domain, double time_s) const {
  std::vector<MeshTouch> touches;
  Workspace w;
  for (const NearGrain& b : grains_) {
    if (b.memory < 0) continue;
    const GrainRecord<Real>& r = records[b.row];
    Grain g = grain_of(r, domain);
    g.dt_s = 0;  // the histories are those of this moment already
    g.moved_m = domain.moved_m(r, b.listed_at);
    w.before = memories_[std::size_t(b.memory)];
    w.taken_over = 0;
    for (std::uint32_t patch = b.patch_begin; patch < b.patch_end;) {
      const std::uint32_t mesh = patches_[patch].mesh;
      const MeshMotion& motion = meshes_[mesh].motion;
      const Pose pose = pose_at(motion, time_s);
      find_spots(b, g, pose, patch, w);
      for (const MeshSpot& spot : w.spots) {
        const Eigen::Vector3d normal = pose.R_WB * spot.normal, arm_m = pose.R_WB * spot.point_m;
        const Vec3<double> n = bare(normal);
        Vec3<double> xi_m{};
        if (const int i = take_over(w, mesh, n); i >= 0) {
          xi_m = w.before.contacts[std::size_t(i)].xi_m;
        }
        Account unused;
        const Eigen::Vector3d f_N =
            eigen(push(g, n, spot.overlap_m, bare(motion.v_WB_m_s + motion.w_WB_rad_s.cross(arm_m)),
                       xi_m, unused));
        const Eigen::Vector3d f_normal_N = f_N.dot(normal) * normal;
        touches.push_back({r.id, mesh, meshes_[mesh].surface.triangle(spot.facet), spot.overlap_m,
                           pose.origin_m + arm_m, (g.radius_m - spot.overlap_m) * normal,
                           f_normal_N, f_N - f_normal_N});
      }
    }
  }
  // Rows lie along a curve through the bed; for others the order is to be plain.
  std::stable_sort(touches.begin(), touches.end(),
                   [](const MeshTouch& a, const MeshTouch& b) { return a.grain < b.grain; });
  return touches;
}

template <typename Real>
void Boundary::compute(const GrainRecord<Real>* records, const Domain& domain, double dt_s,
                       std::uint32_t group_begin, std::uint32_t group_end) {
  auto& forces = forces_of<Real>();
  Workspace workspace;
  const auto first_of = [&](std::uint32_t group) {
    return std::lower_bound(grains_.begin(), grains_.end(), group * kLanes,
                            [](const NearGrain& b, std::uint32_t row) { return b.row < row; });
  };
  const auto end = first_of(group_end);
  constexpr std::ptrdiff_t kAhead = 8;  // grains; their records lie far apart
  for (auto b = first_of(group_begin); b != end; ++b) {
    if (end - b > kAhead) __builtin_prefetch(&records[b[kAhead].row]);
    const GrainRecord<Real>& r = records[b->row];
    Grain g = grain_of(r, domain);
    g.dt_s = dt_s;
    touch_walls(*b, g);
    if (b->memory >= 0) {
      g.moved_m = domain.moved_m(r, b->listed_at);
      touch_meshes(*b, g, workspace);
    }
    if (settings_.account_energy) {
      if (settings_.rolling == RollingLaw::kOwnSpin) g.energy.lost_rolling_J = rolling_loss_J(g);
      ContactEnergy& sum = energies_[b->account];
      sum.stored_normal_J = sum.stored_tangential_J = 0;
      sum += g.energy;
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

void Boundary::flush_energies() {
  lost_ = energy();
  lost_.stored_normal_J = lost_.stored_tangential_J = 0;
  energies_.assign(energies_.size(), {});
}

ContactEnergy Boundary::energy() const {
  ContactEnergy sum = lost_;
  if (!settings_.account_energy) return sum;
  for (const NearGrain& b : grains_) sum += energies_[b.account];
  return sum;
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

template std::vector<MeshTouch> Boundary::mesh_touches<float>(const GrainRecord<float>*,
                                                              const Domain&, double) const;
template std::vector<MeshTouch> Boundary::mesh_touches<double>(const GrainRecord<double>*,
                                                               const Domain&, double) const;
template void Boundary::compute<float>(const GrainRecord<float>*, const Domain&, double,
                                       std::uint32_t, std::uint32_t);
template void Boundary::compute<double>(const GrainRecord<double>*, const Domain&, double,
                                        std::uint32_t, std::uint32_t);

}  // namespace hoof::sim
