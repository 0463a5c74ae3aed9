// What the runs of a campaign stand on, the same for hoof reproduce and hoof claims, which share
// its folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/reproduce/cell.h"

namespace hoof::tools {

struct Ground {
  std::string scale = "demo";   // preset of the bed: demo, medium, bench, paper
  std::string terrain = "dem";  // or "rft", "rigid": quick looks that are no sand

  CampaignSettings settings() const;
  /// Where nobody says another: runs/reproduce-SCALE, without grains -TERRAIN behind it.
  std::filesystem::path folder() const;
  /// Where nobody says another: what two cores can make of it in a night, else kStated.
  Design design() const;
};

}  // namespace hoof::tools
