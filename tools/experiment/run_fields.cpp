#include "tools/experiment/run_fields.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/experiment/bench.h"
#include "tools/experiment/foot_plan.h"
#include "tools/fields/field_export.h"
#include "tools/fields/field_map.h"
#include "tools/fields/field_measures.h"
#include "tools/fields/field_view.h"
#include "tools/run/output_file.h"
#include "tools/run/result_json.h"

namespace hoof::tools {
namespace {

using Json = nlohmann::ordered_json;

/// The foot's plan on its whole way with what is around it, down to the floor: as wide on each side
/// as three grains, or 40 mm, the width of the middle segment.
Eigen::AlignedBox3d region_of(const RunSettings& run, const sim::Rig& rig) {
  const Eigen::Vector2d print_m = foot_plan_m(run.foot, run.toe_rad()).sizes();
  const double margin_m = std::max(0.040, 3 * run.bed.d50_m());
  const double way_m = run.is_sinkage() ? 0 : run.traction.ellipse.half_length_m;
  const double middle_x_m = run.is_sinkage() ? rig.foot_position_m().x() : 0;
  const Eigen::Vector3d half(0.5 * print_m.x() + margin_m + way_m, 0.5 * print_m.y() + margin_m, 0);
  Eigen::AlignedBox3d region(Eigen::Vector3d(middle_x_m, 0, -run.bed.depth_m) - half,
                             Eigen::Vector3d(middle_x_m, 0, 0.2) + half);
  const Eigen::Vector3d box(0.5 * run.bed.box_length_m, 0.5 * run.bed.box_width_m, 1);
  return region.intersection(Eigen::AlignedBox3d(-box, box));
}

FieldPlan plan_of(const RunSettings& run, const Eigen::AlignedBox3d& region_m) {
  FieldPlan plan;
  plan.region_m = region_m;
  if (run.is_sinkage()) {
    // Twice as late each time: a foot sinks fast and comes to rest slowly.
    plan.after_contact_s = {0.005, 0.010, 0.020, 0.040, 0.080, 0.160, 0.320, 0.640, 1.280};
    return plan;
  }
  plan.phases_turns = {0.35, 0.40, 0.45, 0.50, 0.55, 0.60, 0.65};
  const sim::StanceEllipse ellipse = run.traction.ellipse;
  plan.turns = [ellipse](const Eigen::Vector3d& foot_m) {
    const double turns =
        std::atan2(foot_m.x() / ellipse.half_length_m,
                   (foot_m.z() - ellipse.centre_height_m) / ellipse.half_height_m) /
        (2 * std::numbers::pi);
    return turns < 0 ? turns + 1 : turns;
  };
  return plan;
}

FootShape shape_of(const RunSettings& run, const sim::Rig& rig) {
  std::vector<sim::TriangleMesh> meshes;
  for (int body = 0; body < rig.body_count(); ++body) meshes.push_back(rig.mesh(body));
  return FootShape::of(std::move(meshes), run.foot.geometry.has_spines);
}

bool is_headline(const std::string& name) {
  return name == "greatest depth" || name == "peak Fx" || name == "end";
}

}  // namespace

double cut_y_m(const RunSettings& run) {
  const sim::FootGeometry& g = run.foot.geometry;
  return g.has_spines ? g.spines.middle_row_offset_m : 0;
}

RunFields::RunFields(const RunSettings& run, const sim::Experiment& experiment)
    : run_(run),
      experiment_(experiment),
      setting_{bed().settings(), shape_of(run, experiment.plant().rig()),
               region_of(run, experiment.plant().rig()), run.bed.d50_m()},
      recorder_(plan_of(run, setting_.region_m)) {}

/// What fields.json says of itself, and room for the moments.
Json RunFields::described() const {
  const auto numbers = [](const Eigen::Vector3d& v) { return Json{v.x(), v.y(), v.z()}; };
  Json j;
  j["region_low_m"] = numbers(setting_.region_m.min());
  j["region_high_m"] = numbers(setting_.region_m.max());
  j["d50_m"] = setting_.d50_m;
  j["zone_under_foot"] = "below the foot's plan, from its lowest point " +
                         std::to_string(int(FieldScene::kZone_d50)) + " d50 down";
  j["definitions"] = "tools/fields/README.md";
  j["maps"] = Json::array();
  j["moments"] = Json::array();
  return j;
}

const sim::SandBed& RunFields::bed() const {
  return *find_sand(experiment_.plant().terrain());
}

void RunFields::tick(const sim::Observation& plant) {
  recorder_.tick(plant, experiment_.plant().rig(), bed());
  last_ = plant;
}

void RunFields::write(const std::filesystem::path& folder, Json& result) {
  const std::vector<FieldMoment> moments =
      recorder_.finish(last_, experiment_.plant().rig(), bed());
  if (moments.empty()) return;
  const std::filesystem::path fields = folder / "fields";
  std::filesystem::create_directory(fields);
  const FieldScene contact(setting_, moments.front());
  std::optional<VtkSeries> series;
  if (run_.fields == "vtk") series.emplace(fields, "fields");
  FieldView view(setting_);
  Json all = described();
  for (const FieldMoment& moment : moments) {
    const FieldScene scene(setting_, moment);
    const Json measured = measure_fields(scene, contact);
    all["moments"].push_back(measured);
    view.add(scene, contact.moment);
    if (series) add_frame(*series, scene, contact.moment);
    if (!is_headline(moment.name)) continue;
    std::string key = moment.name;
    std::replace(key.begin(), key.end(), ' ', '_');
    result["fields"][key] = field_headline(measured);
    for (const FieldMap& map : field_maps(scene, contact.moment, measured, cut_y_m(run_))) {
      const std::string file = "fields/" + key + "-" + map.key + ".svg";
      write_file(folder / file, map.svg);
      all["maps"].push_back(
          {{"moment", moment.name}, {"file", file}, {"title", map.title}, {"number", map.number}});
    }
  }
  write_result_json(folder / "fields.json", all);
  write_file(fields / "view.json", view.finish().dump());
}

}  // namespace hoof::tools
