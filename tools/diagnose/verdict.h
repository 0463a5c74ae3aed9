// What hoof diagnose answers: the fields of verdict.json, and what the report shows beside them.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/diagnose/planned_experiment.h"

namespace hoof::tools {

struct ParameterEstimate {
  std::string name;
  double value = 0;
  std::string unit;
  double low95 = 0, high95 = 0;
};

struct EffectFinding {
  std::string name;
  double probability = 0;  // marginal: alone or in a pair
  std::vector<ParameterEstimate> parameters;
  std::string joint = {};  // of the foot's effects at a joint: toe, hip, knee; else empty
};

struct Interval {
  std::string recording;
  double start_s = 0, end_s = 0;
};

/// By key "<channel>_rmse", SI.
using Errors = std::map<std::string, double>;

struct RoleErrors {
  Errors fit, holdout;
};

struct AblationRow {
  std::string model;  // "nominal + cogging_torque"
  Errors fit, holdout;
};

struct UnknownTerm {
  std::vector<std::string> inputs;
  std::string form;
  double residual_share = 0;  // of the residual's power
  Errors holdout;
};

/// One hypothesis as it was judged, for the report and for graders of selection rules.
struct HypothesisScore {
  std::string name;           // "none", "a", "a+b"; stand-ins in parentheses
  int parameters_count = 0;   // doubtful setup and effects
  double log_likelihood = 0;  // of the fit recordings, samples counted as if independent
  double samples_count = 0;
  double evidence = 0;      // what the probabilities are made of: relative to "none"
  double holdout_gain = 0;  // log predictive density on held-out data, relative to "none"
  double probability = 0;
};

/// Data quality: what was seen, and what it means for the answer.
struct QualityNote {
  std::string recording;  // empty: of the whole data set
  std::string channel;    // may be empty
  std::string text;
  bool serious = false;  // changes what the answer is worth
};

/// What a report draws of one recording: measured against predicted, before and after.
struct ChannelTrace {
  std::string recording;
  std::string channel;
  bool holdout = false;
  std::vector<double> time_s, measured, before, after;
};

struct SetupEstimate {  // of a doubtful setup value, in the nominal model and in the winner
  std::string name;
  double stated = 0, sigma = 0, before = 0, after = 0;
  bool guessed = false;  // no one stated it: stated and sigma are what can be guessed beforehand
};

struct Verdict {
  std::string verdict;  // "none", "missing_physics", "unknown_physics", "not_separable"
  std::map<std::string, double> probabilities;  // none, unknown and every effect; sums to one
  std::vector<EffectFinding> effects;           // most probable first
  std::vector<std::vector<std::string>> not_separable;
  std::string next_experiment;
  std::vector<std::string> channels;
  std::vector<std::string> recordings;
  std::vector<Interval> intervals;
  std::string condition;
  RoleErrors before, after;
  Errors noise_floor;
  std::vector<AblationRow> ablation;
  std::optional<UnknownTerm> unknown_term;

  // Beyond verdict.json's required keys.
  std::optional<PlannedExperiment>
      planned_experiment;          // what next_experiment says, where simulated
  std::vector<std::string> named;  // effects of the winning model, none for "none"
  std::vector<SetupEstimate> setup;
  std::vector<QualityNote> quality;
  std::vector<HypothesisScore> hypotheses;  // best first
  std::vector<ChannelTrace> traces;
  std::vector<std::string> evidence_for, evidence_against;  // sentences
};

}  // namespace hoof::tools
