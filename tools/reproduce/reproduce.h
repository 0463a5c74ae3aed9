// hoof reproduce: the paper's sinkage and traction, run by run, and its tables; its numbers beside
// ours.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tools/reproduce/campaign.h"
#include "tools/reproduce/cell.h"
#include "tools/reproduce/ground.h"

namespace hoof::tools {

struct ReproduceOptions {
  std::set<Part> parts;
  std::vector<std::string> tables;   // "table2"
  std::vector<std::string> figures;  // "fig5": by their numbers
  std::optional<Design> asked;       // nothing: what the ground says
  Ground ground;
  int beds = 5;
  int first_bed = 1;
  std::vector<std::string> variations;  // that the runs are made under too
  int variation_beds = 2;
  Engine engine;
  std::vector<std::string> settings;  // "dotted.key=value" for every run
  std::filesystem::path out;          // empty: that of the ground
  /// Of a campaign whose changes tell of what this one misses; empty: none.
  std::filesystem::path reasons_from;
  bool plan_only = false;  // says what is there and what is missing, runs nothing
  bool quiet = false;

  std::filesystem::path folder() const { return out.empty() ? ground.folder() : out; }
  Design design() const { return asked.value_or(ground.design()); }
};

std::string design_name(Design design);

/// Runs what is missing; writes summary.csv, summary.json, figures/ and report.html after each run,
/// so that a campaign under way can be looked at; prints the table of targets.
/// @throws UserError, Interrupted; CannotFinish where runs failed, named, once the rest is done
void reproduce(const ReproduceOptions& options);

}  // namespace hoof::tools
