#include "tools/conceal/pick.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hoof::tools::conceal {
namespace {

template <typename T>
bool holds(const std::vector<T>& list, const T& value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

std::string joined(std::vector<std::string> names, const char* by) {
  std::sort(names.begin(), names.end());
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : by) + name;
  return text;
}

template <typename Price>
std::vector<std::string> cheapest(const Answer& answer, Price price) {
  double least = std::numeric_limits<double>::infinity();
  std::vector<std::string> name;
  for (const AnsweredHypothesis& h : answer.hypotheses) {
    const double cost = price(h) - 2.0 * h.log_likelihood;
    if (cost < least) least = cost, name = {h.name};
  }
  return name;
}

}  // namespace

Pick pick_of(const Answer& answer) {
  Pick pick{answer.verdict, {}, answer.not_separable, 0};
  for (const AnsweredEffect& effect : answer.effects) {
    pick.names.push_back(effect.name);
    if (effect.probability > 0.5) ++pick.sure;
  }
  return pick;
}

Pick pick_named(const std::string& name) {
  if (name == "none") return {"none", {}, {}, 0};
  if (name == "unknown") return {"unknown_physics", {}, {}, 0};
  const std::size_t plus = name.find('+');
  if (plus == std::string::npos) return {"missing_physics", {name}, {}, 1};
  return {"missing_physics", {name.substr(0, plus), name.substr(plus + 1)}, {}, 2};
}

bool right(const TruthCase& truth, const Pick& pick) {
  if (truth.nothing_hidden()) return pick.verdict == "none";
  if (truth.kind == "unknown") return pick.verdict == "unknown_physics";
  if (truth.kind == "not_decidable") {
    return pick.verdict == "not_separable" &&
           std::any_of(pick.alike.begin(), pick.alike.end(), [&truth](const auto& set) {
             const auto known =
                 std::count_if(truth.alike.begin(), truth.alike.end(),
                               [&set](const auto& name) { return holds(set, name); });
             return known >= 2 && holds(set, truth.effects[0].name);
           });
  }
  if (pick.verdict != "missing_physics") return false;
  const std::size_t looked_at = std::min(pick.names.size(), truth.effects.size());
  const std::vector<std::string> first(pick.names.begin(),
                                       pick.names.begin() + std::ptrdiff_t(looked_at));
  return std::all_of(truth.effects.begin(), truth.effects.end(),
                     [&first](const HiddenEffect& e) { return holds(first, e.name); });
}

std::string label(const TruthCase& truth) {
  if (truth.nothing_hidden()) return "none";
  if (truth.kind == "unknown") return "unknown";
  if (truth.kind == "not_decidable") return joined(truth.alike, "|");
  std::vector<std::string> names;
  for (const HiddenEffect& effect : truth.effects) names.push_back(effect.name);
  return joined(names, "+");
}

std::string label(const Pick& pick) {
  if (pick.verdict == "none") return "none";
  if (pick.verdict == "unknown_physics") return "unknown";
  if (pick.verdict == "not_separable") return pick.alike.empty() ? "?" : joined(pick.alike[0], "|");
  std::vector<std::string> names = pick.names;
  names.resize(std::min(names.size(), std::clamp<std::size_t>(pick.sure, 1, 2)));
  return names.empty() ? "?" : joined(names, "+");
}

std::vector<std::string> pick_by_aic(const Answer& answer) {
  return cheapest(answer, [](const AnsweredHypothesis& h) { return 2.0 * h.parameters_count; });
}

std::vector<std::string> pick_by_bic(const Answer& answer) {
  return cheapest(answer, [](const AnsweredHypothesis& h) {
    return std::log(std::max(h.samples_count, 1.0)) * h.parameters_count;
  });
}

}  // namespace hoof::tools::conceal
