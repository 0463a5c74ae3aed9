// One run of the paper's campaign, and the plans that such runs make.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace hoof::tools {

/// A sinkage or a traction run on one bed.
struct Cell {
  bool traction = false;
  std::string foot;                  // as of --foot
  int toe_deg = 0;                   // per side; 0 of a foot without toes
  double load_kg = 0;                // of a sinkage
  double speed_m_s = 0;              // of a sinkage, at first contact
  double frequency_Hz = 0;           // of a traction
  int bed = 1;                       // the seed of its preparation
  std::string variation;             // what was changed beside, in a word; empty: nothing
  std::vector<std::string> changes;  // "dotted.key=value" of that

  std::string kind() const { return traction ? "traction" : "sinkage"; }
  /// All but the bed, in a word that names a folder: "sinkage-bionic-toe30-10kg-0.1m_s".
  std::string condition() const;
  /// "sinkage-bionic-toe30-10kg-0.1m_s-bed1", "sinkage-bionic-toe30-10kg-0.1m_s-long-spines-bed1"
  std::string id() const {
    return condition() + (variation.empty() ? "" : "-" + variation) + "-bed" + std::to_string(bed);
  }
  /// "dotted.key=value", what the run is beside the defaults of its experiment.
  std::vector<std::string> overrides() const;
};

/// What all runs of a campaign share, "dotted.key=value". Of two of a key the last counts.
struct CampaignSettings {
  std::vector<std::string> of_all;
  std::vector<std::string> of_sinkage, of_traction;
  std::vector<std::string> asked;  // by the user, of all

  std::vector<std::string> of(const std::string& kind) const;
  /// The ground of a kind: without what is asked of an experiment, as the other may not know it.
  std::vector<std::string> ground_of(const std::string& kind) const;
  /// With what the cell is: its own counts last, as its name says it.
  std::vector<std::string> of(const Cell& cell) const;
};

/// The cell of such a condition(). @throws std::invalid_argument where it is none
Cell cell_of(const std::string& condition);

/// What of the paper is reproduced.
enum class Part {
  kLoad,            // sinkage of the three feet against load, at both speeds
  kOpening,         // sinkage of the spined foot against the opening, light and heavy
  kTraction,        // the three feet at both step frequencies
  kTractionOpening  // the spined foot against the opening, at both
};

/// By the names of the command line: load, opening, traction, traction-opening.
const std::vector<std::pair<std::string, Part>>& part_names();

enum class Design {
  kNight,   // what bands are of, in a night of two cores with the grains of `bench`
  kStated,  // the conditions that the paper states numbers of
  kFull     // every load from 10 to 60 kg and every opening from 0 to 40 degrees, at all loads
};

/// By the names of the command line: night, stated, full.
const std::vector<std::pair<std::string, Design>>& design_names();

/// All cells, each once, bed after bed: whenever a campaign stops, the beds that are through are
/// complete pairs.
/// @param beds how many  @param first_bed the seed of the first, the others count on
std::vector<Cell> plan_cells(const std::set<Part>& parts, Design design, int beds, int first_bed);

}  // namespace hoof::tools
