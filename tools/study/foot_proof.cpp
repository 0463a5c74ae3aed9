#include "tools/study/foot_proof.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "tools/diagnose/data_set.h"
#include "tools/diagnose/diagnose.h"
#include "tools/diagnose/foot_session.h"
#include "tools/diagnose/write_answer.h"
#include "tools/experiment/run_experiment.h"
#include "tools/run/output_file.h"

namespace hoof::tools {
namespace {

namespace fs = std::filesystem;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr char kSession[] = "session", kAnswer[] = "answer", kTruth[] = "truth.toml";

/// A run over the bus, in lock step. @param effects a file, "" for none  @param truth "" not to
/// conceal them
void record(const FootProofCase& asked, const fs::path& out, const fs::path& effects,
            const fs::path& truth) {
  std::vector<std::string> settings = asked.settings;
  settings.push_back("experiment.terrain=rft");
  RunOutput output;
  output.out = out;
  output.force = output.quiet = output.silent = true;
  output.truth = truth;
  run_experiment(read_run_settings(asked.kind, settings, "", effects.string()), output);
}

std::vector<DataSet> data_set_of(const FootProofCase& asked, const fs::path& folder) {
  const fs::path file = folder / "dataset.toml";
  write_file(file, "format = 1\nname = \"" + asked.name + "\"\nrig = \"foot_hil\"\n\n" +
                       "[[recording]]\nsession = \"" + kSession + "\"\nrole = \"fit\"\n");
  return {read_data_set(file)};
}

/// By channel, root mean square of the difference of two sessions, as far as both go.
Errors differences(const FootSignals& one, const FootSignals& other) {
  Errors errors;
  for (const std::string& name : FootSignals::channel_names()) {
    const auto& a = one.channel(name);
    const auto& b = other.channel(name);
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
      if (!std::isfinite(a[i] - b[i])) continue;
      sum += (a[i] - b[i]) * (a[i] - b[i]);
      count += 1;
    }
    if (count > 0) errors[name + "_rmse"] = std::sqrt(sum / count);
  }
  return errors;
}

double second_run(const FootProofCase& asked, const fs::path& folder, const Errors& noise) {
  record(asked, folder / "without", "", "");
  record(asked, folder / "improved", folder / kAnswer / "improved.toml", "");
  const FootSignals recorded = read_foot_session(folder / kSession).signals;
  const auto against = [&](const char* name) {
    return differences(recorded, read_foot_session(folder / name).signals);
  };
  return mean_share(against("without"), against("improved"), noise);
}

/// Rows of the ablation: the winner, its rivals alone, the winner taken away again.
void take_ablation(FootProof& proof) {
  const Verdict& v = proof.verdict;
  const auto share = [&v](const Errors& after) {
    return mean_share(v.before.fit, after, v.noise_floor);
  };
  proof.with_effect = share(v.after.fit);
  proof.with_rival = proof.taken_away = kNone;
  std::string winner = "nominal";
  for (std::size_t i = 0; i < v.named.size(); ++i) winner += (i > 0 ? "+" : " + ") + v.named[i];
  const std::string alone = "nominal + ";
  for (const AblationRow& row : v.ablation) {
    const double left = share(row.fit);
    if (row.model.ends_with("taken away")) {
      if (!(proof.taken_away < left)) proof.taken_away = left;
    } else if (row.model.starts_with(alone) && row.model != winner && !(left >= proof.with_rival)) {
      proof.with_rival = left;
      proof.rival = row.model.substr(alone.size());
    }
  }
}

/// In units of its noise.
std::string most_missed(const Verdict& verdict) {
  std::string most;
  double top = 1;
  for (const auto& [name, before] : verdict.before.fit) {
    const double ratio = before / verdict.noise_floor.at(name);
    if (ratio > top) top = ratio, most = name.substr(0, name.size() - std::string("_rmse").size());
  }
  return most;
}

}  // namespace

double mean_share(const Errors& before, const Errors& after, const Errors& noise) {
  double sum = 0, count = 0;
  for (const auto& [name, was] : before) {
    const auto floor = noise.find(name);
    const auto is = after.find(name);
    if (floor == noise.end() || is == after.end() || !(was > 2 * floor->second)) continue;
    sum += is->second / was;
    count += 1;
  }
  return count > 0 ? sum / count : kNone;
}

bool FootProof::right() const {
  if (asked.effect.empty()) return verdict.verdict == "none";
  return verdict.verdict == "missing_physics" && verdict.named.size() == 1 &&
         verdict.named[0] == asked.effect && !verdict.effects.empty() &&
         verdict.effects[0].name == asked.effect && verdict.effects[0].joint == asked.joint;
}

FootProof prove(const FootProofCase& asked, const FootProofOptions& options,
                const std::function<bool(double, const std::string&)>& progress) {
  const fs::path folder = options.out / asked.name;
  fs::create_directories(folder);
  fs::path hidden, truth;
  if (!asked.effect.empty()) {
    hidden = folder / "hidden.toml";
    truth = folder / kTruth;
    write_file(hidden, asked.toml());
  }
  record(asked, folder / kSession, hidden, truth);

  FootProof proof;
  proof.asked = asked;
  const std::vector<DataSet> sets = data_set_of(asked, folder);
  AnswerFolder answer(folder / kAnswer, kVerdictFile, true);
  DiagnoseOptions diagnose_options;
  diagnose_options.threads = options.threads;
  diagnose_options.progress = progress;
  const auto start = std::chrono::steady_clock::now();
  proof.verdict = diagnose(sets, diagnose_options);
  if (proof.verdict.verdict.empty()) return proof;  // stopped
  proof.answer_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  write_answer(proof.verdict, sets, answer);
  proof.channel = most_missed(proof.verdict);
  take_ablation(proof);
  proof.second_run = second_run(asked, folder, proof.verdict.noise_floor);
  return proof;
}

}  // namespace hoof::tools
