// From a sieve table to a settled, level bed.
//
// Recipe: grains without overlaps are placed at random in a column (bed_rain.h); they fall, with
// the friction set for packing; a stiff medium calms them, with all friction from here on; a
// scraper takes what stands above z = 0; the rest relaxes from its load, first in a thin medium,
// then free; what has risen is scraped off again.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "sim/terrain/bed_grading.h"
#include "sim/terrain/bed_rain.h"

namespace hoof::sim {

/// Called now and then with the share of the work done; returns false to stop.
using BedProgress = std::function<bool(double)>;

/// Height above the floor from which the rain falls, m.
double rain_column_m(const BedSettings& bed);

/// A bed on its way from nothing to level, worked on in pieces.
class BedMaking {
 public:
  /// @throws std::invalid_argument for settings that cannot be, also together
  BedMaking(const BedSettings& bed, const Materials& materials, std::uint64_t seed, int threads);

  /// Does a piece of the work: some thousand grains placed, or some hundred steps.
  /// @return false once the bed is made
  /// @throws std::runtime_error where grains find no room, blow up, or do not come to rest
  bool advance();

  /// Share of the work done: a guess, as nobody knows when grains come to rest. Never falls.
  double share_done() const { return share_done_; }

  /// Bytes from which restore() goes on to the same bed, bit by bit, some 300 a grain. Empty while
  /// grains are placed, which takes less time than writing them.
  std::string snapshot() const;

  /// Goes on from a snapshot of a making with the same settings, materials and seed.
  /// @throws std::runtime_error where the bytes are none
  void restore(std::string_view snapshot);

  /// What is being done, for people: "placing grains", ...
  std::string_view stage_name() const;

  std::uint64_t steps() const { return steps_; }

  /// The bed; once advance() has returned false.
  const BedState& bed() const { return state_; }

 private:
  enum class Stage { kPlace, kFall, kCalm, kLevel, kFree, kMade };

  struct Rule;
  static const Rule& rule(Stage stage);

  void begin(Stage stage);
  void begin_fall();
  void begin_level();
  void make_sand(Stage stage);
  void settle();
  double stage_share() const;

  BedSettings settings_;
  DemSettings dem_;  // with all friction
  double fall_s_;    // free fall of the topmost grain
  Rain rain_;

  Stage stage_ = Stage::kPlace;
  double stage_time_s_ = 0;
  double highest_ratio_ = 0;  // of the stage
  double energy_ratio_ = 0;   // mean kinetic energy of a grain over what lifts it by its diameter
  int quiet_pieces_ = 0;      // one after the other below the stage's limit
  double share_done_ = 0;
  std::uint64_t steps_ = 0;
  double lift_energy_J_ = 0;  // lifts each of the grains there are by its own diameter
  BedState state_;
  std::unique_ptr<SandBed> sand_;
};

/// Pours, settles, scrapes level and lets come to rest.
/// @throws std::runtime_error "stopped" when progress says so; as BedMaking otherwise
BedState make_bed(const BedSettings& bed, const Materials& materials, std::uint64_t seed,
                  int threads, const BedProgress& progress);

}  // namespace hoof::sim
