#pragma once

#include <filesystem>
#include <string>

namespace hoof::tools {

/// The page report.html of a run folder: one file that opens offline, with the headline, what the
/// resolution can and cannot carry, plots of samples.csv, every key of result.json, the settings
/// and the version. Reads result.json, samples.csv and settings.toml of the folder; the same
/// folder gives the same bytes. UserError where a file is missing or malformed.
std::string make_report(const std::filesystem::path& run_folder);

/// Writes make_report() to report.html in the folder and returns that path. The page links to the
/// files that stand in the folder at that moment, so it is made last.
std::filesystem::path write_report(const std::filesystem::path& run_folder);

}  // namespace hoof::tools
