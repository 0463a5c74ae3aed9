#include "sim/terrain/rigid_terrain.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace hoof::sim {

void RigidTerrainSettings::validate() const {
  const auto require = [](bool holds, const char* name, double value, const char* rule) {
    if (holds) return;
    std::ostringstream text;
    text << name << " = " << value << ": must be " << rule;
    throw std::invalid_argument(text.str());
  };
  require(stiffness_N_m > 0.0, "stiffness_N_m", stiffness_N_m, "above 0");
  require(damping_N_s_m >= 0.0, "damping_N_s_m", damping_N_s_m, "at least 0");
  require(tangential_ratio > 0.0, "tangential_ratio", tangential_ratio, "above 0");
  require(friction >= 0.0, "friction", friction, "at least 0");
}

RigidTerrainSettings read_rigid_terrain(Reader section) {
  RigidTerrainSettings terrain;
  std::string name;
  section.text("name", name);
  section.number("surface_height_mm", terrain.surface_height_m, kMillimetre, -1000.0, 1000.0);
  section.number("stiffness_N_m", terrain.stiffness_N_m, kNewtonPerMetre, 1.0, 1e8);
  section.number("damping_N_s_m", terrain.damping_N_s_m, kNewtonSecondPerMetre, 0.0, 1e5);
  section.number("tangential_ratio", terrain.tangential_ratio, kUnitless, 0.01, 1.0);
  section.number("friction", terrain.friction, kUnitless, 0.0, 5.0);
  section.finish();
  section.check([&terrain] { terrain.validate(); });
  return terrain;
}

RigidTerrain::RigidTerrain(const RigidTerrainSettings& settings) : settings_(settings) {
  settings_.validate();
}

int RigidTerrain::add_body(const TriangleMesh& mesh, const Pose&) {
  std::vector<Contact> contacts(mesh.vertices_m.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) contacts[i].vertex_B_m = mesh.vertices_m[i];
  bodies_.push_back(std::move(contacts));
  return static_cast<int>(bodies_.size()) - 1;
}

Eigen::Vector3d RigidTerrain::contact_force_N(Contact& contact, const Eigen::Vector3d& point_W_m,
                                              const Eigen::Vector3d& moved_W_m,
                                              double interval_s) const {
  const double depth_m = settings_.surface_height_m - point_W_m.z();
  if (depth_m <= 0.0) {
    contact.stretch_m.setZero();
    return Eigen::Vector3d::Zero();
  }
  // The floor pushes and never pulls: the damper's share ends where it would.
  const double sink_m_s = -moved_W_m.z() / interval_s;
  const double up_N =
      std::max(0.0, settings_.stiffness_N_m * depth_m + settings_.damping_N_s_m * sink_m_s);

  const double k_along = settings_.tangential_ratio * settings_.stiffness_N_m;
  const double c_along = settings_.tangential_ratio * settings_.damping_N_s_m;
  contact.stretch_m += moved_W_m.head<2>();
  Eigen::Vector2d along_N =
      -k_along * contact.stretch_m - c_along * moved_W_m.head<2>() / interval_s;
  const double limit_N = settings_.friction * up_N;
  if (const double size = along_N.norm(); size > limit_N) {
    // Sliding: the spring keeps the stretch that Coulomb's force gives it.
    along_N *= limit_N / size;
    contact.stretch_m = -along_N / k_along;
  }
  return {along_N.x(), along_N.y(), up_N};
}

void RigidTerrain::advance(double interval_s, std::span<const BodyMotion> motions,
                           std::span<Wrench> wrenches) {
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    const Pose& start = motions[body].start;
    const Pose& end = motions[body].end;
    Wrench sum;
    for (Contact& contact : bodies_[body]) {
      const Eigen::Vector3d arm = end.q_WB * contact.vertex_B_m;
      const Eigen::Vector3d point = end.p_WB_m + arm;
      const Eigen::Vector3d before = start.p_WB_m + start.q_WB * contact.vertex_B_m;
      const Eigen::Vector3d force = contact_force_N(contact, point, point - before, interval_s);
      work_J_ += 0.5 * (contact.force_N + force).dot(point - before);
      contact.force_N = force;
      sum.f_W_N += force;
      sum.tau_Bo_W_Nm += arm.cross(force);
    }
    wrenches[body] = sum;
  }
}

}  // namespace hoof::sim
