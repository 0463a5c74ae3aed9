// Who is in which cell: a grid of small cells, each with a chain of the rows in it. A row moves to
// another cell at the cost of its chain's length.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "sim/dem/domain.h"

namespace hoof::sim {

/// Where a grain was when its neighbours were last looked up, in steps of 2^-32 of the domain, and
/// its radius: all that a search for neighbours reads.
struct Reference {
  std::uint32_t x, y, z;
  float radius_m;
};

class CellChains {
 public:
  /// Empty cells of about cell_m.
  void reset(const Domain& domain, double cell_m, std::uint32_t row_count);

  void insert(std::uint32_t row, const Reference& at) {
    const std::size_t cell = cell_of(at);
    next_[row] = first_[cell];
    first_[cell] = row;
  }

  /// @return true if the row has another cell now
  bool move(std::uint32_t row, const Reference& from, const Reference& to);

  std::array<int, 3> cell_numbers(const Reference& r) const {
    return {number(r.x, 0), number(r.y, 1), number(r.z, 2)};
  }

  /// Calls visit(row) for the rows of every cell that a cube of +- reach_m about `at` meets.
  template <typename Visit>
  void visit_near(const Reference& at, float reach_m, const Visit& visit) const {
    const std::uint32_t steps[3] = {at.x, at.y, at.z};
    int low[3], span[3];
    for (int axis = 0; axis < 3; ++axis) {
      const float x = float(steps[axis]) * cells_per_step_[axis];  // in cells
      const float reach = reach_m * cells_per_m_[axis] + kRounding;
      low[axis] = int(std::floor(x - reach));
      int high = int(std::floor(x + reach));
      if (periodic_[axis]) {
        if (high - low[axis] >= count_[axis]) high = low[axis] + count_[axis] - 1;
        if (low[axis] < 0) low[axis] += count_[axis], high += count_[axis];
      } else {
        if (low[axis] < 0) low[axis] = 0;
        if (high >= count_[axis]) high = count_[axis] - 1;
      }
      span[axis] = high - low[axis] + 1;
    }
    for (int dz = 0; dz < span[2]; ++dz) {
      const std::size_t z = wrapped(low[2] + dz, 2);
      for (int dy = 0; dy < span[1]; ++dy) {
        const std::size_t line = (z * count_[1] + wrapped(low[1] + dy, 1)) * count_[0];
        for (int dx = 0; dx < span[0]; ++dx) {
          for (std::uint32_t row = first_[line + wrapped(low[0] + dx, 0)]; row != kNone;
               row = next_[row]) {
            visit(row);
          }
        }
      }
    }
  }

  std::size_t bytes() const { return 4 * (first_.capacity() + next_.capacity()); }

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;
  static constexpr float kRounding = 1e-3f;  // of a cell; single precision is 6e-5 of 1000 cells

  int number(std::uint32_t steps, int axis) const {
    return int((std::uint64_t(steps) * std::uint64_t(count_[axis])) >> 32);
  }
  std::size_t cell_of(const Reference& r) const {
    return (std::size_t(number(r.z, 2)) * count_[1] + number(r.y, 1)) * count_[0] + number(r.x, 0);
  }
  std::size_t wrapped(int i, int axis) const {
    return std::size_t(i >= count_[axis] ? i - count_[axis] : i);
  }

  std::array<int, 3> count_{};
  std::array<bool, 3> periodic_{};
  std::array<float, 3> cells_per_step_{}, cells_per_m_{};
  std::vector<std::uint32_t> first_;  // per cell
  std::vector<std::uint32_t> next_;   // per row
};

}  // namespace hoof::sim
