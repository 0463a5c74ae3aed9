#include "sim/dem/cell_chains.h"

#include <algorithm>

namespace hoof::sim {

void CellChains::reset(const Domain& domain, double cell_m, std::uint32_t row_count) {
  for (int axis = 0; axis < 3; ++axis) {
    // A thousand cells an axis keep the Morton key of a cell in 30 bits.
    count_[axis] = int(std::clamp(std::floor(domain.length_m(axis) / cell_m), 1.0, 1023.0));
    cells_per_step_[axis] = float(count_[axis] * 0x1p-32);
    cells_per_m_[axis] = float(count_[axis] / domain.length_m(axis));
  }
  periodic_ = domain.periodic;
  first_.assign(std::size_t(count_[0]) * std::size_t(count_[1]) * std::size_t(count_[2]), kNone);
  next_.assign(row_count, kNone);
}

bool CellChains::move(std::uint32_t row, const Reference& from, const Reference& to) {
  const std::size_t old_cell = cell_of(from), new_cell = cell_of(to);
  if (old_cell == new_cell) return false;
  std::uint32_t* link = &first_[old_cell];
  while (*link != row) link = &next_[*link];
  *link = next_[row];
  next_[row] = first_[new_cell];
  first_[new_cell] = row;
  return true;
}

}  // namespace hoof::sim
