#include "tools/report/headline.h"

#include <array>
#include <string_view>

#include "tools/report/display_unit.h"

namespace hoof::tools {
namespace {

enum class Source { kResult, kSettings };

struct HeadlineRule {
  std::string_view label;
  Source source;
  std::string_view table;  ///< of settings.toml; empty: top level
  std::string_view key;
};

constexpr std::array kRules = {
    HeadlineRule{"Foot", Source::kSettings, "foot", "name"},
    HeadlineRule{"Load", Source::kSettings, "experiment", "load_kg"},
    HeadlineRule{"Load", Source::kSettings, "experiment", "load_N"},
    HeadlineRule{"Load acts as", Source::kSettings, "experiment", "load_as"},
    HeadlineRule{"Speed at first contact", Source::kSettings, "experiment", "speed_m_s"},
    HeadlineRule{"Stance frequency", Source::kSettings, "experiment", "frequency_Hz"},
    HeadlineRule{"Bed", Source::kSettings, "bed", "name"},
    HeadlineRule{"Ground", Source::kResult, "ground", "terrain"},
    HeadlineRule{"Added physics", Source::kResult, "", "effects"},
    HeadlineRule{"Plant set anew", Source::kResult, "", "setup"},
    HeadlineRule{"Fast soil", Source::kResult, "ground", "soil"},
    HeadlineRule{"Hash of the soil", Source::kResult, "ground", "soil_hash"},
    HeadlineRule{"Soil fitted to", Source::kResult, "ground", "fitted_to"},
    HeadlineRule{"Error on the pushes fitted", Source::kResult, "ground", "fit_error_ratio"},
    HeadlineRule{"Error on pushes held out", Source::kResult, "ground", "held_out_error_ratio"},
    HeadlineRule{"Greatest depth", Source::kResult, "", "max_depth_m"},
    HeadlineRule{"Final depth", Source::kResult, "", "final_depth_m"},
    HeadlineRule{"Traction coefficient, Fx at its peak over Fz then", Source::kResult, "",
                 "traction_coefficient"},
    HeadlineRule{"Peak propulsive force Fx", Source::kResult, "", "fx_peak_N"},
    HeadlineRule{"Fz at that instant", Source::kResult, "", "fz_at_fx_peak_N"},
    HeadlineRule{"Peak vertical force Fz", Source::kResult, "", "fz_peak_N"},
    HeadlineRule{"Error of the foot's path", Source::kResult, "", "ellipse_error_m"},
    HeadlineRule{"Toe angle commanded, per side", Source::kResult, "", "toe_command_rad"},
    HeadlineRule{"Toe angle reached", Source::kResult, "", "toe_reached_rad"},
    HeadlineRule{"Toe deflection by the sand", Source::kResult, "", "toe_deflection_rad"},
    HeadlineRule{"Peak torque", Source::kResult, "", "torque_peak_Nm"},
    HeadlineRule{"Bus load", Source::kResult, "", "bus_load_ratio"},
    HeadlineRule{"Interventions of the torque gate", Source::kResult, "", "gate_interventions"},
};

constexpr int kDigits = 4;  // one more than any of these quantities is worth

}  // namespace

HeadlineRow headline_row(const std::string& label, const std::string& key,
                         const nlohmann::ordered_json& value) {
  if (value.is_string()) return {label, value.get<std::string>(), ""};
  if (!value.is_number_float()) return {label, value.dump(), display_unit(key).symbol};
  const DisplayUnit unit = display_unit(key);
  return {label, format_significant(unit.factor * value.get<double>(), kDigits), unit.symbol};
}

std::vector<HeadlineRow> headline(const RunData& data) {
  std::vector<HeadlineRow> rows;
  for (const HeadlineRule& rule : kRules) {
    const nlohmann::ordered_json* table =
        rule.source == Source::kResult ? &data.result : &data.settings;
    if (!rule.table.empty()) {
      const auto found = table->find(std::string(rule.table));
      if (found == table->end() || !found->is_object()) continue;
      table = &*found;
    }
    const std::string key(rule.key);
    const auto value = table->find(key);
    if (value == table->end() || value->is_null()) continue;
    const std::string label(rule.label);
    if (!value->is_object()) {
      rows.push_back(headline_row(label, key, *value));
      continue;
    }
    for (const auto& part : value->items()) {  // one value by joint, by bus
      rows.push_back(headline_row(label + ", " + part.key(), key, part.value()));
    }
  }
  return rows;
}

}  // namespace hoof::tools
