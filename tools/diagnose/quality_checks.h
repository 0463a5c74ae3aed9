// The single checks of check_quality.
#pragma once

#include <string>
#include <vector>

#include "tools/diagnose/data_set.h"
#include "tools/diagnose/verdict.h"

namespace hoof::tools {

struct QualityFinding {
  std::string kind;  // findings of one kind and channel are one note
  QualityNote note;
  double weight = 0;  // the largest is worst
};

/// One recording, and the list that its findings go to.
struct QualityCase {
  const DataSet& set;
  const Recording& recording;
  std::vector<QualityFinding>& findings;

  void say(const std::string& kind, const std::string& channel, double weight, bool serious,
           const std::string& text) const;

  /// 1-sigma noise of a channel as stated, or else as its samples scatter.
  double noise(const std::string& channel) const;
  /// Changes by more than its noise makes it.
  bool moves(const std::string& channel) const;
  std::string unit(const std::string& channel) const;
};

/// "0.0153 rad".
std::string quality_number(double value, const std::string& unit = "");

void check_time(const QualityCase& c);      // gaps, rate, clock
void check_samples(const QualityCase& c);   // missing, dead, frozen, saturated, coarse, noisy
void check_velocity(const QualityCase& c);  // against the derivative of position
void check_units(const QualityCase& c);     // against the setup and other channels
void check_motion(const QualityCase& c);    // length, excitation
void check_duplicates(const DataSet& set, std::vector<QualityFinding>& findings);

}  // namespace hoof::tools
