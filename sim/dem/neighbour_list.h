// Who is near whom: grains sorted along a space-filling curve, and for each the list of all grains
// within reach plus a skin, in the lanes' own layout.
//
// Every pair stands in both grains' lists and is computed twice: no write conflicts, no atomics,
// the same bytes from any number of threads.
//
// A pair is listed while the two grains' references (where they were when last looked up) are less
// than their radii and the skin apart; that is sound while no grain is further than half the skin
// from its reference. Grains that come near that bound get a new reference, and only their own and
// their neighbours' rows are written anew: a grain that rattles in its cage, or the sand that flows
// around a foot, does not make the resting rest of the bed look for neighbours. What is listed, and
// in which order, depends on the references alone.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/dem/aligned_allocator.h"
#include "sim/dem/byte_archive.h"
#include "sim/dem/cell_chains.h"
#include "sim/dem/domain.h"
#include "sim/dem/grain_record.h"
#include "sim/dem/thread_team.h"

namespace hoof::sim {

template <typename Real>
class NeighbourList {
 public:
  using Record = GrainRecord<Real>;
  using Records = std::vector<Record, AlignedAllocator<Record>>;
  using Slots = std::vector<EllSlot<Real>, AlignedAllocator<EllSlot<Real>>>;

  /// How far and in which cells neighbours are looked for.
  struct Reach {
    double largest_radius_m = 0;
    double skin_m = 0;
    double cell_m = 0;
  };

  /// Sorts `records` (count grains, then padding; `scratch` is of the same size) and lists all
  /// neighbours. Tangential displacements of touching pairs move along.
  /// @return old row of each new row
  const std::vector<std::uint32_t>& sort(Records& records, Records& scratch, std::uint32_t count,
                                         const Domain& domain, const Reach& reach,
                                         ThreadTeam& team);

  /// No row of window w has gone further than distance_m[w] since the last call.
  template <typename DistanceOf>
  void travelled(const DistanceOf& distance_m) {
    for (std::size_t w = 0; w < bound_m_.size(); ++w) bound_m_[w] += distance_m(w);
  }

  /// Makes the lists good for the next step.
  /// @return number of grains that got a new reference
  std::size_t update(const Records& records, ThreadTeam& team);

  /// Enough rows have changed their places for a sort to pay.
  bool is_scattered() const { return cell_moves_ > count_ / 2; }
  /// Rows that got a new reference since the last call.
  std::uint64_t take_renewed() { return std::exchange(renewed_, 0); }
  const Reach& reach() const { return reach_; }

  std::uint32_t group_count() const { return group_count_; }
  std::uint32_t window_count() const { return std::uint32_t(bound_m_.size()); }
  std::size_t bytes() const;

  EllSlot<Real>* slots() { return slots_.data(); }
  const EllSlot<Real>* slots() const { return slots_.data(); }
  std::uint16_t* touching() { return touching_.data(); }
  const std::uint16_t* touching() const { return touching_.data(); }
  /// Per group, and one more with no slots.
  const std::vector<std::uint32_t>& slot_begin() const { return slot_begin_; }
  const std::vector<std::uint32_t>& slot_count() const { return slot_count_; }

  /// Place of `neighbour` in the list of `row`, or -1.
  std::int64_t find(std::uint32_t row, std::uint32_t neighbour) const;

  /// Everything that decides what the list does from here on; records are saved by the caller.
  void save(ByteWriter& out) const;
  void load(ByteReader& in, const Records& records, std::uint32_t count, const Domain& domain,
            ThreadTeam& team);

 private:
  struct Candidate {
    float gap_m;
    std::uint32_t row;
  };
  struct Found {  // a row's candidates in its member's `found`
    std::uint32_t begin, count;
  };
  struct Entry {  // of a row about to be written
    float gap_m;
    std::uint32_t row;
    bool touching;
    Real xi_x, xi_y, xi_z;
  };
  struct Edit {  // `row` is to be written anew, with `partner` in it unless that is kNone
    std::uint32_t row, partner;
    float gap_m;
  };
  struct NewRow {
    std::uint32_t row, begin, count;
  };
  struct Member {  // scratch of one thread
    std::vector<Candidate> found;
    std::vector<std::uint32_t> moved;
    std::vector<Edit> edits;
    std::vector<NewRow> rows;
    std::vector<Entry> entries;
  };
  static constexpr std::uint32_t kNone = 0xffffffff;

  void set_up(std::uint32_t count, const Domain& domain, const Reach& reach, int members);
  void take_references(const Records& records, std::uint32_t count);
  void chain_all();
  void search(std::uint32_t row, const Records& records, std::vector<Candidate>& found) const;
  void search_all(const Records& records, ThreadTeam& team);
  const Candidate* found_for(std::uint32_t row) const;
  void order_rows(Records& records, Records& scratch);
  void allot_slots();
  void fill_group(std::uint32_t group);
  void carry_history(std::uint32_t row);
  void clear_place(std::uint32_t slot, std::uint32_t row);

  bool find_moved(const Records& records, ThreadTeam& team);
  void renew_references(const Records& records);
  void search_moved(const Records& records, ThreadTeam& team);
  void collect_edits(int member, int members);
  void make_rows(const Records& records, Member& m);
  void make_row(std::uint32_t row, const Edit* edit, const Edit* end, const Records& records,
                Member& m);
  void grow_groups();
  void pack_slots();
  void write_rows(const Member& m);
  void keep_history(std::uint32_t row, Entry& entry) const;
  template <typename Item>
  static void sort_by_gap(Item* begin, Item* end, const Records& records);
  float gap_m(const Reference& a, const Reference& b) const;
  double displacement_m(const Record& r, const Reference& at) const;
  Reference reference_of(const Record& r) const;
  static std::uint32_t owner(std::uint32_t row, int members) {
    return (row / (kLanes * kGroupsPerWindow)) % std::uint32_t(members);
  }

  Reach reach_;
  Domain domain_;
  std::array<float, 3> lsb_m_{};  // of a reference
  CellChains chains_;
  std::uint32_t count_ = 0, group_count_ = 0;
  Slots slots_, old_slots_;
  std::vector<std::uint16_t> touching_, old_touching_;
  std::vector<std::uint32_t> slot_begin_, slot_count_, slot_capacity_;
  std::vector<std::uint32_t> old_slot_begin_, old_slot_count_;
  std::vector<Reference> reference_;      // per row
  std::vector<std::uint16_t> row_count_;  // neighbours per row
  std::vector<double> bound_m_;           // per window: no row is further from its reference
  std::vector<std::uint32_t> order_;      // row -> row before the sort
  std::vector<Member> members_;
  std::vector<Found> found_;             // per row, or per moved row
  std::vector<std::uint32_t> stale_;     // windows
  std::vector<std::uint32_t> moved_;     // rows
  std::vector<std::uint8_t> has_moved_;  // per row
  std::uint64_t cell_moves_ = 0, wasted_slots_ = 0, renewed_ = 0;
};

}  // namespace hoof::sim
