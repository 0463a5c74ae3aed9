// Who is near whom: grains sorted along a space-filling curve, and for each the list of all grains
// within reach plus a skin, in the lanes' own layout.
//
// Every pair stands in both grains' lists and is computed twice: no write conflicts, no atomics,
// the same bytes from any number of threads.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/dem/aligned_allocator.h"
#include "sim/dem/domain.h"
#include "sim/dem/grain_record.h"
#include "sim/dem/thread_team.h"

namespace hoof::sim {

/// Cells of at least one reach, holding rows. Valid for the order made by the last rebuild.
struct CellGrid {
  std::array<int, 3> count{};             // cells along each axis
  std::vector<std::uint32_t> begin, end;  // per cell: range in `rows`
  std::vector<std::uint32_t> rows;

  std::size_t index(int cx, int cy, int cz) const {
    return (std::size_t(cz) * count[1] + cy) * count[0] + cx;
  }
  static int cell_of(std::int32_t steps, int cells) {
    return int((std::uint64_t(std::uint32_t(steps)) * std::uint64_t(cells)) >> 32);
  }
};

template <typename Real>
class NeighbourList {
 public:
  using Record = GrainRecord<Real>;
  using Records = std::vector<Record, AlignedAllocator<Record>>;
  using Slots = std::vector<EllSlot<Real>, AlignedAllocator<EllSlot<Real>>>;

  /// Sorts `records` (count grains, then padding) and lists neighbours up to r_i + r_j + skin
  /// apart. Tangential displacements of touching pairs move along.
  /// @return old row of each new row
  const std::vector<std::uint32_t>& rebuild(Records& records, std::uint32_t count,
                                            const Domain& domain, double largest_radius_m,
                                            double skin_m, ThreadTeam& team);

  std::uint32_t group_count() const { return group_count_; }
  Slots& slots() { return slots_; }
  const Slots& slots() const { return slots_; }
  std::vector<std::uint16_t>& touching() { return touching_; }
  const std::vector<std::uint16_t>& touching() const { return touching_; }
  const std::vector<std::uint32_t>& slot_begin() const { return slot_begin_; }
  const CellGrid& cells() const { return cells_; }

  /// Place of `neighbour` in the list of `row`, or -1.
  std::int64_t find(std::uint32_t row, std::uint32_t neighbour) const;

 private:
  struct Candidate {
    Real gap_m;
    std::uint32_t place;  // position in the sorted order
  };
  struct Chunk {  // neighbours found by one thread, in order
    std::vector<Candidate> found;
    std::vector<std::uint32_t> first;  // per grain of the chunk
  };

  void sort_into_cells(const Records& records, std::uint32_t count, const Domain& domain,
                       double reach_m);
  void search(std::uint32_t begin, std::uint32_t end, const Domain& domain, Real skin_m,
              Chunk& chunk) const;
  void search_from(std::uint32_t place, const Domain& domain, Real skin_m,
                   std::vector<Candidate>& found) const;
  void order_rows(std::uint32_t count);
  void fill_group(std::uint32_t group, std::uint32_t count);
  void carry_history(std::uint32_t row, std::uint32_t place);
  const Candidate* neighbours_of(std::uint32_t place) const { return neighbours_[place]; }

  std::uint32_t group_count_ = 0;
  Slots slots_, old_slots_;
  std::vector<std::uint16_t> touching_, old_touching_;
  std::vector<std::uint32_t> slot_begin_, old_slot_begin_;
  CellGrid cells_;
  std::vector<std::uint32_t> order_;  // place -> old row
  std::vector<std::uint32_t> key_, key_scratch_, order_scratch_;
  std::vector<Chunk> chunks_;
  std::vector<const Candidate*> neighbours_;    // per place
  std::vector<std::uint32_t> neighbour_count_;  // per place
  std::vector<std::uint32_t> row_of_place_, place_of_row_, old_row_;
  Records sorted_;
};

}  // namespace hoof::sim
