#include "tools/report/plot_groups.h"

#include <array>
#include <string_view>
#include <utility>

#include "tools/report/html.h"

namespace hoof::tools {
namespace {

/// A column belongs to the first rule whose unit is its own and one of whose words it holds.
struct PlotRule {
  std::string_view title;
  std::string_view quantity;              ///< as in tools/run/column_unit.cpp
  std::array<std::string_view, 3> words;  ///< unused ones empty
};

constexpr std::array kRules = {
    PlotRule{"Depth", "length", {"depth", "sinkage"}},
    PlotRule{"Forces on the foot", "force", {"fx", "fy", "fz"}},
    PlotRule{"Toe angle", "angle", {"toe"}},
    PlotRule{"Joint angles", "angle", {"hip", "knee"}},
    PlotRule{"Joint torques", "torque", {"toe", "hip", "knee"}},
    PlotRule{"Bus load", "ratio", {"bus"}},
};

bool matches(const PlotRule& rule, const SampleColumn& column, const DisplayUnit& unit) {
  if (rule.quantity != unit.quantity) return false;
  for (const std::string_view word : rule.words) {
    if (!word.empty() && column.name.find(word) != std::string::npos) return true;
  }
  return false;
}

}  // namespace

std::vector<PlotGroup> group_plots(const SampleTable& table) {
  std::vector<PlotGroup> by_rule(kRules.size());
  std::vector<PlotGroup> others;
  for (const SampleColumn& column : table.columns) {
    if (column.is_text() || column.name == "time_s") continue;
    const DisplayUnit unit = display_unit(column.name);
    PlotGroup* group = nullptr;
    for (std::size_t i = 0; i < kRules.size() && group == nullptr; ++i) {
      if (!matches(kRules[i], column, unit)) continue;
      group = &by_rule[i];
      group->title = kRules[i].title;
    }
    for (std::size_t i = 0; i < others.size() && group == nullptr; ++i) {
      const bool same_unit =
          others[i].unit.symbol == unit.symbol && others[i].unit.quantity == unit.quantity;
      if (same_unit) group = &others[i];
    }
    if (group == nullptr) {
      group = &others.emplace_back();
      group->title = capitalised(unit.quantity.empty() ? "others" : unit.quantity);
    }
    group->unit = unit;
    group->columns.push_back(&column);
  }
  std::vector<PlotGroup> groups;
  for (PlotGroup& group : by_rule) {
    if (!group.columns.empty()) groups.push_back(std::move(group));
  }
  for (PlotGroup& group : others) groups.push_back(std::move(group));
  return groups;
}

}  // namespace hoof::tools
