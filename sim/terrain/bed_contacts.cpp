#include "sim/terrain/bed_contacts.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace hoof::sim {
namespace {

Vec3<double> to_vec3(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}
Eigen::Vector3d to_eigen(const Vec3<double>& v) {
  return {v.x, v.y, v.z};
}

/// Finds grains by id, which grow along the state but may have gaps.
class GrainIndex {
 public:
  explicit GrainIndex(const BedState& state) : grains_(state.grains) {}

  std::size_t place(std::uint32_t id) const {
    const auto at = std::lower_bound(grains_.begin(), grains_.end(), id,
                                     [](const Grain& g, std::uint32_t v) { return g.id < v; });
    if (at == grains_.end() || at->id != id) {
      throw std::invalid_argument("bed: a contact names grain " + std::to_string(id) +
                                  ", which is not there");
    }
    return std::size_t(at - grains_.begin());
  }
  const Grain& operator[](std::uint32_t id) const { return grains_[place(id)]; }

 private:
  const std::vector<Grain>& grains_;
};

class ContactForces {
 public:
  explicit ContactForces(const DemSettings& settings)
      : settings_(settings),
        grain_law_(
            make_pair_law(settings.grain_material, settings.grain_material, settings.grain_grain)),
        wall_law_(
            make_pair_law(settings.grain_material, settings.wall_material, settings.grain_wall)) {}

  /// The shortest way from b to a across periodic sides.
  Eigen::Vector3d between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
    Eigen::Vector3d d = a - b;
    for (int axis = 0; axis < 3; ++axis) {
      if (!settings_.periodic[std::size_t(axis)]) continue;
      d[axis] = std::remainder(d[axis], settings_.high_m[axis] - settings_.low_m[axis]);
    }
    return d;
  }

  LoadedContact pair(const Grain& a, const Grain& b, const Eigen::Vector3d& xi_m) const {
    const Eigen::Vector3d d = between(a.p_m, b.p_m);
    const double distance_m = d.norm();
    const double m_a = mass_kg(a), m_b = mass_kg(b);
    Touch<double> t;
    t.delta = a.radius_m + b.radius_m - distance_m;
    t.n = to_vec3(d / distance_m);
    t.v_rel = to_vec3(a.v_m_s - b.v_m_s);
    t.w_arm =
        to_vec3((a.radius_m - t.delta / 2) * a.w_rad_s + (b.radius_m - t.delta / 2) * b.w_rad_s);
    const double R_eff_m = a.radius_m * b.radius_m / (a.radius_m + b.radius_m);
    LoadedContact c = load(a, t, R_eff_m, m_a * m_b / (m_a + m_b), grain_law_, xi_m);
    c.j = b.id;
    c.to_j_m = -d;
    c.overlap_ratio = t.delta / std::min(a.radius_m, b.radius_m);
    return c;
  }

  LoadedContact wall(const Grain& a, std::size_t index, const Eigen::Vector3d& xi_m) const {
    if (index >= settings_.walls.size()) {
      throw std::invalid_argument("bed: a contact names wall " + std::to_string(index) + " of " +
                                  std::to_string(settings_.walls.size()));
    }
    const Wall& w = settings_.walls[index];
    const double height_m = w.normal.dot(a.p_m) - w.offset_m;
    Touch<double> t;
    t.delta = a.radius_m - height_m;
    t.n = to_vec3(w.normal);
    t.v_rel = to_vec3(a.v_m_s);
    t.w_arm = to_vec3(height_m * a.w_rad_s);
    LoadedContact c = load(a, t, a.radius_m, mass_kg(a), wall_law_, xi_m);
    c.j = GrainContact::kWallContact + std::uint32_t(index);
    c.to_j_m = -height_m * w.normal;
    c.p_m = a.p_m + c.to_j_m;
    c.overlap_ratio = t.delta / a.radius_m;
    return c;
  }

 private:
  double mass_kg(const Grain& g) const {
    return settings_.grain_material.density_kg_m3 * 4 / 3 * std::numbers::pi * g.radius_m *
           g.radius_m * g.radius_m;
  }

  LoadedContact load(const Grain& a, const Touch<double>& t, double R_eff_m, double m_eff_kg,
                     const PairLaw<double>& law, const Eigen::Vector3d& xi_m) const {
    LoadedContact c;
    c.i = a.id;
    c.overlap_m = t.delta;
    if (!(t.delta > 0)) return c;
    Vec3<double> xi = to_vec3(xi_m);
    const double no_time_s = 0;  // the history is that of this moment already
    const TouchForce<double> f = touch_force_of(
        law, settings_.coulomb_cap, no_time_s, t, R_eff_m, m_eff_kg, xi);
    c.f_normal_N = to_eigen(f.f_normal);
    c.f_tangential_N = to_eigen(f.f_tangential);
    c.p_m = a.p_m - (a.radius_m - t.delta / 2) * to_eigen(t.n);
    return c;
  }

  const DemSettings& settings_;
  PairLaw<double> grain_law_, wall_law_;
};

}  // namespace

std::vector<LoadedContact> loaded_contacts(const DemSettings& settings, const BedState& state) {
  const GrainIndex grains(state);
  const ContactForces forces(settings);
  std::vector<LoadedContact> loaded;
  loaded.reserve(state.contacts.size());
  for (const GrainContact& c : state.contacts) {
    const LoadedContact touch =
        c.j >= GrainContact::kWallContact
            ? forces.wall(grains[c.i], c.j - GrainContact::kWallContact, c.xi_m)
            : forces.pair(grains[c.i], grains[c.j], c.xi_m);
    if (touch.overlap_m > 0) loaded.push_back(touch);
  }
  return loaded;
}

std::vector<Eigen::Vector3d> forces_on_grains(const BedState& state,
                                              const std::vector<LoadedContact>& contacts) {
  const GrainIndex grains(state);
  std::vector<Eigen::Vector3d> sums(state.grains.size(), Eigen::Vector3d::Zero());
  for (const LoadedContact& c : contacts) {
    const Eigen::Vector3d f_N = c.f_normal_N + c.f_tangential_N;
    sums[grains.place(c.i)] += f_N;
    if (c.j < GrainContact::kWallContact) sums[grains.place(c.j)] -= f_N;
  }
  return sums;
}

}  // namespace hoof::sim
