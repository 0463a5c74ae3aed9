#include "tools/reproduce/ground.h"

namespace hoof::tools {

std::vector<std::string> Ground::settings() const {
  std::vector<std::string> all = {"use.bed=" + scale, "experiment.terrain=" + terrain};
  // 5.6 us, 27 % of the Rayleigh time, for the preset's 2.8: the step of the studies in
  // RESOLUTION.md, and half the cost.
  if (scale == "bench") all.push_back("bed.steps_per_ms=180");
  return all;
}

std::filesystem::path Ground::folder() const {
  return std::filesystem::path("runs") /
         ("reproduce-" + scale + (terrain == "dem" ? "" : "-" + terrain));
}

Design Ground::design() const {
  return scale == "bench" && terrain == "dem" ? Design::kNight : Design::kStated;
}

}  // namespace hoof::tools
