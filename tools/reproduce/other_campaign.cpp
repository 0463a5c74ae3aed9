#include "tools/reproduce/other_campaign.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tools/run/errors.h"
#include "tools/run/output_file.h"

namespace hoof::tools {
namespace {

std::string told(const nlohmann::json& target, const std::string& bed) {
  if (target.value("result", "") == "inside") {
    const auto& ours = target.at("ours");
    const int beds = ours.at("beds");
    char text[80];
    std::snprintf(text, sizeof text, ", %d %s, inside as it is: %.3g", beds,
                  beds == 1 ? "bed" : "beds", ours.at("mean").get<double>());
    return "on " + bed + text;
  }
  const std::string found = target.value("found", "");
  return found.empty() ? "" : "on " + bed + " " + found;
}

}  // namespace

void ask_other_campaign(std::vector<Comparison>& rows, const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "summary.json";
  try {
    const auto other = nlohmann::json::parse(read_file(file));
    if (other.at("terrain") != "dem") {
      throw UserError(file.string() + ": terrain is " + std::string(other.at("terrain")) +
                      ", and only grains tell of grains");
    }
    const std::string bed = other.at("scale");
    for (const auto& target : other.at("targets")) {
      const std::string name = target.at("target");
      const auto row = std::find_if(rows.begin(), rows.end(),
                                    [&](const Comparison& one) { return one.name == name; });
      if (row == rows.end() || row->judgement() != Judgement::kOutside) continue;
      // The same runs on both say the same.
      if (target.value("found", "") == row->found() && !row->found().empty()) continue;
      row->elsewhere = told(target, bed);
    }
  } catch (const nlohmann::json::exception& error) {
    throw UserError(file.string() + ": " + error.what());
  }
}

}  // namespace hoof::tools
