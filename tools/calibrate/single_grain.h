// hoof calibrate restitution, rolling, sliding: one grain and one plate, against the source paper's
// tables 3 to 5.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "tools/calibrate/drop_lab.h"
#include "tools/calibrate/findings.h"
#include "tools/calibrate/paper_tables.h"
#include "tools/calibrate/roll_lab.h"
#include "tools/calibrate/tilt_lab.h"

namespace hoof::tools {

/// Told what is being done, with the share of the work that is done; false to stop.
using LabProgress = std::function<bool(double share, const std::string& doing)>;

/// The labs' way of saying that progress told them to stop.
class LabStopped : public std::exception {};

/// What the single-grain laboratories share: many grains for the check of one coefficient.
struct CheckSettings {
  int grains = kPaperGrains;
  double spread_m = 1e-3;  // of the places of release
  double bin_m = 4e-3;     // of the paper's weighted mean
  std::uint64_t seed = 1;
};

struct RestitutionSettings {
  DropTest test;  // of one grain; the check has its own grains
  CheckSettings check;
};
struct RollingSettings {
  RollTest test;
  CheckSettings check;
};
struct SlidingSettings {
  TiltTest test;
  int grains = kPaperGrains;
};

/// L over e without and with friction against table 3, and what e the measured L means.
/// @throws std::invalid_argument for settings that cannot be, LabStopped
Findings find_restitution(const sim::Materials& materials, const RestitutionSettings& settings,
                          const LabProgress& progress);
/// S2 over mu_r against table 5, and what mu_r the measured S2 means.
Findings find_rolling(const sim::Materials& materials, const RollingSettings& settings,
                      const LabProgress& progress);
/// Tilt at slip over mu_s against table 4, and what mu_s the measured tilt means.
Findings find_sliding(const sim::Materials& materials, const SlidingSettings& settings,
                      const LabProgress& progress);

}  // namespace hoof::tools
