// Small parts that building and updating the list share.
#pragma once

#include <algorithm>
#include <cmath>

#include "sim/dem/neighbour_list.h"

namespace hoof::sim {

template <typename Real>
float NeighbourList<Real>::gap_m(const Reference& a, const Reference& b) const {
  const auto difference = [](std::uint32_t p, std::uint32_t q) {
    return float(std::int32_t(p - q));
  };
  const float dx = lsb_m_[0] * difference(a.x, b.x);
  const float dy = lsb_m_[1] * difference(a.y, b.y);
  const float dz = lsb_m_[2] * difference(a.z, b.z);
  return std::sqrt(dx * dx + dy * dy + dz * dz) - (a.radius_m + b.radius_m);
}

template <typename Real>
Reference NeighbourList<Real>::reference_of(const Record& r) const {
  constexpr int kShift = sizeof(typename Record::Steps) == 8 ? 32 : 0;
  const auto high = [](auto steps) {
    return std::uint32_t(std::make_unsigned_t<decltype(steps)>(steps) >> kShift);
  };
  return {high(r.x), high(r.y), high(r.z), float(r.radius_m)};
}

/// Nearest first: places without a touching lane then come last and stop after the distance. Equal
/// gaps are ordered by the grains' names, so that the order does not depend on that of the rows.
template <typename Real>
template <typename Item>
void NeighbourList<Real>::sort_by_gap(Item* begin, Item* end, const Records& records) {
  std::sort(begin, end, [&](const Item& a, const Item& b) {
    return a.gap_m != b.gap_m ? a.gap_m < b.gap_m : records[a.row].id < records[b.row].id;
  });
}

}  // namespace hoof::sim
