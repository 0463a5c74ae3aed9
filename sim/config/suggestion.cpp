#include "sim/config/suggestion.h"

#include <algorithm>
#include <array>
#include <vector>

namespace hoof::sim {
namespace {

/// Suffixes a user may think of, longest first so that rad_s is not taken for s. Not only those the
/// settings use: the suggestion is for the wrong ones.
constexpr std::array<std::string_view, 37> kUnitSuffixes = {
    "Nm_s_rad", "Nm_rad", "N_s_m", "kg_m3", "g_cm2", "rad_s", "deg_s", "mm_s", "cm_s", "km_h",
    "m_s2",     "N_mm",   "N_m",   "m_s",   "kHz",   "rpm",   "MPa",   "GPa",  "kPa",  "deg",
    "rad",      "kNm",    "mm",    "cm",    "um",    "ms",    "us",    "Hz",   "kg",   "Nm",
    "kN",       "Pa",     "m",     "s",     "g",     "N",     "C"};

/// The name without "_mm" or the like.
std::string_view stem(std::string_view name) {
  for (const std::string_view suffix : kUnitSuffixes) {
    if (name.size() > suffix.size() + 1 && name.ends_with(suffix) &&
        name[name.size() - suffix.size() - 1] == '_') {
      return name.substr(0, name.size() - suffix.size() - 1);
    }
  }
  return name;
}

}  // namespace

int edit_distance(std::string_view a, std::string_view b) {
  std::vector<int> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({replaced, last[j] + 1, row[j - 1] + 1});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

std::string suggest(std::string_view name, std::span<const std::string> candidates) {
  for (const std::string& candidate : candidates) {
    if (stem(candidate) == stem(name)) return candidate;
  }
  // A third of the letters wrong is still recognisable; at least two, for short names.
  int allowed = std::max(2, static_cast<int>(name.size()) / 3);
  std::string best;
  for (const std::string& candidate : candidates) {
    const int distance = edit_distance(name, candidate);
    if (distance > allowed || distance >= static_cast<int>(candidate.size())) continue;
    allowed = distance - 1;
    best = candidate;
  }
  return best;
}

}  // namespace hoof::sim
