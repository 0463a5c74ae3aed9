// The search for rigs whose rollout takes a good part of a second, such as the foot with its real
// control code: a few hundred rollouts in place of many thousands.
#pragma once

#include "tools/diagnose/search.h"

namespace hoof::tools {

struct CostlyOptions {
  int threads = 1;
  std::function<bool(double, const std::string&)> progress;
  int rough = 8;        // effects that are fitted roughly, those that a first look promises most of
  int followed = 3;     // of which are fitted to the end
  int scanned = 2;      // effects with a threshold that are scanned for it
  int pair_bases = 2;   // single effects that others are tried beside
  int rough_pairs = 5;  // pairs that are fitted roughly
  int followed_pairs = 2;
  int polish_steps = 60;  // of a search without slopes, after the fits to the end
};

/// As search(), in stages that each keep fewer hypotheses than the one before. Effects at a joint
/// whose drive tells nothing that the nominal model does not are not tried. Thresholds are scanned
/// for, and pairs tried, only where no single effect explains what is there to explain.
SearchResult costly_search(Fitter& fitter, const CostlyOptions& options);

}  // namespace hoof::tools
