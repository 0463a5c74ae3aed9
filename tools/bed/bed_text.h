// A bed's report for people and for programs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "sim/terrain/bed_report.h"
#include "tools/bed/bed_source.h"

namespace hoof::tools {

nlohmann::ordered_json bed_json(const ChosenBed& origin, const sim::BedReport& report);

/// The same, some lines with units.
std::string bed_text(const ChosenBed& origin, const sim::BedReport& report);

/// How the making of this bed went, from the file beside it; null where there is none.
nlohmann::ordered_json read_making(const std::filesystem::path& bed_file);
void write_making(const std::filesystem::path& bed_file, const nlohmann::ordered_json& making);

}  // namespace hoof::tools
