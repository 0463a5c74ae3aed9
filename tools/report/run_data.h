#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/report/sample_table.h"

namespace hoof::tools {

/// A file that the report links to.
struct RunFile {
  std::string name;
  std::uintmax_t size_bytes = 0;
};

/// What a report is made from: the files of one run folder.
struct RunData {
  nlohmann::ordered_json result;    ///< result.json
  nlohmann::ordered_json settings;  ///< settings.toml, its tables as objects
  std::string settings_text;        ///< settings.toml as it stands
  SampleTable samples;              ///< samples.csv
  std::string section_svg;          ///< drawing of the foot in the sand; empty on other ground
  nlohmann::ordered_json fields;    ///< fields.json; null where the run kept none
  std::vector<std::string> maps;    ///< the drawings that its "maps" names, in their order
  std::string view;                 ///< fields/view.json as it stands; empty for none
  std::vector<RunFile> files;       ///< all files of the folder by name, but for report.html
};

/// UserError naming the file, and the line where known, if one is missing or malformed.
RunData read_run_data(const std::filesystem::path& run_folder);

}  // namespace hoof::tools
