#include "tools/fields/field_measures.h"

#include <cmath>

#include "tools/fields/arch_bridge.h"
#include "tools/fields/sand_motion.h"
#include "tools/fields/sand_packing.h"
#include "tools/fields/sand_stress.h"
#include "tools/fields/sole_pressure.h"
#include "tools/fields/stress_bulb.h"

namespace hoof::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kPaperClosedShare = 0.3248;  // figure 14: high-pressure share of closed toes

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json motion(const FieldScene& scene, const FieldScene& contact) {
  const auto ways = displacements_m(contact.moment, scene.moment);
  std::vector<double> speed_m_s, way_m, mass_kg;
  double moved_m3 = 0, all_m3 = 0;
  const std::vector<sim::Grain>& grains = scene.moment.sand.grains;
  for (std::size_t i = 0; i < grains.size(); ++i) {
    const double volume_m3 =
        scene.mass_kg(grains[i]) / scene.setting.dem.grain_material.density_kg_m3;
    if (ways[i].norm() > 0.1 * scene.setting.d50_m) moved_m3 += volume_m3;
    all_m3 += volume_m3;
    if (!scene.in_zone(grains[i].p_m)) continue;
    speed_m_s.push_back(grains[i].v_m_s.norm());
    way_m.push_back(ways[i].norm());
    mass_kg.push_back(scene.mass_kg(grains[i]));
  }
  const Spread speed = spread(speed_m_s, mass_kg), way = spread(way_m, mass_kg);
  const KineticExtent energy = kinetic_extent(scene, 2 * scene.setting.d50_m);
  const RearwardSpeed spines = rearward_speed(scene, FootPart::kSpine);
  const RearwardSpeed sole = rearward_speed(scene, FootPart::kSole);
  Json j;
  j["grains_under_foot"] = speed_m_s.size();
  j["speed_mean_m_s"] = speed.mean;
  j["speed_p99_m_s"] = speed.p99;
  j["displacement_mean_m"] = way.mean;
  j["displacement_p99_m"] = way.p99;
  j["moved_grains_volume_m3"] = moved_m3;
  j["kinetic_energy_J"] = energy.total_J;
  j["kinetic_90_depth_m"] = energy.depth_m;
  j["kinetic_90_length_m"] = energy.length_m;
  j["kinetic_90_width_m"] = energy.width_m;
  j["kinetic_90_volume_m3"] = energy.volume_m3;
  j["rearward_speed_at_spines_m_s"] = spines.grains > 0 ? Json(spines.mean_m_s) : Json(nullptr);
  j["rearward_speed_at_spines_max_m_s"] =
      spines.grains > 0 ? Json(spines.largest_m_s) : Json(nullptr);
  j["grains_at_spines"] = spines.grains;
  j["rearward_speed_at_sole_m_s"] = sole.grains > 0 ? Json(sole.mean_m_s) : Json(nullptr);
  return j;
}

Json pressure(const FieldScene& scene) {
  const SolePressure s = sole_pressure(scene);
  const std::vector<double> pressure_Pa = triangle_pressure_Pa(scene);
  Json j;
  j["plan_area_m2"] = scene.plan.foot_area_m2();
  j["plantar_area_m2"] = s.plantar_area_m2;
  j["touched_area_m2"] = s.touched_area_m2;
  j["touched_share_ratio"] = s.plantar_area_m2 > 0 ? s.touched_area_m2 / s.plantar_area_m2 : 0;
  j["hertz_contact_area_m2"] = s.hertz_area_m2;
  j["contacts"] = scene.moment.touches.size();
  j["load_of_contacts_N"] = scene.load_N();
  j["peak_Pa"] = s.peak_Pa;
  j["high_threshold_Pa"] = s.threshold_Pa;
  j["high_pressure_share_ratio"] = s.high_share;
  for (const double factor : {0.5, 2.0, 4.0}) {
    char key[40];
    std::snprintf(key, sizeof key, "share_above_%.1f_thresholds_ratio", factor);
    j[key] = share_above(scene, pressure_Pa, factor * std::max(0.0, s.threshold_Pa));
  }
  Json levels = Json::array();
  for (const double p_Pa : {2e3, 5e3, 1e4, 2e4, 5e4, 1e5, 2e5, 5e5}) {
    levels.push_back({{"above_Pa", p_Pa}, {"share_ratio", share_above(scene, pressure_Pa, p_Pa)}});
  }
  j["shares"] = levels;
  j["pressure_at_share_0.3248_Pa"] = pressure_of_share_Pa(scene, pressure_Pa, kPaperClosedShare);
  j["spine_load_share_ratio"] = number(s.spine_load_share);
  return j;
}

