// hoof claims: which of the paper's claims hold, whatever it leaves open.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/reproduce/campaign.h"
#include "tools/reproduce/claim.h"
#include "tools/reproduce/ground.h"
#include "tools/reproduce/variation.h"

namespace hoof::tools {

struct ClaimsOptions {
  std::vector<std::string> names;       // of claims; empty: all
  std::vector<std::string> variations;  // by name; empty: all
  Ground ground;
  int beds = 5;
  int first_bed = 1;
  Engine engine;
  std::vector<std::string> settings;  // "dotted.key=value" for every run
  std::filesystem::path out;          // empty: that of the ground
  bool plan_only = false;
  bool no_runs = false;  // judges by what is there
  bool quiet = false;
};

/// What one variation, or the base, says of a claim.
struct ClaimUnder {
  std::string variation;  // "base" or its name
  std::string kind;       // "reading": the base's runs read otherwise, no part of the verdict
  Finding finding = Finding::kNotRun;
  std::vector<std::optional<Evidence>> evidence;  // by contrast
  std::vector<std::vector<std::string>> runs;     // by contrast: their ids
};

struct JudgedClaim {
  const Claim* claim = nullptr;
  Verdict verdict = Verdict::kOpen;
  std::vector<ClaimUnder> under;  // the base first, a reading last
};

/// Makes the runs that are missing in the folder of the campaign, which base runs are shared with,
/// and judges by all that are there: claims.json, claims.csv, claims.html.
/// @throws UserError, Interrupted, CannotFinish as reproduce()
void judge_claims(const ClaimsOptions& options);

/// Prints claims and variations, a line each.
void list_claims();

}  // namespace hoof::tools
