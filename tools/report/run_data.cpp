#include "tools/report/run_data.h"

#include <toml++/toml.h>

#include <algorithm>
#include <sstream>

#include "tools/run/errors.h"
#include "tools/run/output_file.h"

namespace hoof::tools {
namespace fs = std::filesystem;
namespace {

nlohmann::ordered_json read_json(const fs::path& path) {
  try {
    return nlohmann::ordered_json::parse(read_file(path));
  } catch (const nlohmann::json::parse_error& error) {
    throw UserError(path.string() + ": " + error.what());
  }
}

nlohmann::ordered_json parse_settings(const fs::path& path, const std::string& text) {
  try {
    std::ostringstream json;
    json << toml::json_formatter(toml::parse(text));
    return nlohmann::ordered_json::parse(json.str());
  } catch (const toml::parse_error& error) {
    const auto begin = error.source().begin;
    throw UserError(path.string() + ":" + std::to_string(begin.line) + ":" +
                    std::to_string(begin.column) + ": " + std::string(error.description()));
  }
}

std::vector<RunFile> list_files(const fs::path& run_folder) {
  std::vector<RunFile> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(run_folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_regular_file() && name != "report.html")
      files.push_back({name, entry.file_size()});
  }
  // Of the frames for ParaView the one that names them all, of drawings none: they are above.
  const fs::path frames = run_folder / "fields" / "fields.pvd";
  if (fs::exists(frames)) files.push_back({"fields/fields.pvd", fs::file_size(frames)});
  std::sort(files.begin(), files.end(),
            [](const RunFile& a, const RunFile& b) { return a.name < b.name; });
  return files;
}

void read_fields(const fs::path& run_folder, RunData& data) {
  data.fields = read_json(run_folder / "fields.json");
  try {
    for (const auto& map : data.fields.at("maps")) {
      data.maps.push_back(read_file(run_folder / map.at("file").get<std::string>()));
    }
    data.fields.at("moments");
  } catch (const nlohmann::json::exception& error) {
    throw UserError((run_folder / "fields.json").string() + ": " + error.what());
  }
  const fs::path view = run_folder / "fields" / "view.json";
  if (fs::exists(view)) data.view = read_file(view);
}

}  // namespace

RunData read_run_data(const fs::path& run_folder) {
  if (!fs::is_directory(run_folder)) {
    throw UserError(run_folder.string() + ": is no run folder (no such folder)");
  }
  RunData data;
  data.result = read_json(run_folder / "result.json");
  if (!data.result.is_object()) {
    throw UserError((run_folder / "result.json").string() + ": is no JSON object");
  }
  data.settings_text = read_file(run_folder / "settings.toml");
  data.settings = parse_settings(run_folder / "settings.toml", data.settings_text);
  data.samples = read_samples(run_folder / "samples.csv");
  const SampleColumn* time = data.samples.find("time_s");
  if (time == nullptr || time->numbers.empty()) {
    throw UserError((run_folder / "samples.csv").string() + ": no samples in a column time_s");
  }
  if (fs::exists(run_folder / "section.svg")) {
    data.section_svg = read_file(run_folder / "section.svg");
  }
  if (fs::exists(run_folder / "fields.json")) read_fields(run_folder, data);
  data.files = list_files(run_folder);
  return data;
}

}  // namespace hoof::tools