Json packing(const FieldScene& scene, const FieldScene& contact) {
  const auto in_zone = [&](const Eigen::Vector3d& p_m) { return scene.in_zone(p_m); };
  const Coordination now = coordination(scene, in_zone), then = coordination(contact, in_zone);
  const double zone_m3 = scene.plan.foot_area_m2() * (scene.low_m - scene.zone_bottom_m());
  const double solid = solid_volume_m3(scene.moment.sand.grains, in_zone) / zone_m3;
  const double solid_then = solid_volume_m3(contact.moment.sand.grains, in_zone) / zone_m3;
  Json j;
  j["zone_depth_m"] = scene.low_m - scene.zone_bottom_m();
  j["grains"] = now.grains;
  j["coordination"] = now.mean;
  j["coordination_at_contact"] = then.mean;
  j["coordination_mechanical"] = now.mechanical;
  j["solid_share_ratio"] = number(solid);
  j["solid_share_change_ratio"] = number(solid - solid_then);
  // Of a given amount of solids: V_now / V_then - 1.
  j["dilation_ratio"] = number(solid_then / solid - 1);
  return j;
}

Json stress(const FieldScene& scene, const FieldScene& contact) {
  const StressBulb bulb = stress_bulb(scene, contact);
  Json j;
  j["nominal_Pa"] = bulb.nominal_Pa;
  const auto& under = bulb.share;
  j["under_foot_share_ratio"] =
      under.size() >= 2 ? Json(0.5 * (under[0] + under[1])) : Json(nullptr);
  j["bulb_depth_m"] = bulb.depth_m ? Json(*bulb.depth_m) : Json(nullptr);
  j["share_at_floor_ratio"] = under.empty() ? Json(nullptr) : Json(under.back());
  j["layer_m"] = bulb.layer_m;
  j["share_by_layer_ratio"] = under;
  if (!bulb.gap_share.empty()) j["gap_share_by_layer_ratio"] = bulb.gap_share;
  Eigen::AlignedBox3d box;
  for (const FootTriangle& t : scene.foot.triangles) {
    for (const Eigen::Vector3d& p : t.corners_m) box.extend(p);
  }
  box.min().z() = scene.zone_bottom_m(), box.max().z() = scene.low_m;
  const Eigen::Matrix3d sigma_Pa = box_stress_Pa(scene.lines, box);
  j["box_xx_Pa"] = sigma_Pa(0, 0), j["box_yy_Pa"] = sigma_Pa(1, 1);
  j["box_zz_Pa"] = sigma_Pa(2, 2), j["box_xz_Pa"] = sigma_Pa(0, 2);
  return j;
}

Json chains(const FieldScene& scene) {
  const ForceChains c = force_chains(scene);
  return {{"contacts", c.contacts},
          {"mean_normal_N", c.mean_N},
          {"largest_normal_N", c.largest_N},
          {"strong_contacts", c.strong},
          {"strong_share_of_force_ratio", c.strong_share}};
}

/// Of the gaps in the plan along y, over where there is one.
double gap_width_m(const FieldScene& scene) {
  const Eigen::AlignedBox3d& region = scene.setting.region_m;
  constexpr double kCell_m = Footprint::kCell_m;
  int gaps = 0;
  for (double x_m = region.min().x() + kCell_m / 2; x_m < region.max().x(); x_m += kCell_m) {
    bool in_gap = false;
    for (double y_m = region.min().y() + kCell_m / 2; y_m < region.max().y(); y_m += kCell_m) {
      const bool is_gap = scene.plan.at(x_m, y_m) == Footprint::kGap;
      gaps += is_gap && !in_gap;
      in_gap = is_gap;
    }
  }
  return gaps > 0 ? scene.plan.gap_area_m2() / (gaps * kCell_m) : 0;
}

