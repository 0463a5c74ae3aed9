#include "tools/reproduce/cell.h"

#include <algorithm>
#include <regex>
#include <stdexcept>

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

/// Ratios of the feet at two loads, the effect of speed at one, that of 30 degrees; of traction the
/// short steps, and the long ones (two thirds of all work) of the two feet that the spines tell.
std::vector<Cell> night_conditions(Part part) {
  switch (part) {
    case Part::kLoad:
      return {sinkage(kSpined, 0, kLight_kg, kSlow_m_s),
              sinkage(kPlain, 0, kLight_kg, kSlow_m_s),
              sinkage(kTraditional, 0, kLight_kg, kSlow_m_s),
              sinkage(kSpined, 0, kMiddle_kg, kSlow_m_s),
              sinkage(kPlain, 0, kMiddle_kg, kSlow_m_s),
              sinkage(kTraditional, 0, kMiddle_kg, kSlow_m_s),
              sinkage(kSpined, 0, kMiddle_kg, kFast_m_s),
              sinkage(kPlain, 0, kMiddle_kg, kFast_m_s),
              sinkage(kTraditional, 0, kMiddle_kg, kFast_m_s)};
    case Part::kOpening:
      return {sinkage(kSpined, 0, kHeavy_kg, kSlow_m_s),
              sinkage(kSpined, 30, kHeavy_kg, kSlow_m_s)};
    case Part::kTraction:
      return {traction(kSpined, 0, kFast_Hz), traction(kPlain, 0, kFast_Hz),
              traction(kTraditional, 0, kFast_Hz), traction(kSpined, 0, kSlow_Hz),
              traction(kPlain, 0, kSlow_Hz)};
    case Part::kTractionOpening:
      return {};
  }
  return {};
}

std::vector<Cell> conditions(Part part, Design design) {
  if (design == Design::kNight) return night_conditions(part);
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

std::vector<std::string> CampaignSettings::of(const std::string& kind) const {
  std::vector<std::string> all = of_all;
  const std::vector<std::string>& own = kind == "sinkage" ? of_sinkage : of_traction;
  all.insert(all.end(), own.begin(), own.end());
  all.insert(all.end(), asked.begin(), asked.end());
  return all;
}

std::vector<std::string> CampaignSettings::ground_of(const std::string& kind) const {
  std::vector<std::string> all = of(kind);
  std::erase_if(all, [](const std::string& s) { return s.starts_with("experiment."); });
  return all;
}

std::vector<std::string> CampaignSettings::of(const Cell& cell) const {
  std::vector<std::string> all = of(cell.kind());
  const std::vector<std::string> own = cell.overrides();
  all.insert(all.end(), own.begin(), own.end());
  return all;
}

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
  settings.insert(settings.end(), changes.begin(), changes.end());
  return settings;
}

Cell cell_of(const std::string& condition) {
  static const std::regex kForm(
      "(sinkage|traction)-(bionic|bionic-plain|traditional)(?:-toe([0-9]+))?"
      "-(?:([0-9.]+)kg-([0-9.]+)m_s|([0-9.]+)Hz)");
  std::smatch part;
  if (!std::regex_match(condition, part, kForm)) {
    throw std::invalid_argument(condition + ": names no sinkage and no traction run");
  }
  Cell cell;
  cell.traction = part[1] == "traction";
  cell.foot = part[2];
  if (part[3].matched) cell.toe_deg = std::stoi(part[3]);
  if (part[4].matched) cell.load_kg = std::stod(part[4]), cell.speed_m_s = std::stod(part[5]);
  if (part[6].matched) cell.frequency_Hz = std::stod(part[6]);
  if (cell.condition() != condition) {
    throw std::invalid_argument(condition + ": is written " + cell.condition());
  }
  return cell;
}

const std::vector<std::pair<std::string, Part>>& part_names() {
  static const std::vector<std::pair<std::string, Part>> names = {
      {"load", Part::kLoad},
      {"opening", Part::kOpening},
      {"traction", Part::kTraction},
      {"traction-opening", Part::kTractionOpening}};
  return names;
}

const std::vector<std::pair<std::string, Design>>& design_names() {
  static const std::vector<std::pair<std::string, Design>> names = {
      {"night", Design::kNight}, {"stated", Design::kStated}, {"full", Design::kFull}};
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
