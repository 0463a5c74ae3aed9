#include "tools/fields/field_map.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "tools/fields/map_canvas.h"
#include "tools/fields/sand_motion.h"
#include "tools/fields/sand_stress.h"
#include "tools/fields/sole_pressure.h"

namespace hoof::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr char kFootInk[] = "#b0305a";

Eigen::Vector2d xz(const Eigen::Vector3d& p) {
  return {p.x(), p.z()};
}
Eigen::Vector2d xy(const Eigen::Vector3d& p) {
  return {p.x(), p.y()};
}

/// "3.21" of a measured value in another unit; "-" where there is none.
std::string shown(const Json& value, double factor = 1) {
  if (!value.is_number()) return "-";
  char text[40];
  std::snprintf(text, sizeof text, "%.3g", factor * value.get<double>());
  return text;
}

Eigen::AlignedBox3d box_of(const PlacedFoot& foot) {
  Eigen::AlignedBox3d box;
  for (const FootTriangle& t : foot.triangles) {
    for (const Eigen::Vector3d& p : t.corners_m) box.extend(p);
  }
  return box;
}

/// The kept region about where the foot is, up to a little above the sand.
Eigen::AlignedBox2d window_of(const FieldScene& scene) {
  constexpr double kAround_m = 0.06, kAbove_m = 0.03;
  const Eigen::AlignedBox3d foot = box_of(scene.foot), &region = scene.setting.region_m;
  return {Eigen::Vector2d(std::max(region.min().x(), foot.min().x() - kAround_m), region.min().z()),
          Eigen::Vector2d(std::min(region.max().x(), foot.max().x() + kAround_m),
                          std::max(0.0, scene.low_m) + kAbove_m)};
}

/// Where the plane y = cut_y_m cuts the foot.
void draw_foot(MapCanvas& canvas, const FieldScene& scene, double cut_y_m) {
  for (const FootTriangle& t : scene.foot.triangles) {
    Eigen::Vector3d cut[2];
    int cuts = 0;
    for (int k = 0; k < 3 && cuts < 2; ++k) {
      const Eigen::Vector3d &a = t.corners_m[k], &b = t.corners_m[(k + 1) % 3];
      const double ya = a.y() - cut_y_m, yb = b.y() - cut_y_m;
      if ((ya < 0) != (yb < 0)) cut[cuts++] = a + ya / (ya - yb) * (b - a);
    }
    if (cuts == 2) canvas.line(xz(cut[0]), xz(cut[1]), 2.5, kFootInk);
  }
}

using GrainValue = std::function<double(std::size_t)>;

/// Grains that the plane cuts, as discs.
std::string grain_map(const FieldScene& scene, const std::string& title, double cut_y_m,
                      const GrainValue& value, double factor, const std::string& unit) {
  const std::vector<sim::Grain>& grains = scene.moment.sand.grains;
  MapCanvas canvas(window_of(scene), title);
  std::vector<std::size_t> cut;
  std::vector<double> values;
  for (std::size_t i = 0; i < grains.size(); ++i) {
    if (std::abs(grains[i].p_m.y() - cut_y_m) >= grains[i].radius_m) continue;
    if (!canvas.window_m().contains(xz(grains[i].p_m))) continue;
    cut.push_back(i);
    values.push_back(value(i));
  }
  const ColourBar bar = ColourBar::of(values, factor, unit);
  for (std::size_t k = 0; k < cut.size(); ++k) {
    const sim::Grain& g = grains[cut[k]];
    const double off_m = g.p_m.y() - cut_y_m;
    canvas.circle(xz(g.p_m), std::sqrt(g.radius_m * g.radius_m - off_m * off_m),
                  bar.colour(values[k]));
  }
  draw_foot(canvas, scene, cut_y_m);
  return canvas.finish(bar);
}

