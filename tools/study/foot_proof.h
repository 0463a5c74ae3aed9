// One proof: a session of the foot from a plant with a concealed effect, the tool's answer to it
// without being told, and a second run with what it found.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "tools/diagnose/verdict.h"

namespace hoof::tools {

struct FootProofCase {
  std::string name;    // of the folder
  std::string effect;  // the catalogue's; empty: nothing is concealed
  std::string joint;   // of an effect at a joint
  std::vector<std::pair<std::string, double>> values;  // of its parameters, SI
  std::string kind;                                    // "sinkage", "traction"
  std::vector<std::string> settings;                   // "key=value", as of --set
  bool quick = false;                                  // one of the short form
  std::string why;                                     // how it is hidden

  /// As --effects takes it; "" where nothing is concealed.
  std::string toml() const;
};

/// The six, and two sessions of plants that lack nothing.
const std::vector<FootProofCase>& foot_proof_cases();

struct FootProof {
  FootProofCase asked;
  Verdict verdict;
  std::string channel;  // that the nominal model misses most, in units of its noise
  /// Of what the nominal model leaves in the channels that it misses, the mean share that is left;
  /// not a number where there is none.
  double with_effect = 0, with_rival = 0, taken_away = 0;
  std::string rival;  // the single effect that does best beside the one that was named
  /// The same for a second run with improved.toml against the recording, over a run without.
  double second_run = 0;
  double answer_s = 0;  // by the clock

  /// The verdict names just what was concealed, at its joint.
  bool right() const;
};

struct FootProofOptions {
  std::filesystem::path out = "runs/study-foot-proof";
  bool full = false;
  std::vector<std::string> only;  // names of cases; empty: the short form, or all with `full`
  int threads = 2;
  bool force = false;
  bool quiet = false;
};

/// Channels that the nominal model misses by more than their noise, and what another model leaves
/// of that in the mean. Not a number where it misses none.
double mean_share(const Errors& before, const Errors& after, const Errors& noise);

/// Writes the case's folders: session, answer, and the two runs again.
/// @param progress as of DiagnoseOptions
FootProof prove(const FootProofCase& asked, const FootProofOptions& options,
                const std::function<bool(double, const std::string&)>& progress);

/// All cases that are asked for: a table, proof.csv and proof.json.
/// @throws BarMissed where an answer is not right
void run_foot_proof_study(const FootProofOptions& options);

}  // namespace hoof::tools
