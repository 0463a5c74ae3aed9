// What the paper states of sinkage and traction: Ji, Han, Xie, Han, Wang, Zhang: Actuators 2026,
// 15(6), 330. Numbers, no figures: openings of 20 degrees and loads between those here are drawn in
// it and not said.
#pragma once

#include <string>
#include <vector>

namespace hoof::tools {

/// Of its bed of sand: length, width, height of the filling; grains in it, 4 times real size.
inline constexpr double kPaperBox_m[3] = {0.530, 0.420, 0.120};
inline constexpr double kPaperBedGrains = 933059;

struct PaperSinkage {
  std::string condition;  // as of Cell
  double sinkage_mm = 0;  // largest vertical displacement of the sole after contact
  bool in_words = true;   // else from a percentage that it states
};
const std::vector<PaperSinkage>& paper_sinkages();
/// NaN where the paper states none.
double paper_sinkage_mm(const std::string& condition);

struct PaperTraction {
  std::string condition;
  double fx_peak_N = 0;        // 0: not stated
  double fz_at_fx_peak_N = 0;  // at that instant; the largest Fz is never given
  double coefficient = 0;      // the one over the other
};
const std::vector<PaperTraction>& paper_tractions();
/// All zero where the paper states none.
PaperTraction paper_traction(const std::string& condition);

}  // namespace hoof::tools