Json arch(const FieldScene& scene, const FieldScene& contact) {
  const ArchBridge bridge = arch_bridge(scene);
  const StressBulb bulb = stress_bulb(scene, contact);
  const double d50_m = scene.setting.d50_m;
  Json j;
  const double width_m = gap_width_m(scene);
  j["gap_area_m2"] = bridge.gap_area_m2;
  j["gap_mean_width_m"] = width_m;
  j["paths"] = bridge.paths;
  j["path_force_N"] = bridge.force_N;
  // What the gap bears against what the foot's plan bears, 1 to 2 d50 below: layers of d50 / 2.
  // A gap narrower than a grain has no sand of its own.
  const bool both = bulb.gap_share.size() >= 4 && width_m >= d50_m;
  const double under = both ? bulb.share[2] + bulb.share[3] : 0;
  j["gap_over_foot_stress_ratio"] =
      both && under > 0 ? Json((bulb.gap_share[2] + bulb.gap_share[3]) / under) : Json(nullptr);
  Eigen::AlignedBox3d layer = scene.setting.region_m;
  layer.max().z() = scene.low_m - d50_m, layer.min().z() = scene.low_m - 2 * d50_m;
  const double plan_m2 = scene.plan.foot_area_m2();
  const SupportArea area =
      support_area(scene.lines, contact.lines, layer, d50_m, 0.5 * bulb.nominal_Pa);
  j["support_layer_top_m"] = layer.max().z(), j["support_layer_bottom_m"] = layer.min().z();
  const bool loaded = !bulb.share.empty() && plan_m2 > 0;
  j["support_area_m2"] = loaded ? Json(area.above_m2) : Json(nullptr);
  j["support_area_over_plan_ratio"] = loaded ? Json(area.above_m2 / plan_m2) : Json(nullptr);
  j["participation_area_over_plan_ratio"] =
      loaded ? Json(area.participation_m2 / plan_m2) : Json(nullptr);
  return j;
}

}  // namespace

Json measure_fields(const FieldScene& scene, const FieldScene& contact) {
  const FieldMoment& m = scene.moment;
  Json j;
  j["name"] = m.name;
  j["time_s"] = m.time_s;
  j["since_contact_s"] = m.time_s - contact.moment.time_s;
  j["depth_m"] = m.depth_m;
  j["foot_x_m"] = m.foot_m.x(), j["foot_z_m"] = m.foot_m.z();
  j["lowest_point_m"] = scene.low_m;
  j["fx_N"] = m.ground_N.x(), j["fz_N"] = m.ground_N.z();
  j["motion"] = motion(scene, contact);
  j["pressure"] = pressure(scene);
  j["packing"] = packing(scene, contact);
  j["stress"] = stress(scene, contact);
  j["force_chains"] = chains(scene);
  j["arch"] = arch(scene, contact);
  return j;
}

Json field_headline(const Json& moment) {
  Json j;
  j["moment"] = moment["name"];
  j["time_s"] = moment["time_s"];
  const std::pair<const char*, std::vector<const char*>> kShown[] = {
      {"motion",
       {"speed_mean_m_s", "kinetic_energy_J", "kinetic_90_depth_m", "displacement_mean_m",
        "rearward_speed_at_spines_m_s"}},
      {"pressure",
       {"touched_area_m2", "high_threshold_Pa", "high_pressure_share_ratio",
        "spine_load_share_ratio"}},
      {"packing", {"coordination", "coordination_at_contact", "dilation_ratio"}},
      {"stress", {"bulb_depth_m"}},
      {"force_chains", {"strong_contacts", "strong_share_of_force_ratio"}},
      {"arch",
       {"gap_area_m2", "gap_mean_width_m", "paths", "path_force_N", "gap_over_foot_stress_ratio",
        "support_area_over_plan_ratio"}}};
  for (const auto& [group, keys] : kShown) {
    for (const char* key : keys) j[key] = moment[group][key];
  }
  return j;
}

}  // namespace hoof::tools