std::string stress_map(const FieldScene& scene, const std::string& title, double cut_y_m) {
  MapCanvas canvas(window_of(scene), title);
  const double cell_m = 0.75 * scene.setting.d50_m, half_m = 1.5 * scene.setting.d50_m;
  const Eigen::AlignedBox2d& w = canvas.window_m();
  const StressCut cut =
      stress_cut(scene.lines,
                 {Eigen::Vector3d(w.min().x(), cut_y_m - half_m, w.min().y()),
                  Eigen::Vector3d(w.max().x(), cut_y_m + half_m, scene.moment.foot_m.z() + cell_m)},
                 cell_m);
  const ColourBar bar = ColourBar::of(cut.zz_Pa, 1e-3, "kPa");
  for (int j = 0; j < cut.rows; ++j) {
    for (int i = 0; i < cut.columns; ++i) {
      const Eigen::Vector2d low(cut.low_x_m + i * cell_m, cut.low_z_m + j * cell_m);
      canvas.rectangle(
          {low, low + Eigen::Vector2d::Constant(cell_m)},
          bar.colour(cut.zz_Pa[std::size_t(j) * std::size_t(cut.columns) + std::size_t(i)]));
    }
  }
  draw_foot(canvas, scene, cut_y_m);
  return canvas.finish(bar);
}

std::string chain_map(const FieldScene& scene, const std::string& title, double cut_y_m) {
  MapCanvas canvas(window_of(scene), title);
  std::vector<const ForceLine*> near;
  std::vector<double> values;
  for (const ForceLine& line : scene.lines) {
    const Eigen::Vector3d middle = 0.5 * (line.from_m + line.to_m);
    if (std::abs(middle.y() - cut_y_m) > 1.5 * scene.setting.d50_m) continue;
    if (line.j == ForceLine::kWall || !canvas.window_m().contains(xz(middle))) continue;
    near.push_back(&line);
    values.push_back(line.f_normal_N);
  }
  const ColourBar bar = ColourBar::of(values, 1, "N");
  // The strongest last, on top.
  std::stable_sort(near.begin(), near.end(), [](const ForceLine* a, const ForceLine* b) {
    return a->f_normal_N < b->f_normal_N;
  });
  for (const ForceLine* line : near) {
    const double share = std::clamp(line->f_normal_N / bar.most, 0.0, 1.0);
    canvas.line(xz(line->from_m), xz(line->to_m), 0.4 + 6 * share, bar.colour(line->f_normal_N));
  }
  draw_foot(canvas, scene, cut_y_m);
  return canvas.finish(bar);
}

/// From below, left of the foot up: the plan as if the sand were glass.
std::string pressure_map(const FieldScene& scene, const std::string& title) {
  const Eigen::AlignedBox3d box = box_of(scene.foot);
  const Eigen::Vector2d margin(0.01, 0.01);
  MapCanvas canvas({xy(box.min()) - margin, xy(box.max()) + margin}, title);
  const std::vector<double> pressure_Pa = triangle_pressure_Pa(scene);
  std::vector<double> shown_Pa;
  for (std::size_t k = 0; k < pressure_Pa.size(); ++k) {
    const FootTriangle& t = scene.foot.triangles[k];
    if (t.plantar() && pressure_Pa[k] > 0) shown_Pa.push_back(pressure_Pa[k]);
  }
  const ColourBar bar = ColourBar::of(shown_Pa, 1e-3, "kPa");
  for (const FootPart part : {FootPart::kSole, FootPart::kSpine}) {
    for (std::size_t k = 0; k < pressure_Pa.size(); ++k) {
      const FootTriangle& t = scene.foot.triangles[k];
      if (t.part != part || (part == FootPart::kSpine && t.normal.z() > 0)) continue;
      const Eigen::Vector2d corners[3] = {xy(t.corners_m[0]), xy(t.corners_m[1]),
                                          xy(t.corners_m[2])};
      canvas.triangle(corners, bar.colour(pressure_Pa[k]));
    }
  }
  return canvas.finish(bar);
}

}  // namespace

std::string viridis(double share) {
  constexpr int kStops[10][3] = {{0x44, 0x01, 0x54}, {0x48, 0x28, 0x78}, {0x3e, 0x49, 0x89},
                                 {0x31, 0x68, 0x8e}, {0x26, 0x82, 0x8e}, {0x1f, 0x9e, 0x89},
                                 {0x35, 0xb7, 0x79}, {0x6e, 0xce, 0x58}, {0xb5, 0xde, 0x2b},
                                 {0xfd, 0xe7, 0x25}};
  const double at = 9 * std::clamp(std::isfinite(share) ? share : 0.0, 0.0, 1.0);
  const int stop = std::min(8, int(at));
  int rgb[3];
  for (int c = 0; c < 3; ++c) {
    rgb[c] =
        int(std::lround(kStops[stop][c] + (at - stop) * (kStops[stop + 1][c] - kStops[stop][c])));
  }
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", unsigned(rgb[0] & 0xff),
                unsigned(rgb[1] & 0xff), unsigned(rgb[2] & 0xff));
  return text;
}

