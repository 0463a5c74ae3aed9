#include "tools/diagnose/press_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/diagnose/press_recording.h"
#include "tools/run/errors.h"

namespace hoof::tools {
namespace {

/// Least value of a setup key.
double lowest(const std::string& key) {
  // Bekker's k_c of a fit is often negative; a height has no lower bound.
  if (key == "k_c" || key == "surface_height") return -std::numeric_limits<double>::infinity();
  return key == "n" ? 0.01 : 0.0;
}

std::vector<std::unique_ptr<sim::SoilEffect>> make_effects(std::span<const ActiveEffect> active) {
  std::vector<const ActiveEffect*> sorted;
  for (const ActiveEffect& effect : active) {
    if (effect.info->make_soil) sorted.push_back(&effect);
  }
  // In the order of the catalogue, whatever that of the hypothesis.
  std::sort(sorted.begin(), sorted.end(),
            [](const auto* a, const auto* b) { return a->info->name < b->info->name; });
  std::vector<std::unique_ptr<sim::SoilEffect>> effects;
  for (const ActiveEffect* effect : sorted) {
    effects.push_back(effect->info->make_soil(effect->values));
  }
  return effects;
}

}  // namespace

PressModel::PressModel(const std::vector<DataSet>& data_sets) {
  int presses_before = 0;
  for (const DataSet& set : data_sets) {
    if (set.rig != RigKind::kPlateSand && set.rig != RigKind::kRigidPress) {
      throw UserError(set.file.string() + ": rig: " + rig_name(set.rig) +
                      " cannot be one machine with plate_sand or rigid_press");
    }
    for (const Recording& recording : set.recordings) {
      Press press;
      press.recording = recording;
      press.rig = set.rig;
      press.noise = set.noise;
      if (set.rig == RigKind::kPlateSand) {
        press.surface_height = quantity(set, recording, "surface_height");
        press.k_c = quantity(set, recording, "k_c");
        press.k_phi = quantity(set, recording, "k_phi");
        press.n = quantity(set, recording, "n");
        press.diameter = quantity(set, recording, "diameter");
        press.width = quantity(set, recording, "width");
        press.length = quantity(set, recording, "length");
        press.wall_distance = quantity(set, recording, "wall_distance");
        read_sand(press, presses_before);
      } else {
        read_block(press);
        if (states_contact(press)) {
          press.surface_height = quantity(set, recording, "surface_height");
        }
      }
      // What cannot be compared is missing for whoever compares.
      auto& compared =
          press.recording.channels.at(set.rig == RigKind::kPlateSand ? "force" : "position");
      for (std::size_t i = 0; i < compared.size(); ++i) {
        if (!press.compared[i]) compared[i] = std::numeric_limits<double>::quiet_NaN();
      }
      presses_.push_back(std::move(press));
    }
  }
  choose_effects();
}

PressModel::Quantity PressModel::quantity(const DataSet& set, const Recording& recording,
                                          const std::string& key) {
  const SetupValue* own = recording.setup.find(key);
  if (own == nullptr) return {};
  Quantity result = {.known = true, .value = own->value};
  if (!(own->sigma > 0)) return result;
  const SetupValue* top = set.setup.find(key);
  const auto same = [&](const SetupValue& other) {
    return other.value == own->value && other.sigma == own->sigma;
  };
  std::string name = top != nullptr && same(*top) ? key : key + "@" + recording.name;
  for (std::size_t i = 0; i < doubtful_.size(); ++i) {
    if (doubtful_[i].name != name) continue;
    if (same(stated_[i])) {
      result.doubtful = static_cast<int>(i);
      return result;
    }
    name += "@" + set.name;  // another data set's, stated otherwise
  }
  result.doubtful = static_cast<int>(doubtful_.size());
  doubtful_.push_back({.name = name, .value = own->value, .sigma = own->sigma, .low = lowest(key)});
  stated_.push_back(*own);
  return result;
}

void PressModel::read_sand(Press& press, int& presses_before) {
  const Recording& recording = press.recording;
  const std::vector<double>& heights = recording.channels.at("position");
  press.path = press_path(recording.time_s, heights);
  const int after = count_presses(press.path, press.surface_height.value, presses_before);
  // Of planned presses one is made, after those that were: each is the next.
  if (!recording.planned) presses_before = after;
  const auto force = recording.channels.find("force");
  for (std::size_t i = 0; i < heights.size(); ++i) {
    press.compared.push_back(force != recording.channels.end() && !std::isnan(heights[i]) &&
                             !std::isnan(force->second[i]));
  }
}

void PressModel::read_block(Press& press) {
  const std::vector<double>& heights = press.recording.channels.at("position");
  const std::vector<double>& forces = press.recording.channels.at("force");
  press.compared = on_block(press.recording.time_s, heights, forces);
  double largest_N = 0;
  std::size_t lightest = forces.size();
  for (std::size_t i = 0; i < forces.size(); ++i) {
    press.force_N.push_back(std::isnan(forces[i]) ? 0.0 : forces[i]);
    if (!press.compared[i]) continue;
    largest_N = std::max(largest_N, forces[i]);
    if (lightest == forces.size() || forces[i] < forces[lightest]) lightest = i;
  }
  constexpr double kLight = 0.05;  // share of the largest force
  for (std::size_t i = 0; i < forces.size(); ++i) {
    if (press.compared[i] && (forces[i] < kLight * largest_N || i == lightest)) {
      press.light.push_back(i);
    }
  }
}

/// Whether surface_height is the block's: it may be that of the sand, in a setup for both.
bool PressModel::states_contact(const Press& press) {
  const SetupValue* stated = press.recording.setup.find("surface_height");
  if (stated == nullptr || press.light.empty()) return false;
  const std::vector<double>& heights = press.recording.channels.at("position");
  double low_m = INFINITY, high_m = -INFINITY;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    if (!press.compared[i]) continue;
    low_m = std::min(low_m, heights[i]);
    high_m = std::max(high_m, heights[i]);
  }
  const auto count = static_cast<double>(press.light.size());
  double mean_m = 0, square_m2 = 0;
  for (const std::size_t i : press.light) mean_m += heights[i] / count;
  for (const std::size_t i : press.light) square_m2 += std::pow(heights[i] - mean_m, 2) / count;
  const double off_m = std::abs(stated->value - mean_m);
  return off_m <= 0.15 * (high_m - low_m) + 5 * std::sqrt(square_m2) + 3 * stated->sigma;
}

