#include "tools/fields/field_export.h"

#include "tools/bed/grain_export.h"
#include "tools/fields/sand_motion.h"
#include "tools/fields/sole_pressure.h"

namespace hoof::tools {
namespace {

VtkArray vectors(const char* name, const std::vector<Eigen::Vector3d>& values) {
  std::vector<float> flat;
  for (const Eigen::Vector3d& v : values) {
    flat.insert(flat.end(), {float(v.x()), float(v.y()), float(v.z())});
  }
  return {name, 3, std::move(flat)};
}

std::int32_t part_number(FootPart part) {
  return part == FootPart::kSole ? 1 : part == FootPart::kSpine ? 2 : 0;
}

void add_line(PolyData& data, const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m) {
  for (const Eigen::Vector3d& end_m : {from_m, to_m}) {
    data.connectivity.push_back(std::int64_t(data.point_count()));
    data.add_point(end_m);
  }
}

}  // namespace

PolyData field_grains(const FieldScene& scene, const FieldMoment& contact) {
  PolyData data = grain_points(scene.setting.dem, scene.moment.sand, {});
  std::vector<Eigen::Vector3d> f_foot_N(scene.moment.sand.grains.size(), Eigen::Vector3d::Zero());
  for (const ForceLine& line : scene.lines) {
    if (line.j == ForceLine::kFoot) f_foot_N[std::size_t(line.i)] += line.f_N;
  }
  data.point_arrays.push_back(vectors("displacement", displacements_m(contact, scene.moment)));
  data.point_arrays.push_back(vectors("f_foot", f_foot_N));
  return data;
}

PolyData foot_contacts(const FieldScene& scene) {
  PolyData data;
  data.cell = PolyData::Cell::kLine;
  std::vector<std::int32_t> id, body, part;
  std::vector<Eigen::Vector3d> force, normal;
  for (const sim::MeshTouch& t : scene.moment.touches) {
    add_line(data, t.p_W_m + t.to_grain_m, t.p_W_m);
    id.push_back(std::int32_t(t.grain)), body.push_back(std::int32_t(t.mesh));
    part.push_back(part_number(scene.foot.triangle(t.mesh, t.triangle).part));
    force.push_back(t.f_normal_N + t.f_tangential_N), normal.push_back(t.f_normal_N);
  }
  data.cell_arrays = {{"id", 1, std::move(id)},
                      {"body", 1, std::move(body)},
                      {"part", 1, std::move(part)},
                      vectors("force", force),
                      vectors("force_normal", normal)};
  return data;
}

PolyData foot_pressure(const FieldScene& scene) {
  PolyData data;
  data.cell = PolyData::Cell::kTriangle;
  std::vector<std::int32_t> body, part;
  for (const FootTriangle& t : scene.foot.triangles) {
    for (const Eigen::Vector3d& p_m : t.corners_m) {
      data.connectivity.push_back(std::int64_t(data.point_count()));
      data.add_point(p_m);
    }
    body.push_back(t.body), part.push_back(part_number(t.part));
  }
  std::vector<float> pressure;
  for (const double p_Pa : triangle_pressure_Pa(scene)) pressure.push_back(float(p_Pa));
  data.cell_arrays = {{"pressure", 1, std::move(pressure)},
                      {"body", 1, std::move(body)},
                      {"part", 1, std::move(part)}};
  return data;
}

void add_frame(VtkSeries& series, const FieldScene& scene, const FieldMoment& contact) {
  const double time_s = scene.moment.time_s;
  series.add(time_s, "grains", field_grains(scene, contact));
  series.add(time_s, "contacts", contact_lines(scene.setting.dem, scene.moment.sand, {}));
  series.add(time_s, "foot-contacts", foot_contacts(scene));
  series.add(time_s, "foot", foot_pressure(scene));
}

}  // namespace hoof::tools