std::vector<FieldMap> field_maps(const FieldScene& scene, const FieldMoment& contact,
                                 const Json& measured, double cut_y_m) {
  const std::vector<sim::Grain>& grains = scene.moment.sand.grains;
  const auto ways = displacements_m(contact, scene.moment);
  const Json &motion = measured["motion"], &pressure = measured["pressure"];
  std::vector<FieldMap> maps;
  const auto add_grains = [&](const std::string& key, const std::string& title,
                              const std::string& number, const GrainValue& value, double factor,
                              const std::string& unit) {
    maps.push_back({key, title, number, grain_map(scene, title, cut_y_m, value, factor, unit)});
  };
  add_grains(
      "speed", "Speed of the grains",
      "under the foot: mean " + shown(motion["speed_mean_m_s"], 1e3) +
          " mm/s, one in a hundred above " + shown(motion["speed_p99_m_s"], 1e3) + " mm/s",
      [&](std::size_t i) { return grains[i].v_m_s.norm(); }, 1e3, "mm/s");
  add_grains(
      "energy", "Kinetic energy of the grains",
      shown(motion["kinetic_energy_J"], 1e3) + " mJ in all; 90 % above a depth of " +
          shown(motion["kinetic_90_depth_m"], 1e3) + " mm and within " +
          shown(motion["kinetic_90_length_m"], 1e3) + " mm of length",
      [&](std::size_t i) { return kinetic_J(scene, grains[i]); }, 1e6, "\u00b5J a grain");
  add_grains(
      "displacement", "Displacement since first contact",
      "under the foot: mean " + shown(motion["displacement_mean_m"], 1e3) + " mm; " +
          shown(motion["moved_grains_volume_m3"], 1e6) + " cm3 of grains moved by d50 / 10",
      [&](std::size_t i) { return ways[i].norm(); }, 1e3, "mm");
  add_grains(
      "rearward", "Rearward horizontal speed",
      "at the spines: mean " + shown(motion["rearward_speed_at_spines_m_s"], 1e3) +
          " mm/s; at the soles " + shown(motion["rearward_speed_at_sole_m_s"], 1e3) + " mm/s",
      [&](std::size_t i) { return -grains[i].v_m_s.x(); }, 1e3, "mm/s");
  const Json& stress = measured["stress"];
  maps.push_back({"stress", "Vertical stress between the grains",
                  "load over the foot's plan " + shown(stress["nominal_Pa"], 1e-3) + " kPa; " +
                      (stress["bulb_depth_m"].is_null()
                           ? "at the floor still " + shown(stress["share_at_floor_ratio"], 100) +
                                 " % of that was added"
                           : "what was added falls to a tenth " +
                                 shown(stress["bulb_depth_m"], 1e3) + " mm below the foot"),
                  stress_map(scene, "Vertical stress", cut_y_m)});
  const Json& chains = measured["force_chains"];
  maps.push_back({"chains", "Force chains: contacts by their normal force",
                  "under the foot: " + shown(chains["strong_contacts"]) + " of " +
                      shown(chains["contacts"]) + " contacts above the mean of " +
                      shown(chains["mean_normal_N"]) + " N carry " +
                      shown(chains["strong_share_of_force_ratio"], 100) + " % of the force",
                  chain_map(scene, "Force chains", cut_y_m)});
  maps.push_back({"pressure", "Pressure on the soles and spines, by triangle, seen from above",
                  shown(pressure["high_pressure_share_ratio"], 100) +
                      " % of the plantar area above " + shown(pressure["high_threshold_Pa"], 1e-3) +
                      " kPa (load over plan); spines carry " +
                      shown(pressure["spine_load_share_ratio"], 100) + " % of the load",
                  pressure_map(scene, "Plantar pressure")});
  return maps;
}

}  // namespace hoof::tools
