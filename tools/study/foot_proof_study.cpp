#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "tools/run/errors.h"
#include "tools/run/progress_line.h"
#include "tools/run/result_json.h"
#include "tools/run/stop_request.h"
#include "tools/study/foot_proof.h"
#include "tools/study/table.h"

namespace hoof::tools {
namespace {

namespace fs = std::filesystem;

std::string joined(const std::vector<std::string>& names, const std::string& between) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : between) + name;
  return text;
}

std::vector<FootProofCase> chosen(const FootProofOptions& options) {
  std::vector<FootProofCase> some;
  std::vector<std::string> known;
  for (const FootProofCase& c : foot_proof_cases()) {
    known.push_back(c.name);
    const bool named =
        std::find(options.only.begin(), options.only.end(), c.name) != options.only.end();
    if (options.only.empty() ? options.full || c.quick : named) some.push_back(c);
  }
  for (const std::string& name : options.only) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      throw UserError("--only " + name + ": no such case; there are " + joined(known, ", "));
    }
  }
  return some;
}

std::string at_joint(const std::string& effect, const std::string& joint) {
  return joint.empty() ? effect : effect + " (" + joint + ")";
}

std::string found_text(const FootProof& proof) {
  if (proof.verdict.verdict == "none") return "none";
  if (proof.verdict.verdict == "unknown_physics") return "unknown physics";
  std::vector<std::string> names;
  for (const std::string& name : proof.verdict.named) {
    const auto& effects = proof.verdict.effects;
    const auto found = std::find_if(effects.begin(), effects.end(),
                                    [&name](const EffectFinding& e) { return e.name == name; });
    names.push_back(at_joint(name, found == effects.end() ? "" : found->joint));
  }
  return joined(names, " + ") + (proof.verdict.verdict == "not_separable" ? ", not separable" : "");
}

double probability(const FootProof& proof) {
  const auto& p = proof.verdict.probabilities;
  const auto found = p.find(proof.asked.effect.empty() ? "none" : proof.asked.effect);
  return found == p.end() ? 0 : found->second;
}

/// Of the effect that was concealed; null where it has no finding.
const EffectFinding* finding(const FootProof& proof) {
  for (const EffectFinding& effect : proof.verdict.effects) {
    if (effect.name == proof.asked.effect) return &effect;
  }
  return nullptr;
}

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

/// "gap 0.012 [0.0119, 0.0121] of 0.012 rad"
std::string values_text(const FootProof& proof) {
  const EffectFinding* found = finding(proof);
  if (found == nullptr) return "-";
  std::vector<std::string> texts;
  for (const auto& [name, truth] : proof.asked.values) {
    for (const ParameterEstimate& p : found->parameters) {
      if (p.name != name) continue;
      texts.push_back(name + " " + short_number(p.value) + " [" + short_number(p.low95) + ", " +
                      short_number(p.high95) + "] of " + short_number(truth) +
                      (p.unit == "1" ? "" : " " + p.unit));
    }
  }
  return joined(texts, "; ");
}

Table proof_table(const std::vector<FootProof>& proofs) {
  Table table({{"case_name", 0},
               {"concealed_name", 0},
               {"found_name", 0},
               {"probability_ratio", 2},
               {"most_missed_name", 0},
               {"left_with_effect_ratio", 3},
               {"left_with_best_rival_ratio", 3},
               {"rival_name", 0},
               {"left_taken_away_ratio", 3},
               {"left_in_second_run_ratio", 3}});
  for (const FootProof& p : proofs) {
    table.row({p.asked.name,
               p.asked.effect.empty() ? "nothing" : at_joint(p.asked.effect, p.asked.joint),
               found_text(p), probability(p), p.channel.empty() ? "none" : p.channel, p.with_effect,
               p.with_rival, p.rival.empty() ? "-" : p.rival, p.taken_away, p.second_run});
  }
  return table;
}

/// What is not finite is left out.
void put(nlohmann::ordered_json& json, const char* key, double value) {
  if (std::isfinite(value)) json[key] = value;
}

