// The tables beside verdict.json, as CSV text. Not finite is "nan", "inf" or "-inf".
#pragma once

#include <string>
#include <vector>

#include "tools/diagnose/rig_model.h"
#include "tools/diagnose/verdict.h"

namespace hoof::tools {

/// A cell in quotes where it needs them.
std::string csv_cell(const std::string& text);

/// recording,role,channel,time,measured,before,after,residual_before,residual_after: a row per
/// sample, SI; residual = measured - predicted.
std::string residuals_csv(const std::vector<ChannelTrace>& traces);

/// name,parameters_count,log_likelihood,samples_count,evidence,holdout_gain,probability
std::string hypotheses_csv(const std::vector<HypothesisScore>& hypotheses);

/// time, each channel as predicted, and as measured under <channel>_measured.
std::string prediction_csv(const Recording& recording, const std::vector<std::string>& channels,
                           const Prediction& prediction);

}  // namespace hoof::tools
