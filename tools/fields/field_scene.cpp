#include "tools/fields/field_scene.h"

#include <algorithm>
#include <numbers>

#include "sim/terrain/bed_contacts.h"

namespace hoof::tools {
namespace {

std::vector<ForceLine> lines_of(const FieldSetting& setting, const FieldMoment& moment) {
  const std::vector<sim::Grain>& grains = moment.sand.grains;
  std::vector<ForceLine> lines;
  for (const sim::LoadedContact& c : sim::loaded_contacts(setting.dem, moment.sand)) {
    const bool wall = c.j >= sim::GrainContact::kWallContact;
    ForceLine line;
    line.i = std::int32_t(find_grain(grains, c.i));
    line.j = wall ? ForceLine::kWall : std::int32_t(find_grain(grains, c.j));
    line.from_m = grains[std::size_t(line.i)].p_m;
    line.to_m = line.from_m + c.to_j_m;
    line.f_N = c.f_normal_N + c.f_tangential_N;
    line.f_normal_N = -c.f_normal_N.dot(c.to_j_m.normalized());
    line.overlap_m = c.overlap_m;
    lines.push_back(line);
  }
  for (const sim::MeshTouch& t : moment.touches) {
    const std::ptrdiff_t i = find_grain(grains, t.grain);
    if (i < 0) continue;  // outside of what was kept
    ForceLine line;
    line.i = std::int32_t(i);
    line.j = ForceLine::kFoot;
    line.body = std::int32_t(t.mesh);
    line.from_m = t.p_W_m + t.to_grain_m;
    line.to_m = t.p_W_m;
    line.f_N = t.f_normal_N + t.f_tangential_N;
    line.f_normal_N = t.f_normal_N.dot(t.to_grain_m.normalized());
    line.overlap_m = t.overlap_m;
    lines.push_back(line);
  }
  return lines;
}

}  // namespace

std::ptrdiff_t find_grain(const std::vector<sim::Grain>& grains, std::uint32_t id) {
  const auto at = std::lower_bound(grains.begin(), grains.end(), id,
                                   [](const sim::Grain& g, std::uint32_t v) { return g.id < v; });
  return at != grains.end() && at->id == id ? at - grains.begin() : -1;
}

FieldScene::FieldScene(const FieldSetting& s, const FieldMoment& m)
    : setting(s),
      moment(m),
      foot(s.shape, m.poses),
      plan(foot, s.region_m),
      low_m(foot.lowest_m()),
      lines(lines_of(s, m)) {}

bool FieldScene::in_zone(const Eigen::Vector3d& p_m) const {
  return p_m.z() <= low_m && p_m.z() >= zone_bottom_m() && plan.covers(p_m.x(), p_m.y());
}

double FieldScene::load_N() const {
  double load_N = 0;
  for (const sim::MeshTouch& t : moment.touches) load_N -= (t.f_normal_N + t.f_tangential_N).z();
  return load_N;
}

double FieldScene::mass_kg(const sim::Grain& g) const {
  return setting.dem.grain_material.density_kg_m3 * 4 / 3 * std::numbers::pi * g.radius_m *
         g.radius_m * g.radius_m;
}

}  // namespace hoof::tools