const std::vector<std::string>& PressModel::channels(int recording) const {
  static const std::vector<std::string> kForce = {"force"}, kPosition = {"position"};
  return press(recording).rig == RigKind::kPlateSand ? kForce : kPosition;
}

double PressModel::stated_noise(int recording, const std::string& channel) const {
  const auto& noise = press(recording).noise;
  const auto found = noise.find(channel);
  return found == noise.end() ? 0.0 : found->second;
}

double PressModel::value(const Quantity& quantity, std::span<const double> setup) {
  if (quantity.doubtful < 0) return quantity.value;
  return setup[static_cast<std::size_t>(quantity.doubtful)];
}

sim::PressBench PressModel::bench(const Press& press, std::span<const double> setup) const {
  return {.plate = press.diameter.known
                       ? sim::disc(value(press.diameter, setup))
                       : sim::rectangle(value(press.width, setup), value(press.length, setup)),
          .soil = {.k_c = value(press.k_c, setup),
                   .k_phi = value(press.k_phi, setup),
                   .n = value(press.n, setup)},
          .surface_height_m = value(press.surface_height, setup),
          .wall_distance_m = value(press.wall_distance, setup)};
}

Prediction PressModel::predict(int recording, std::span<const double> setup,
                               std::span<const ActiveEffect> effects, Rollout) const {
  const Press& press = this->press(recording);
  const auto made = make_effects(effects);
  std::vector<double> values = press.rig == RigKind::kPlateSand ? predict_sand(press, setup, made)
                                                                : predict_block(press, setup, made);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!press.compared[i]) values[i] = std::numeric_limits<double>::quiet_NaN();
  }
  return {std::move(values)};
}

std::vector<double> PressModel::predict_sand(const Press& press, std::span<const double> setup,
                                             sim::SoilEffects effects) const {
  return sim::press_sand_N(bench(press, setup), press.path, effects);
}

/// The height of contact is the block's where that is known; else what the lightly loaded samples
/// say, the rig's travel under their own force taken off.
std::vector<double> PressModel::predict_block(const Press& press, std::span<const double> setup,
                                              sim::SoilEffects effects) const {
  if (press.surface_height.known) {
    return sim::press_block_m(value(press.surface_height, setup), press.force_N, effects);
  }
  std::vector<double> heights = sim::press_block_m(0, press.force_N, effects);
  const std::vector<double>& measured = press.recording.channels.at("position");
  double contact_m = 0;
  for (const std::size_t i : press.light) {
    contact_m += (measured[i] - heights[i]) / static_cast<double>(press.light.size());
  }
  for (double& height : heights) height += contact_m;
  return heights;
}

}  // namespace hoof::tools