nlohmann::ordered_json proof_json(const FootProof& proof) {
  nlohmann::ordered_json json = {{"case", proof.asked.name},     {"concealed", proof.asked.effect},
                                 {"joint", proof.asked.joint},   {"verdict", proof.verdict.verdict},
                                 {"named", proof.verdict.named}, {"right", proof.right()}};
  json["probability"] = probability(proof);
  json["values"] = nlohmann::ordered_json::object();
  if (const EffectFinding* found = finding(proof)) {
    for (const ParameterEstimate& p : found->parameters) {
      nlohmann::ordered_json value;
      put(value, "found", p.value);
      put(value, "low95", p.low95);
      put(value, "high95", p.high95);
      for (const auto& [name, truth] : proof.asked.values) {
        if (name == p.name) value["concealed"] = truth;
      }
      json["values"][p.name] = value;
    }
  }
  nlohmann::ordered_json left;
  put(left, "with_effect", proof.with_effect);
  put(left, "with_best_rival", proof.with_rival);
  put(left, "taken_away", proof.taken_away);
  put(left, "second_run", proof.second_run);
  json["left_ratio"] = left.is_null() ? nlohmann::ordered_json::object() : left;
  json["rival"] = proof.rival;
  nlohmann::ordered_json before;
  for (const auto& [name, value] : proof.verdict.before.fit) put(before, name.c_str(), value);
  json["before"] = before;
  nlohmann::ordered_json after;
  for (const auto& [name, value] : proof.verdict.after.fit) put(after, name.c_str(), value);
  json["after"] = after;
  return json;
}

FootProof prove_with_progress(const FootProofCase& asked, const FootProofOptions& options) {
  ProgressLine line(asked.name, choose_progress_style(options.quiet), std::cerr);
  // Runs watch for Ctrl-C themselves; only one may at a time.
  std::optional<StopRequest> stop;
  int status = 0;
  const FootProof proof = prove(asked, options, [&](double share, const std::string& doing) {
    if (!stop) stop.emplace();
    line.update(share, doing);
    const bool go_on = !stop->requested();
    if (!go_on) status = stop->exit_status();
    if (!go_on || share >= 1) stop.reset();
    return go_on;
  });
  line.finish();
  if (status != 0) throw Interrupted("stopped; no table was written", status);
  return proof;
}

}  // namespace

void run_foot_proof_study(const FootProofOptions& options) {
  const std::vector<FootProofCase> cases = chosen(options);
  if (fs::exists(options.out / "proof.json") && !options.force) {
    throw UserError("--out " + options.out.string() +
                    ": holds a proof already; --force replaces it");
  }
  std::error_code error;
  fs::create_directories(options.out, error);
  if (error) {
    throw UserError("--out " + options.out.string() + ": cannot be made: " + error.message());
  }
  std::vector<FootProof> proofs;
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  std::vector<std::string> wrong;
  for (const FootProofCase& asked : cases) {
    proofs.push_back(prove_with_progress(asked, options));
    const FootProof& proof = proofs.back();
    all.push_back(proof_json(proof));
    if (!proof.right()) wrong.push_back(asked.name);
    std::printf("%-14s %s in %.0f s; %s\n", asked.name.c_str(),
                proof.right() ? "found" : "NOT FOUND", proof.answer_s,
                asked.effect.empty() ? "nothing to find" : values_text(proof).c_str());
    std::fflush(stdout);
  }
  const Table table = proof_table(proofs);
  table.write_csv(options.out / "proof.csv");
  write_result_json(options.out / "proof.json", {{"format", 1}, {"cases", all}});
  std::cout
      << "\nLeft: the mean share of what the refitted nominal model leaves, over the channels "
         "that it misses\nby more than twice their noise; of the second run, of what a run "
         "without improved.toml is off.\n\n"
      << table.markdown() << "\n"
      << (options.out / "proof.json").string() << std::endl;
  if (!wrong.empty()) throw BarMissed("not found as concealed: " + joined(wrong, ", "));
}

}  // namespace hoof::tools
