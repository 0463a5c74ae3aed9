// A boundary and a few grains that touch nothing else, stepped in double as the engine does it.
#pragma once

#include <vector>

#include "sim/dem/aligned_allocator.h"
#include "sim/dem/boundary.h"
#include "sim/dem/contact_material.h"
#include "tests/sim/dem/paper_bed.h"

namespace hoof::sim::test {

class BoundaryRig {
 public:
  using Record = GrainRecord<double>;
  static constexpr double kSkin_m = 2e-4;

  BoundaryRig(const DemSettings& s, const std::vector<Grain>& grains, bool account_energy = false)
      : settings_(s),
        domain_(Domain::spanning(s.low_m, s.high_m, s.periodic)),
        boundary_({make_pair_law(s.grain_material, s.wall_material, s.grain_wall), s.coulomb_cap,
                   s.rolling_law, s.walls, kSkin_m, account_energy}) {
    for (const Grain& g : grains) {
      Record r{};
      double rest;  // below one step: nothing
      r.x = domain_.to_steps<double>(0, g.p_m.x(), rest);
      r.y = domain_.to_steps<double>(1, g.p_m.y(), rest);
      r.z = domain_.to_steps<double>(2, g.p_m.z(), rest);
      r.radius_m = g.radius_m, r.mass_kg = grain_mass_kg(2 * g.radius_m);
      r.vx = g.v_m_s.x(), r.vy = g.v_m_s.y(), r.vz = g.v_m_s.z();
      r.wx = g.w_rad_s.x(), r.wy = g.w_rad_s.y(), r.wz = g.w_rad_s.z();
      records_.push_back(r);
    }
    count_ = std::uint32_t(records_.size());
    while (records_.size() % kLanes != 0) records_.push_back({});
  }

  Boundary& boundary() { return boundary_; }
  std::uint32_t count() const { return count_; }
  double time_s() const { return time_s_; }
  Record& record(std::uint32_t row) { return records_[row]; }
  Eigen::Vector3d p_m(std::uint32_t row = 0) const { return domain_.position_m(records_[row]); }
  Eigen::Vector3d v_m_s(std::uint32_t row = 0) const {
    return {records_[row].vx, records_[row].vy, records_[row].vz};
  }
  Eigen::Vector3d w_rad_s(std::uint32_t row = 0) const {
    return {records_[row].wx, records_[row].wy, records_[row].wz};
  }

  /// Force of the boundary on a grain in the last step.
  Eigen::Vector3d force_N(std::uint32_t row = 0) const {
    const std::int32_t f = boundary_.force_of_group()[row / kLanes];
    if (f < 0) return Eigen::Vector3d::Zero();
    const BoundaryForce<double>& e = boundary_.forces<double>()[std::size_t(f)];
    return {e.fx[row % kLanes], e.fy[row % kLanes], e.fz[row % kLanes]};
  }

  /// Forces where the grains are, without moving them.
  void compute() {
    boundary_.prepare<double>(records_.data(), count_, domain_, time_s_);
    boundary_.compute<double>(records_.data(), domain_, settings_.dt_s, 0,
                              std::uint32_t(records_.size()) / kLanes);
  }

  void step() {
    compute();
    double furthest_m = 0;
    for (std::uint32_t row = 0; row < count_; ++row) furthest_m = std::max(furthest_m, move(row));
    boundary_.advance(furthest_m);
    time_s_ += settings_.dt_s;
  }
  void advance(int steps) {
    for (int i = 0; i < steps; ++i) step();
  }

  /// Takes over grains and time of another rig.
  void continue_from(const BoundaryRig& other) {
    records_ = other.records_;
    time_s_ = other.time_s_;
  }

  /// @param old_row of every new row
  void reorder(const std::vector<std::uint32_t>& old_row) {
    const auto before = records_;
    for (std::uint32_t row = 0; row < count_; ++row) records_[row] = before[old_row[row]];
    boundary_.reorder(old_row);
  }

  /// Half a step behind the positions, as the speeds are.
  double kinetic_energy_J() const {
    double sum = 0;
    for (std::uint32_t row = 0; row < count_; ++row) {
      const double r = records_[row].radius_m;
      sum += 0.5 * records_[row].mass_kg *
             (v_m_s(row).squaredNorm() + 0.4 * r * r * w_rad_s(row).squaredNorm());
    }
    return sum;
  }

 private:
  /// @return how far
  double move(std::uint32_t row) {
    Record& r = records_[row];
    const double dt = settings_.dt_s;
    Eigen::Vector3d torque = Eigen::Vector3d::Zero();
    double rolling = 0;
    if (const std::int32_t f = boundary_.force_of_group()[row / kLanes]; f >= 0) {
      const BoundaryForce<double>& e = boundary_.forces<double>()[std::size_t(f)];
      torque = {e.tx[row % kLanes], e.ty[row % kLanes], e.tz[row % kLanes]};
      rolling = e.rolling_N[row % kLanes];
    }
    const Eigen::Vector3d v = v_m_s(row) + dt * (force_N(row) / r.mass_kg + settings_.gravity_m_s2);
    const double inertia = 0.4 * r.mass_kg * r.radius_m * r.radius_m;
    Eigen::Vector3d w = w_rad_s(row) + dt / inertia * torque;
    const double spin = w.norm();
    if (rolling > 0 && spin > 0) {
      w *= std::max(0.0, spin - dt / inertia * rolling * r.radius_m) / spin;
    }
    r.vx = v.x(), r.vy = v.y(), r.vz = v.z();
    r.wx = w.x(), r.wy = w.y(), r.wz = w.z();
    drift(r.x, dt * v.x() / domain_.lsb_m<double>(0));
    drift(r.y, dt * v.y() / domain_.lsb_m<double>(1));
    drift(r.z, dt * v.z() / domain_.lsb_m<double>(2));
    return dt * v.norm();
  }

  static void drift(std::int64_t& x, double steps) {
    x = std::int64_t(std::uint64_t(x) + std::uint64_t(std::int64_t(steps)));
  }

  DemSettings settings_;
  Domain domain_;
  Boundary boundary_;
  std::vector<Record, AlignedAllocator<Record>> records_;
  std::uint32_t count_ = 0;
  double time_s_ = 0;
};

}  // namespace hoof::sim::test
