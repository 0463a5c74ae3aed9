#include "sim/terrain/rft_terrain.h"

#include <algorithm>
#include <cmath>

#include "sim/terrain/rft_law.h"

namespace hoof::sim {

RftTerrain::RftTerrain(const RftTerrainSettings& settings) : settings_(settings) {
  settings_.validate();
}

void RftTerrain::add_effect(std::unique_ptr<SoilEffect> effect) {
  effect->reset();
  effects_.push_back(std::move(effect));
}

int RftTerrain::add_body(const TriangleMesh& mesh, const Pose&) {
  std::vector<Contact> contacts;
  for (const RftFacet& facet : make_facets(mesh, settings_.facet_size_m)) {
    contacts.push_back({});
    contacts.back().facet = facet;
  }
  bodies_.push_back(std::move(contacts));
  return static_cast<int>(bodies_.size()) - 1;
}

std::size_t RftTerrain::facet_count() const {
  std::size_t count = 0;
  for (const auto& contacts : bodies_) count += contacts.size();
  return count;
}

double RftTerrain::scale_Pa(double depth_m) const {
  if (settings_.pressure_law == PressureLaw::kLinear) return settings_.xi_n_N_m3.value * depth_m;
  return rft::bekker_pressure_Pa(settings_.bekker_k_c_N_m, settings_.bekker_k_phi_Pa,
                                 settings_.bekker_exponent, settings_.bekker_width_m, depth_m) /
         rft::flat_plate_alpha();
}

/// @param alpha size of the facet's, so that its force at full flow is area alpha scale_Pa(depth)
SoilContact RftTerrain::as_soil_contact(const Contact& contact, double depth_m, double alpha,
                                        double speed_m_s) const {
  SoilContact soil;
  soil.depth_m = soil.deepest_m = depth_m;
  soil.speed_m_s = speed_m_s;
  soil.area_m2 = contact.facet.area_m2;
  soil.shear_m = contact.shear_m;
  soil.time_s = time_s_;
  if (settings_.pressure_law == PressureLaw::kLinear) {
    soil.stiffness_N_m = contact.facet.area_m2 * alpha * settings_.xi_n_N_m3.value;
    return soil;
  }
  soil.exponent = settings_.bekker_exponent;
  soil.stiffness_N_m = contact.facet.area_m2 * alpha * scale_Pa(1.0);
  return soil;
}

/// What effects make of the force, over the nominal one; exactly 1 where they change nothing.
double RftTerrain::effect_factor(const SoilContact& contact) const {
  const double nominal_N = contact.stiffness_N_m * std::pow(contact.depth_m, contact.exponent);
  if (!(nominal_N > 0)) return 1;
  SoilContact seen = contact;
  seen.depth_m += extra_depth_m(contact, effects_);
  seen.deepest_m = seen.depth_m;
  return soil_force_N(seen, effects_) / nominal_N;
}

void RftTerrain::update(Contact& contact, const Eigen::Vector3d& normal_W, double depth_m,
                        const Eigen::Vector3d& moved_m, double interval_s) const {
  const double u_y_m = settings_.yield_displacement_m.value;
  Eigen::Vector3d& u_m = contact.displacement_m;
  u_m += moved_m;
  if (const double size_m = u_m.norm(); size_m > u_y_m) u_m *= u_y_m / size_m;

  const Eigen::Vector3d before_Pa = contact.stress_Pa;
  contact.stress_Pa.setZero();
  double most_J_m2 = 0;
  const Eigen::Vector3d damped_m = u_m + settings_.damping_s / interval_s * moved_m;
  const double size_m = damped_m.norm();
  if (size_m > 0 && normal_W.dot(damped_m) > 0) {
    const Eigen::Vector3d alpha =
        rft::alpha(normal_W, damped_m / size_m, settings_.surface_friction);
    Eigen::Vector3d full_Pa = scale_Pa(depth_m) * alpha;
    if (!effects_.empty()) {
      const double down_m_s = -moved_m.z() / interval_s;
      full_Pa *= effect_factor(as_soil_contact(contact, depth_m, alpha.norm(), down_m_s));
    }
    contact.stress_Pa = std::min(1.0, size_m / u_y_m) * full_Pa;
    most_J_m2 = 0.5 * full_Pa.norm() * u_m.squaredNorm() / u_y_m;
  }
  // Off a straight path the law above has no potential and could give more than it took: the
  // stress is cut so that it does not.
  const double given_before = 0.5 * before_Pa.dot(moved_m);
  const double given_now = 0.5 * contact.stress_Pa.dot(moved_m);
  const double left_J_m2 = contact.stored_J_m2 - given_before;
  if (given_now > 0 && given_now > left_J_m2) {
    contact.stress_Pa *= std::max(0.0, left_J_m2 / given_now);
  }
  contact.stored_J_m2 = std::min(left_J_m2 - 0.5 * contact.stress_Pa.dot(moved_m), most_J_m2);
}

void RftTerrain::advance(double interval_s, std::span<const BodyMotion> motions,
                         std::span<Wrench> wrenches) {
  time_s_ += interval_s;
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    const Pose& start = motions[body].start;
    const Pose& end = motions[body].end;
    const Eigen::Matrix3d R_start = start.q_WB.toRotationMatrix();
    const Eigen::Matrix3d R_end = end.q_WB.toRotationMatrix();
    const Eigen::Matrix3d turned = R_end - R_start;
    const Eigen::Vector3d shifted_m = end.p_WB_m - start.p_WB_m;
    const double highest_m = settings_.surface_height_m - end.p_WB_m.z();
    Wrench sum;
    for (Contact& contact : bodies_[body]) {
      const Eigen::Vector3d& centre_B = contact.facet.centre_B_m;
      const double depth_m = highest_m - R_end.row(2).dot(centre_B);
      if (depth_m <= 0) {
        // Out of the sand nothing is kept.
        if (contact.in_sand) contact = {contact.facet};
        continue;
      }
      contact.in_sand = true;
      const Eigen::Vector3d arm = R_end * centre_B;
      const Eigen::Vector3d moved_m = shifted_m + turned * centre_B;
      const Eigen::Vector3d before_Pa = contact.stress_Pa;
      contact.shear_m += moved_m.head<2>().norm();
      update(contact, R_end * contact.facet.normal_B, depth_m, moved_m, interval_s);
      const double area_m2 = contact.facet.area_m2;
      work_J_ += 0.5 * area_m2 * (before_Pa + contact.stress_Pa).dot(moved_m);
      const Eigen::Vector3d force_N = area_m2 * contact.stress_Pa;
      sum.f_W_N += force_N;
      sum.tau_Bo_W_Nm += arm.cross(force_N);
    }
    wrenches[body] = sum;
  }
}

}  // namespace hoof::sim
