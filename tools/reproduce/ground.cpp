#include "tools/reproduce/ground.h"

namespace hoof::tools {
namespace {

void append(std::vector<std::string>& to, const std::vector<std::string>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

}  // namespace

CampaignSettings Ground::settings() const {
  CampaignSettings settings;
  settings.of_all = {"use.bed=" + scale, "experiment.terrain=" + terrain};
  // 5.6 and 8.3 us, 27 % of the Rayleigh time, for the presets' 13 and 16: the step of the studies
  // in RESOLUTION.md.
  if (scale == "bench") settings.of_all.push_back("bed.steps_per_ms=180");
  if (scale == "medium") settings.of_all.push_back("bed.steps_per_ms=120");
  if (scale != "bench" && scale != "medium") return settings;
  // Sand that nothing touches yet costs as much as sand under a foot: it wakes at 1 mm below the
  // foot for the preset's 5, and a foot rests once it trembles at less than 20 mm/s for its 5. It
  // rings at 60 Hz and more then, less than 0.05 mm to either side. Half the cost of a sinkage
  // again.
  settings.of_all.push_back("coupling.sleep_margin_mm=1");
  settings.of_sinkage = {"experiment.rest_speed_mm_s=20"};
  // A foot that is pulled through sand goes 188 mm to either side: their box of 320 mm would stop
  // it at a wall. It gets one as long as the paper's, and on bench the grains of medium: the
  // paper's own would take sixteen core hours for the night's twenty-five runs.
  settings.of_traction = {"bed.box_length_mm=530"};
  if (scale == "bench") {
    append(settings.of_traction, {"use.bed=medium", "bed.steps_per_ms=120"});
  }
  return settings;
}

std::filesystem::path Ground::folder() const {
  return std::filesystem::path("runs") /
         ("reproduce-" + scale + (terrain == "dem" ? "" : "-" + terrain));
}

Design Ground::design() const {
  return scale == "bench" && terrain == "dem" ? Design::kNight : Design::kStated;
}

}  // namespace hoof::tools
