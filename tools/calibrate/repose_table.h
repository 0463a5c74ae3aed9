// Table 2 of the source paper by heaps of ours: a row for each combination, how the two lists go
// together, and every heap as a run of the design that a response surface is fitted to.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/calibrate/findings.h"
#include "tools/calibrate/heap_runner.h"
#include "tools/calibrate/paper_tables.h"

namespace hoof::tools {

/// The 13 combinations of table 2 in its order, its repeats once with their mean angle.
std::vector<ReposeRow> repose_combinations();

/// Angle of the ring fit of `n` results; those that tell none are left out.
std::vector<double> told_angles_deg(const std::vector<HeapResult>& results, std::size_t first,
                                    std::size_t n);

/// "blocked 3; layer of 0 degrees 1", "" where all of them are heaps that tell an angle.
std::string untold_text(const std::vector<HeapResult>& results, std::size_t first, std::size_t n);

/// 95 % of what a rank correlation becomes when rows are drawn again with replacement, and of each
/// row its heaps: 2000 draws (Efron: Annals of Statistics 7 (1979) 1, percentiles). Always the same
/// draws. NaN with fewer than three rows.
struct CorrelationBand {
  double low = 0, high = 0;
};
using Correlation = double (*)(const std::vector<double>&, const std::vector<double>&);
CorrelationBand correlation_band(const std::vector<double>& paper,
                                 const std::vector<std::vector<double>>& ours, Correlation of);

/// Puts rows, targets, plot and design of table 2 into the findings. A row of which no heap told an
/// angle has no value and no part in rms and correlations.
/// @param results of `seeds` heaps of each of repose_combinations(), from `first` on
/// @param test that made them, for the design's columns
void add_repose_table(Findings& findings, const std::vector<HeapResult>& results, std::size_t first,
                      std::size_t seeds, const HeapTest& test);

/// The response surface of runs with the columns e_ratio, mu_r_ratio, mu_s_ratio and repose_deg,
/// and what of it gives the paper's measured angle, as `hoof anova` tells it.
/// @param out folder for its files  @throws UserError where the runs are too few for a quadratic
std::string analyse_repose(const std::filesystem::path& data, const std::filesystem::path& out);

}  // namespace hoof::tools
