#include "tools/reproduce/reasons.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace hoof::tools {
namespace {

const std::string kAndSole = std::string(" + ") + kSoleReading;

const Comparison* find(const std::vector<Comparison>& rows, const std::string& name) {
  for (const Comparison& row : rows) {
    if (row.name == name) return &row;
  }
  return nullptr;
}

/// Runs are deterministic: what a change is not of comes out the same to the last bit.
bool same(const Sample& a, const Sample& b) {
  return a.n == b.n && a.mean == b.mean;
}

}  // namespace

Altered altered(std::string kind, std::string name, std::string what, const Outcomes& base,
                const Outcomes& changed, const Outcomes& same) {
  Altered a{std::move(kind), std::move(name), std::move(what), changed, {}, false};
  std::set<int> beds;
  for (const auto& [condition, runs] : changed) {
    for (const auto& [bed, run] : runs) beds.insert(bed);
  }
  const auto of_beds = [&](const Outcomes& all, Outcomes& to) {
    for (const auto& [condition, runs] : all) {
      for (const auto& [bed, run] : runs) {
        if (beds.count(bed) == 1) to[condition].emplace(bed, run);
      }
    }
  };
  of_beds(same, a.with);
  of_beds(base, a.without);
  return a;
}

Altered sole_reading(const Outcomes& base) {
  return altered("reading", kSoleReading,
                 "depth is how far the sole is in the sand, not how far the spines went since they "
                 "touched it (the paper does not say which it means)",
                 base, read_by_sole(base), {});
}

Altered with_sole_reading(const Altered& change) {
  Altered both = change;
  both.kind += " and reading", both.name += kAndSole;
  both.what += std::string("; ") + kSoleReading;
  both.with = read_by_sole(change.with);
  both.both = true;
  return both;
}

void try_changes(std::vector<Comparison>& rows, const std::vector<Altered>& changes) {
  for (Comparison& row : rows) row.tried.clear();
  for (const Altered& change : changes) {
    const std::vector<Comparison> with = compare_with_paper(change.with);
    const std::vector<Comparison> without = compare_with_paper(change.without);
    for (Comparison& row : rows) {
      const Comparison* changed = find(with, row.name);
      const Comparison* unchanged = find(without, row.name);
      if (changed == nullptr || unchanged == nullptr || !changed->ours || !unchanged->ours)
        continue;
      if (same(*changed->ours, *unchanged->ours) || !std::isfinite(changed->ours->mean)) continue;
      // Of both it says nothing new where it is what one of the two alone gave.
      const bool known = std::any_of(row.tried.begin(), row.tried.end(),
                                     [&](const Tried& t) { return same(t.with, *changed->ours); });
      if (change.both && known) continue;
      // Of runs that the change is none of the reading alone speaks.
      const bool counts = std::any_of(row.tried.begin(), row.tried.end(), [&](const Tried& t) {
        return change.name == t.name + kAndSole;
      });
      if (change.both && !counts) continue;
      row.tried.push_back({change.kind, change.name, change.what, *changed->ours, *unchanged->ours,
                           changed->judgement() == Judgement::kInside, change.both});
    }
  }
}

}  // namespace hoof::tools
