#include "tools/bed/grain_export.h"

#include <algorithm>
#include <utility>

#include "tools/bed/whole_file.h"
#include "tools/run/csv_writer.h"

namespace hoof::tools {
namespace {

/// Three floats for each vector, as VTK wants them.
class Vectors {
 public:
  void add(const Eigen::Vector3d& v) {
    values_.insert(values_.end(), {float(v.x()), float(v.y()), float(v.z())});
  }
  VtkArray named(const char* name) { return {name, 3, std::move(values_)}; }

 private:
  std::vector<float> values_;
};

std::vector<Eigen::Vector3d> forces(const sim::DemSettings& settings, const sim::BedState& state) {
  return sim::forces_on_grains(state, sim::loaded_contacts(settings, state));
}

}  // namespace

bool GrainSelection::holds(const sim::Grain& grain) const {
  if (grain.id % every != 0) return false;
  return !region || ((grain.p_m.array() >= region->low_m.array()).all() &&
                     (grain.p_m.array() <= region->high_m.array()).all());
}

PolyData grain_points(const sim::DemSettings& settings, const sim::BedState& state,
                      const GrainSelection& selection) {
  PolyData data;
  std::vector<std::int32_t> id, type;
  std::vector<float> radius;
  Vectors v, omega, f;
  const std::vector<Eigen::Vector3d> f_N = forces(settings, state);
  for (std::size_t i = 0; i < state.grains.size(); ++i) {
    const sim::Grain& g = state.grains[i];
    if (!selection.holds(g)) continue;
    data.connectivity.push_back(std::int64_t(data.point_count()));
    data.add_point(g.p_m);
    id.push_back(std::int32_t(g.id));
    type.push_back(1);
    radius.push_back(float(g.radius_m));
    v.add(g.v_m_s), omega.add(g.w_rad_s), f.add(f_N[i]);
  }
  data.point_arrays = {{"id", 1, std::move(id)},
                       {"type", 1, std::move(type)},
                       {"radius", 1, std::move(radius)},
                       v.named("v"),
                       omega.named("omega"),
                       f.named("f")};
  return data;
}

PolyData contact_lines(const sim::DemSettings& settings, const sim::BedState& state,
                       const GrainSelection& selection) {
  PolyData data;
  data.cell = PolyData::Cell::kLine;
  std::vector<std::int32_t> id1, id2;
  std::vector<float> delta;
  Vectors force, normal, tangential;
  std::vector<std::pair<std::uint32_t, const sim::Grain*>> shown;  // by id, as the state
  for (const sim::Grain& g : state.grains) {
    if (selection.holds(g)) shown.push_back({g.id, &g});
  }
  const auto find = [&](std::uint32_t grain_id) -> const sim::Grain* {
    const auto at = std::lower_bound(shown.begin(), shown.end(), grain_id,
                                     [](const auto& g, std::uint32_t v) { return g.first < v; });
    return at != shown.end() && at->first == grain_id ? at->second : nullptr;
  };
  for (const sim::LoadedContact& c : sim::loaded_contacts(settings, state)) {
    const bool wall = c.j >= sim::GrainContact::kWallContact;
    const sim::Grain* g = find(c.i);
    if (g == nullptr || (!wall && find(c.j) == nullptr)) continue;
    for (const Eigen::Vector3d& end : {g->p_m, Eigen::Vector3d(g->p_m + c.to_j_m)}) {
      data.connectivity.push_back(std::int64_t(data.point_count()));
      data.add_point(end);
    }
    id1.push_back(std::int32_t(c.i));
    id2.push_back(wall ? -1 - std::int32_t(c.j - sim::GrainContact::kWallContact)
                       : std::int32_t(c.j));
    delta.push_back(float(c.overlap_m));
    force.add(c.f_normal_N + c.f_tangential_N);
    normal.add(c.f_normal_N), tangential.add(c.f_tangential_N);
  }
  data.cell_arrays = {{"id1", 1, std::move(id1)},     {"id2", 1, std::move(id2)},
                      {"delta", 1, std::move(delta)}, force.named("force"),
                      normal.named("force_normal"),   tangential.named("force_tangential")};
  return data;
}

PolyData mesh_triangles(const sim::TriangleMesh& mesh, const Eigen::Vector3d& p_WB_m,
                        const Eigen::Quaterniond& q_WB) {
  PolyData data;
  data.cell = PolyData::Cell::kTriangle;
  for (const Eigen::Vector3d& v : mesh.vertices_m) data.add_point(p_WB_m + q_WB * v);
  for (const auto& triangle : mesh.triangles) {
    for (const auto corner : triangle) data.connectivity.push_back(std::int64_t(corner));
  }
  return data;
}

void write_grain_csv(const std::filesystem::path& file, const sim::DemSettings& settings,
                     const sim::BedState& state, const GrainSelection& selection) {
  const std::vector<Eigen::Vector3d> f_N = forces(settings, state);
  WholeFile out(file);
  out.write(
      "id,radius_m,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,wx_rad_s,wy_rad_s,wz_rad_s,fx_N,fy_N,fz_N\n");
  std::string row;
  for (std::size_t i = 0; i < state.grains.size(); ++i) {
    const sim::Grain& g = state.grains[i];
    if (!selection.holds(g)) continue;
    row = std::to_string(g.id) + "," + format_number(g.radius_m);
    for (const Eigen::Vector3d* v : {&g.p_m, &g.v_m_s, &g.w_rad_s, &f_N[i]}) {
      for (int axis = 0; axis < 3; ++axis) row += "," + format_number((*v)[axis]);
    }
    out.write(row += "\n");
  }
  out.commit();
}

}  // namespace hoof::tools
