#include "tools/run/csv_writer.h"
#include "tools/study/foot_proof.h"

namespace hoof::tools {

std::string FootProofCase::toml() const {
  if (effect.empty()) return "";
  std::string text = "format = 1\n\n[effects." + effect + "]\n";
  for (const auto& [key, value] : values) text += key + " = " + format_number(value) + "\n";
  if (!joint.empty()) text += "joint = \"" + joint + "\"\n";
  return text;
}

const std::vector<FootProofCase>& foot_proof_cases() {
  const std::string sinkage = "sinkage", traction = "traction";
  const std::vector<std::string> gait = {"experiment.frequency_Hz=1.1"};
  static const std::vector<FootProofCase> cases = {
      {"nothing", "", "", {}, sinkage, {}, true, "a plant that lacks nothing"},
      {"toe-play",
       "backlash",
       "toe",
       {{"gap", 0.012}},
       sinkage,
       {},
       true,
       "the foot sinks as ever; the toes' loop closes on the motor's side of the play"},
      {"worn-spines",
       "spine_wear",
       "",
       {{"loss", 0.004}},
       sinkage,
       {},
       true,
       "the joints hold their goals as ever"},
      {"nothing-gait", "", "", {}, traction, gait, false, "a plant that lacks nothing"},
      {"hip-friction",
       "load_dependent_friction",
       "hip",
       {{"coefficient", 0.08}},
       traction,
       gait,
       false,
       "the position loop pushes as much harder, and the hip moves as ever"},
      {"cohesive-sand",
       "cohesion",
       "",
       {{"strength", 3000}},
       sinkage,
       {},
       false,
       "0.2 mm of depth"},
      {"layered-sand",
       "hard_layer",
       "",
       {{"depth", 0.008}, {"ratio", 3}},
       sinkage,
       {},
       false,
       "0.2 mm of depth, and none before the spines reach the layer"},
      {"wall-near",
       "wall_confinement",
       "",
       {{"coefficient", 8}},
       sinkage,
       {},
       false,
       "0.1 mm of depth"}};
  return cases;
}

}  // namespace hoof::tools
