#include "tools/calibrate/findings.h"

#include <cmath>
#include <cstdio>
#include <limits>

#include "sim/config/settings.h"
#include "tools/report/html.h"
#include "tools/report/page.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"
#include "tools/run/result_json.h"
#include "tools/run/version.h"

namespace hoof::tools {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string number(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  char text[40];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string number(const std::optional<double>& value, int digits) {
  return value ? number(*value, digits) : "-";
}

std::string band(const Target& t) {
  if (!t.has_band()) return "-";
  if (!t.low) return "at most " + number(t.high, t.digits);
  if (!t.high) return "at least " + number(t.low, t.digits);
  return number(t.low, t.digits) + " to " + number(t.high, t.digits);
}

std::string verdict(const Target& t) {
  return !t.has_band() ? "-" : t.inside() ? "inside" : "OUTSIDE";
}

Table target_table(const Findings& f) {
  Table table({{"target_name", 0},
               {"paper_name", 0},
               {"accepted_name", 0},
               {"ours_name", 0},
               {"verdict_name", 0}});
  for (const Target& t : f.targets) {
    table.row({t.name + (t.unit.empty() ? "" : ", " + t.unit), number(t.paper, t.digits), band(t),
               number(t.ours, t.digits), verdict(t)});
  }
  return table;
}

Table reading_table(const Findings& f) {
  Table table({{"analysis_name", 0}, {"value_name", 0}, {"why_name", 0}});
  for (const Reading& r : f.readings) {
    table.row({r.analysis, number(r.value, f.reading_digits), r.why});
  }
  return table;
}

std::string heading(const std::string& text) {
  return element("h2", text);
}

std::string html_row(const std::vector<std::string>& cells, const char* tag) {
  std::string html = "<tr>";
  for (const std::string& cell : cells) html += element(tag, cell);
  return html + "</tr>\n";
}

std::string page(const Findings& f) {
  std::string body;
  for (const std::string& text : f.about) body += element("p", text) + "\n";
  body += heading("Against the paper") + "<table>\n" +
          html_row({"target", "paper", "accepted", "ours", ""}, "th");
  for (const Target& t : f.targets) {
    body += html_row({t.name + (t.unit.empty() ? "" : " [" + t.unit + "]"),
                      number(t.paper, t.digits), band(t), number(t.ours, t.digits), verdict(t)},
                     "td");
  }
  body += "</table>\n";
  if (!f.lines.empty())
    body += draw_lines(f.title, f.x_label, f.y_label, f.lines, PlotAxes::kTight);
  if (!f.readings.empty()) {
    body += heading(capitalised(f.readings_of)) + "<table>\n" +
            html_row({"analysis", "value", "why"}, "th");
    for (const Reading& r : f.readings) {
      body += html_row({r.analysis, number(r.value, f.reading_digits), r.why}, "td");
    }
    body += "</table>\n";
  }
  if (!f.notes.empty()) {
    body += heading("What these numbers do not tell") + "<ul>\n";
    for (const std::string& note : f.notes) body += element("li", note) + "\n";
    body += "</ul>\n";
  }
  body +=
      element("p", "Beside this page: result.json (the same for programs), runs.csv (every run).",
              " class=\"note\"");
  return make_page(f.title, body, R"({"time_s":[],"plots":[],"phases":[]})");
}

Json optional_json(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json pair_json(const sim::ContactPair& pair) {
  return {{"restitution", pair.restitution.value},
          {"static_friction", pair.static_friction.value},
          {"rolling_friction", pair.rolling_friction.value}};
}

Json result(const Findings& f, const sim::Materials& materials) {
  Json json;
  json["format"] = 1;
  json["laboratory"] = f.laboratory;
  json["version"] = version_json();
  json["sand_sand"] = pair_json(materials.sand_sand);
  json["sand_abs"] = pair_json(materials.sand_abs);
  json["about"] = f.about;
  json["targets"] = Json::array();
  for (const Target& t : f.targets) {
    Json entry = {{"name", t.name},
                  {"unit", t.unit.empty() ? "1" : t.unit},
                  {"paper", optional_json(t.paper)},
                  {"low", optional_json(t.low)},
                  {"high", optional_json(t.high)},
                  {"ours", std::isfinite(t.ours) ? Json(t.ours) : Json(nullptr)}};
    entry["inside"] = t.has_band() ? Json(t.inside()) : Json(nullptr);
    json["targets"].push_back(entry);
  }
  json["readings_of"] = f.readings_of;
  json["readings"] = Json::array();
  for (const Reading& r : f.readings) {
    json["readings"].push_back({{"analysis", r.analysis},
                                {"value", std::isfinite(r.value) ? Json(r.value) : Json(nullptr)},
                                {"why", r.why}});
  }
  json["notes"] = f.notes;
  return json;
}

void put(sim::Measured& into, const std::optional<double>& flag, const char* name) {
  if (flag) into = {*flag, 0, std::string("--") + name};
}

}  // namespace

bool Target::inside() const {
  return (!low || ours >= *low) && (!high || ours <= *high);  // a NaN is out
}

sim::Materials lab_materials(const fs::path& file, const CoefficientFlags& flags,
                             sim::ContactPair sim::Materials::*pair) {
  const fs::path from =
      file.empty() ? sim::default_config_dir() / "materials" / "paper.toml" : file;
  const sim::Settings settings = sim::Settings::load_file(from);
  sim::Materials materials = sim::read_materials(sim::Reader(settings));
  sim::ContactPair& contact = materials.*pair;
  put(contact.restitution, flags.restitution, "e");
  put(contact.static_friction, flags.static_friction, "mu-s");
  put(contact.rolling_friction, flags.rolling_friction, "mu-r");
  return materials;
}

std::string findings_text(const Findings& f) {
  std::string text = f.title + "\n";
  for (const std::string& line : f.about) text += line + "\n";
  text += "\n" + target_table(f).markdown();
  if (f.rows) text += "\n" + f.rows->markdown();
  if (!f.readings.empty()) {
    text += "\n" + capitalised(f.readings_of) + ":\n\n" + reading_table(f).markdown();
  }
  if (!f.notes.empty()) text += "\n";
  for (const std::string& note : f.notes) text += "Note: " + note + "\n";
  return text;
}

void write_findings(const Findings& f, const sim::Materials& materials, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw UserError("--out " + folder.string() + ": cannot be made: " + error.message());
  if (f.runs) f.runs->write_csv(folder / "runs.csv");
  if (f.rows) f.rows->write_csv(folder / (f.rows_name + ".csv"));
  if (f.design) f.design->write_csv(folder / "design.csv");
  write_file(folder / "report.html", page(f));
  write_result_json(folder / "result.json", result(f, materials));
}

}  // namespace hoof::tools
