#include "tools/reproduce/cell.h"

#include <algorithm>

#include "tools/run/csv_writer.h"

namespace hoof::tools {
namespace {

constexpr const char* kSpined = "bionic";
constexpr const char* kPlain = "bionic-plain";
constexpr const char* kTraditional = "traditional";
constexpr double kSlow_m_s = 0.1, kFast_m_s = 0.4;
constexpr double kSlow_Hz = 0.45, kFast_Hz = 1.12;
constexpr double kLight_kg = 10, kMiddle_kg = 40, kHeavy_kg = 60;
const std::vector<int> kOpenings_deg = {0, 10, 20, 30, 40};

Cell sinkage(const std::string& foot, int toe_deg, double load_kg, double speed_m_s) {
  Cell cell;
  cell.foot = foot, cell.toe_deg = toe_deg, cell.load_kg = load_kg, cell.speed_m_s = speed_m_s;
  return cell;
}

Cell traction(const std::string& foot, int toe_deg, double frequency_Hz) {
  Cell cell;
  cell.traction = true;
  cell.foot = foot, cell.toe_deg = toe_deg, cell.frequency_Hz = frequency_Hz;
  return cell;
}

std::vector<Cell> conditions(Part part, Design design) {
  const bool full = design == Design::kFull;
  const std::vector<double> all_kg = {10, 20, 30, 40, 50, 60};
  std::vector<Cell> cells;
  switch (part) {
    case Part::kLoad:
      for (const char* foot : {kSpined, kPlain, kTraditional}) {
        for (const double load_kg : full ? all_kg : std::vector<double>{kLight_kg, kMiddle_kg}) {
          for (const double speed : {kSlow_m_s, kFast_m_s}) {
            cells.push_back(sinkage(foot, 0, load_kg, speed));
          }
        }
      }
      break;
    case Part::kOpening:
      for (const int toe : kOpenings_deg) {
        for (const double load_kg : full ? all_kg : std::vector<double>{kLight_kg, kHeavy_kg}) {
          for (const double speed : {kSlow_m_s, kFast_m_s}) {
            cells.push_back(sinkage(kSpined, toe, load_kg, speed));
          }
        }
      }
      break;
    case Part::kTraction:
      for (const char* foot : {kSpined, kPlain, kTraditional}) {
        for (const double frequency : {kSlow_Hz, kFast_Hz}) {
          cells.push_back(traction(foot, 0, frequency));
        }
      }
      break;
    case Part::kTractionOpening:
      for (const int toe : kOpenings_deg) {
        for (const double frequency : {kSlow_Hz, kFast_Hz}) {
          cells.push_back(traction(kSpined, toe, frequency));
        }
      }
      break;
  }
  return cells;
}

}  // namespace

std::string Cell::condition() const {
  std::string name = kind() + "-" + foot;
  if (foot != kTraditional) name += "-toe" + std::to_string(toe_deg);
  if (traction) return name + "-" + format_number(frequency_Hz) + "Hz";
  return name + "-" + format_number(load_kg) + "kg-" + format_number(speed_m_s) + "m_s";
}

std::vector<std::string> Cell::overrides() const {
  std::vector<std::string> settings = {"use.foot=" + foot, "experiment.seed=" + std::to_string(bed),
                                       "experiment.toe_deg=" + std::to_string(toe_deg)};
  if (traction) {
    settings.push_back("experiment.frequency_Hz=" + format_number(frequency_Hz));
  } else {
    settings.push_back("experiment.load_kg=" + format_number(load_kg));
    settings.push_back("experiment.speed_m_s=" + format_number(speed_m_s));
  }
  return settings;
}

const std::vector<std::pair<std::string, Part>>& part_names() {
  static const std::vector<std::pair<std::string, Part>> names = {
      {"load", Part::kLoad},
      {"opening", Part::kOpening},
      {"traction", Part::kTraction},
      {"traction-opening", Part::kTractionOpening}};
  return names;
}

std::vector<Cell> plan_cells(const std::set<Part>& parts, Design design, int beds, int first_bed) {
  std::vector<Cell> of_one_bed;
  for (const Part part : parts) {
    for (const Cell& cell : conditions(part, design)) {
      const bool there = std::any_of(of_one_bed.begin(), of_one_bed.end(), [&](const Cell& c) {
        return c.condition() == cell.condition();
      });
      if (!there) of_one_bed.push_back(cell);
    }
  }
  std::vector<Cell> cells;
  for (int bed = first_bed; bed < first_bed + beds; ++bed) {
    for (Cell cell : of_one_bed) {
      cell.bed = bed;
      cells.push_back(cell);
    }
  }
  return cells;
}

}  // namespace hoof::tools
