#include "tools/report/fields_section.h"

#include <cstdio>
#include <tuple>

#include "tools/report/assets.h"
#include "tools/report/headline.h"
#include "tools/report/html.h"

namespace hoof::tools {
namespace {

using Json = nlohmann::ordered_json;

/// What stands in the table, by the path of the value in a moment.
struct Row {
  const char* pointer;
  const char* label;
};
constexpr Row kRows[] = {
    {"/depth_m", "depth"},
    {"/fx_N", "forward force of the ground, Fx"},
    {"/fz_N", "upward force of the ground, Fz"},
    {"/motion/speed_mean_m_s", "mean speed of the grains under the foot"},
    {"/motion/kinetic_energy_J", "kinetic energy of the grains"},
    {"/motion/kinetic_90_depth_m", "depth that 90 % of it is above"},
    {"/motion/kinetic_90_length_m", "length that 90 % of it is in"},
    {"/motion/kinetic_90_volume_m3", "least volume that holds 90 % of it"},
    {"/motion/displacement_mean_m", "mean displacement under the foot"},
    {"/motion/rearward_speed_at_spines_m_s", "rearward speed at the spines"},
    {"/pressure/touched_area_m2", "area of the sole's triangles that are touched"},
    {"/pressure/hertz_contact_area_m2", "true contact area (Hertz)"},
    {"/pressure/high_threshold_Pa", "threshold of high pressure (load over plan)"},
    {"/pressure/high_pressure_share_ratio", "share of the plantar area above it"},
    {"/pressure/spine_load_share_ratio", "share of the load that spines carry"},
    {"/packing/coordination", "coordination number under the foot"},
    {"/packing/coordination_at_contact", "the same place at first contact"},
    {"/packing/dilation_ratio", "dilation there since"},
    {"/stress/bulb_depth_m", "depth where added stress falls to 10 %"},
    {"/stress/share_at_floor_ratio", "added stress at the floor over load / plan"},
    {"/force_chains/strong_share_of_force_ratio", "share of force in contacts above the mean"},
    {"/arch/gap_area_m2", "gap between the toes and the middle, plan"},
    {"/arch/gap_mean_width_m", "mean width of the gap"},
    {"/arch/paths", "strong chains of grains over the gap"},
    {"/arch/path_force_N", "force they could pass on"},
    {"/arch/gap_over_foot_stress_ratio",
     "added stress under the gap over that under the foot, 1 to 2 d50 below"},
    {"/arch/support_area_over_plan_ratio", "supporting area, 1 to 2 d50 below, over the plan"}};

/// In units of which there are not thousands or thousandths under a foot.
HeadlineRow shown_row(const Row& row, const std::string& key, const Json& value) {
  constexpr std::tuple<const char*, double, const char*> kUnits[] = {
      {"_m2", 1e4, "cm²"}, {"_m3", 1e6, "cm³"}, {"_Pa", 1e-3, "kPa"}, {"_J", 1e3, "mJ"}};
  for (const auto& [ending, factor, symbol] : kUnits) {
    if (!key.ends_with(ending) || !value.is_number()) continue;
    return {row.label, headline_row("", "", factor * value.get<double>()).value, symbol};
  }
  return headline_row(row.label, key, value);
}

std::string numbers_table(const Json& moments) {
  std::string html = "<div class=\"wide numbers\"><table><tr><th></th><th></th>";
  for (const Json& m : moments) {
    html += element("th", m.at("name").get<std::string>(), " class=\"number\" scope=\"col\"");
  }
  html += "</tr>\n";
  for (const Row& row : kRows) {
    const Json::json_pointer pointer(row.pointer);
    html += "<tr>" + element("th", row.label, " scope=\"row\"");
    std::string unit, cells;
    for (const Json& m : moments) {
      const Json value = m.contains(pointer) ? m.at(pointer) : Json(nullptr);
      std::string text = "-";
      if (!value.is_null()) {
        const HeadlineRow shown = shown_row(row, pointer.back(), value);
        text = shown.value, unit = shown.unit;
      }
      cells += element("td", text, " class=\"number\"");
    }
    html += element("td", unit, " class=\"unit\"") + cells + "</tr>\n";
  }
  return html + "</table></div>\n";
}

/// What so coarse a bed cannot tell of these.
std::string resolution_note(const RunData& data) {
  static const Json::json_pointer kWidth("/resolution/sole_width_over_d50");
  if (!data.result.contains(kWidth) || data.fields.at("moments").empty()) return "";
  // Below ten grains a mean over a width is one of single grains; continuum laws of sand are asked
  // for some 10 grains (GDR MiDi, Eur. Phys. J. E 14 (2004), 341-365, shear bands of 5 to 10).
  constexpr double kFewGrains = 10;
  const double width = data.result.at(kWidth).get<double>();
  if (width >= kFewGrains) return "";
  char text[500];
  std::snprintf(text, sizeof text,
                "The sole is %.1f grains wide. Pressures, chains and paths over the gap are those "
                "of single grains and change from bed to bed as much as from foot to foot; the "
                "maps show where and how, not how much. Means over the zone under the foot hold "
                "%d grains here.",
                width, data.fields.at("moments").back().at("packing").value("grains", 0));
  return "<div class=\"refused\"><strong>What grains this coarse cannot tell</strong>" +
         element("p", text) + "</div>\n";
}

std::string maps(const RunData& data) {
  std::string html, moment;
  const Json& list = data.fields.at("maps");
  for (std::size_t i = 0; i < data.maps.size(); ++i) {
    const auto text = [&](const char* key) { return list[i].value(key, std::string()); };
    if (text("moment") != moment) {
      html += moment.empty() ? "" : "</div>\n";
      moment = text("moment");
      html += element("h3", capitalised(moment)) + "\n<div class=\"plots maps\">\n";
    }
    html += "<figure class=\"plot\"><h3>" + html_escape(text("title")) + "</h3>" + data.maps[i] +
            element("figcaption", text("number")) + "</figure>\n";
  }
  return html + (moment.empty() ? "" : "</div>\n");
}

std::string view(const std::string& view_json) {
  if (view_json.empty()) return "";
  std::string html =
      "<h3>In three dimensions</h3>\n<p class=\"note\">Drag to turn, wheel to come nearer, right "
      "button to move. Grains and foot in front of the plane that the slider sets are left out; "
      "chains are contacts "
      "above the mean, as wide as they press.</p>\n<div id=\"view\"><form>"
      "<label>moment <input type=\"range\" name=\"moment\" min=\"0\" max=\"1\" step=\"1\" "
      "autocomplete=\"off\"></label> "
      "<label>cut at y <input type=\"range\" name=\"cut\" min=\"-1\" max=\"1\" step=\"1\" "
      "autocomplete=\"off\"></label> "
      "<label>grains by <select name=\"colour\" autocomplete=\"off\">"
      "<option value=\"speed\">speed</option>"
      "<option value=\"displacement\">displacement</option>"
      "<option value=\"force\">force</option></select></label> ";
  for (const char* part : {"grains", "chains", "foot"}) {
    html += "<label><input type=\"checkbox\" name=\"" + std::string(part) +
            "\" checked autocomplete=\"off\"> " + part + "</label> ";
  }
  html +=
      "</form><p class=\"message\"></p><div class=\"canvas\"></div><p class=\"bar-line\">0 <i "
      "class=\"bar-colours\"></i> <span class=\"bar-end\"></span></p></div>\n"
      "<noscript>The view needs JavaScript.</noscript>\n";
  html += "<script type=\"application/json\" id=\"fields-view\">" + json_for_script(view_json) +
          "</script>\n<script>";
  html += assets::three_bundle_min_js;
  html += "</script>\n<script>";
  html += assets::view_js;
  return html + "</script>\n";
}

}  // namespace

std::string fields_section(const RunData& data) {
  if (data.fields.is_null()) return "";
  return "<h2>The sand under the foot</h2>\n<p class=\"note\">By moment; changes count from first "
         "contact. Zones, thresholds and formulae: tools/fields/README.md; every value with its "
         "key: fields.json.</p>\n" +
         numbers_table(data.fields.at("moments")) + resolution_note(data) + maps(data) +
         view(data.view);
}

}  // namespace hoof::tools
