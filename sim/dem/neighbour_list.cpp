#include "sim/dem/neighbour_list.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "sim/dem/neighbour_list_impl.h"

namespace hoof::sim {
namespace {

constexpr std::uint32_t kWindowRows = kLanes * kGroupsPerWindow;
constexpr std::uint32_t kSpareSlots = 1;  // per group, so that a row can get a neighbour in place

/// Bits of a cell number spread three apart (ten bits an axis).
std::uint32_t spread_bits(std::uint32_t v) {
  v &= 0x3ff;
  v = (v | (v << 16)) & 0x030000ff;
  v = (v | (v << 8)) & 0x0300f00f;
  v = (v | (v << 4)) & 0x030c30c3;
  return (v | (v << 2)) & 0x09249249;
}

/// Stable radix sort of `order` by `key`, 30 bits.
void sort_by_key(std::vector<std::uint32_t>& key, std::vector<std::uint32_t>& order) {
  std::vector<std::uint32_t> key_scratch(key.size()), order_scratch(order.size());
  for (int shift = 0; shift < 30; shift += 10) {
    std::array<std::uint32_t, 1025> start{};
    for (const std::uint32_t k : key) ++start[((k >> shift) & 0x3ff) + 1];
    for (int i = 0; i < 1024; ++i) start[i + 1] += start[i];
    for (std::size_t i = 0; i < key.size(); ++i) {
      const std::uint32_t at = start[(key[i] >> shift) & 0x3ff]++;
      key_scratch[at] = key[i];
      order_scratch[at] = order[i];
    }
    key.swap(key_scratch);
    order.swap(order_scratch);
  }
}

/// First row of a member's share of all rows: whole windows, so that ordering rows within windows
/// leaves each row with its member.
std::uint32_t share_begin(std::uint32_t count, int member, int members) {
  const std::uint64_t windows = (count + kWindowRows - 1) / kWindowRows;
  return std::min<std::uint32_t>(
      count, std::uint32_t(windows * std::uint64_t(member) / std::uint64_t(members)) * kWindowRows);
}

}  // namespace

template <typename Real>
void NeighbourList<Real>::set_up(std::uint32_t count, const Domain& domain, const Reach& reach,
                                 int members) {
  const double widest_m = 2 * reach.largest_radius_m + reach.skin_m;
  for (int axis = 0; axis < 3; ++axis) {
    // Narrower, and a grain could touch another and its image across the side.
    if (domain.periodic[axis] && domain.length_m(axis) < 3 * widest_m) {
      throw std::invalid_argument("a periodic bed must be at least three reaches wide: " +
                                  std::to_string(domain.length_m(axis)) + " m is under 3 x " +
                                  std::to_string(widest_m) + " m");
    }
    lsb_m_[std::size_t(axis)] = float(domain.length_m(axis) * 0x1p-32);
  }
  reach_ = reach;
  domain_ = domain;
  count_ = count;
  group_count_ = (count + kLanes - 1) / kLanes;
  members_.resize(std::size_t(members));
  bound_m_.assign((count + kWindowRows - 1) / kWindowRows, 0);
  row_count_.assign(count, 0);
  found_.assign(count, {});
  has_moved_.assign(count, 0);
  reference_.resize(count);
  cell_moves_ = wasted_slots_ = 0;
}

template <typename Real>
void NeighbourList<Real>::take_references(const Records& records, std::uint32_t count) {
  for (std::uint32_t row = 0; row < count; ++row) reference_[row] = reference_of(records[row]);
}

template <typename Real>
void NeighbourList<Real>::chain_all() {
  chains_.reset(domain_, reach_.cell_m, count_);
  for (std::uint32_t row = count_; row-- > 0;) chains_.insert(row, reference_[row]);
}

template <typename Real>
void NeighbourList<Real>::search(std::uint32_t row, const Records& records,
                                 std::vector<Candidate>& found) const {
  const Reference& at = reference_[row];
  const auto skin_m = float(reach_.skin_m);
  const std::size_t first = found.size();
  chains_.visit_near(at, at.radius_m + float(reach_.largest_radius_m) + skin_m,
                     [&](std::uint32_t other) {
                       const float gap = gap_m(at, reference_[other]);
                       if (gap < skin_m && other != row) found.push_back({gap, other});
                     });
  sort_by_gap(found.data() + first, found.data() + found.size(), records);
}

template <typename Real>
void NeighbourList<Real>::search_all(const Records& records, ThreadTeam& team) {
  const int members = team.size();
  team.run([&](int m) {
    std::vector<Candidate>& found = members_[std::size_t(m)].found;
    found.clear();
    const std::uint32_t end = share_begin(count_, m + 1, members);
    for (std::uint32_t row = share_begin(count_, m, members); row < end; ++row) {
      const auto begin = std::uint32_t(found.size());
      search(row, records, found);
      found_[row] = {begin, std::uint32_t(found.size()) - begin};
      row_count_[row] = std::uint16_t(found_[row].count);
    }
  });
}

template <typename Real>
auto NeighbourList<Real>::found_for(std::uint32_t row) const -> const Candidate* {
  const int members = int(members_.size());
  int m = 0;
  while (row >= share_begin(count_, m + 1, members)) ++m;
  return members_[std::size_t(m)].found.data() + found_[row].begin;
}

/// Within windows, rows with about as many touching (then listed) neighbours come side by side: the
/// lanes of a group then do about the same work.
template <typename Real>
void NeighbourList<Real>::order_rows(Records& records, Records& scratch) {
  std::vector<std::uint32_t> place_of_row(count_), row_of_place(count_);
  std::vector<std::uint32_t> weight(count_);
  for (std::uint32_t place = 0; place < count_; ++place) {
    const Candidate* mine = found_for(place);
    std::uint32_t touching = 0;
    while (touching < found_[place].count && mine[touching].gap_m < 0) ++touching;
    weight[place] = touching << 16 | found_[place].count;
    place_of_row[place] = place;
  }
  for (std::uint32_t first = 0; first < count_; first += kWindowRows) {
    const std::uint32_t last = std::min(first + kWindowRows, count_);
    std::stable_sort(place_of_row.begin() + first, place_of_row.begin() + last,
                     [&](std::uint32_t a, std::uint32_t b) { return weight[a] > weight[b]; });
    for (std::uint32_t row = first; row < last; ++row) row_of_place[place_of_row[row]] = row;
  }
  for (Member& m : members_) {
    for (Candidate& c : m.found) c.row = row_of_place[c.row];
  }
  const std::vector<std::uint32_t> order = order_;
  const std::vector<Reference> reference = reference_;
  const std::vector<Found> found = found_;
  for (std::uint32_t row = 0; row < count_; ++row) {
    const std::uint32_t place = place_of_row[row];
    order_[row] = order[place];
    reference_[row] = reference[place];
    found_[row] = found[place];
    row_count_[row] = std::uint16_t(found[place].count);
    scratch[row] = records[place];
  }
  records.swap(scratch);
}

template <typename Real>
void NeighbourList<Real>::allot_slots() {
  slot_begin_.assign(group_count_ + 1, 0);
  slot_count_.assign(group_count_ + 1, 0);
  slot_capacity_.assign(group_count_, 0);
  std::uint32_t total = 0;
  for (std::uint32_t group = 0; group < group_count_; ++group) {
    const std::uint32_t first = group * kLanes, last = std::min(first + kLanes, count_);
    slot_begin_[group] = total;
    slot_count_[group] = *std::max_element(row_count_.begin() + first, row_count_.begin() + last);
    slot_capacity_[group] = slot_count_[group] + kSpareSlots;
    total += slot_capacity_[group];
  }
  slot_begin_[group_count_] = total;
  // Groups that outgrow their place move to the end.
  slots_.reserve(total + total / 8);
  slots_.resize(total);
  touching_.assign(total, 0);
}

template <typename Real>
void NeighbourList<Real>::clear_place(std::uint32_t slot, std::uint32_t row) {
  const std::uint32_t lane = row % kLanes;
  EllSlot<Real>& s = slots_[slot];
  s.neighbour[lane] = std::int32_t(row);
  s.xi_x[lane] = s.xi_y[lane] = s.xi_z[lane] = 0;
  touching_[slot] &= std::uint16_t(~(1u << lane));
}

template <typename Real>
void NeighbourList<Real>::carry_history(std::uint32_t row) {
  const std::uint32_t old_row = order_[row];
  const std::uint32_t old_group = old_row / kLanes, old_lane = old_row % kLanes;
  if (old_group >= old_slot_begin_.size()) return;
  const std::uint32_t first = slot_begin_[row / kLanes], lane = row % kLanes;
  const Candidate* mine = found_for(row);
  const std::uint32_t old_begin = old_slot_begin_[old_group];
  for (std::uint32_t s = old_begin; s < old_begin + old_slot_count_[old_group]; ++s) {
    if (!(old_touching_[s] >> old_lane & 1)) continue;
    const auto partner = std::uint32_t(old_slots_[s].neighbour[old_lane]);
    for (std::uint32_t k = 0; k < found_[row].count; ++k) {
      if (order_[mine[k].row] != partner) continue;
      EllSlot<Real>& slot = slots_[first + k];
      slot.xi_x[lane] = old_slots_[s].xi_x[old_lane];
      slot.xi_y[lane] = old_slots_[s].xi_y[old_lane];
      slot.xi_z[lane] = old_slots_[s].xi_z[old_lane];
      touching_[first + k] |= std::uint16_t(1u << lane);
      break;
    }
  }
}

template <typename Real>
void NeighbourList<Real>::fill_group(std::uint32_t group) {
  const std::uint32_t first = slot_begin_[group];
  for (std::uint32_t s = first; s < first + slot_capacity_[group]; ++s) {
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) clear_place(s, group * kLanes + lane);
  }
  for (std::uint32_t row = group * kLanes; row < std::min((group + 1) * kLanes, count_); ++row) {
    const Candidate* mine = found_for(row);
    for (std::uint32_t k = 0; k < found_[row].count; ++k) {
      slots_[first + k].neighbour[row % kLanes] = std::int32_t(mine[k].row);
    }
    carry_history(row);
  }
}

template <typename Real>
const std::vector<std::uint32_t>& NeighbourList<Real>::sort(Records& records, Records& scratch,
                                                            std::uint32_t count,
                                                            const Domain& domain,
                                                            const Reach& reach, ThreadTeam& team) {
  set_up(count, domain, reach, team.size());
  take_references(records, count);
  chains_.reset(domain_, reach_.cell_m, 0);
  std::vector<std::uint32_t> key(count);
  order_.resize(count);
  for (std::uint32_t row = 0; row < count; ++row) {
    const std::array<int, 3> cell = chains_.cell_numbers(reference_[row]);
    key[row] = spread_bits(std::uint32_t(cell[0])) | spread_bits(std::uint32_t(cell[1])) << 1 |
               spread_bits(std::uint32_t(cell[2])) << 2;
    order_[row] = row;
  }
  sort_by_key(key, order_);
  for (std::uint32_t row = 0; row < count; ++row) scratch[row] = records[order_[row]];
  std::copy(records.begin() + count, records.end(), scratch.begin() + count);  // padding
  records.swap(scratch);
  std::copy(records.begin() + count, records.end(), scratch.begin() + count);

  take_references(records, count);
  chain_all();
  search_all(records, team);
  order_rows(records, scratch);
  chain_all();

  slots_.swap(old_slots_), touching_.swap(old_touching_);
  slot_begin_.swap(old_slot_begin_), slot_count_.swap(old_slot_count_);
  allot_slots();
  team.run([&](int m) {
    const std::uint32_t end = std::uint32_t(std::uint64_t(group_count_) * (m + 1) / team.size());
    for (std::uint32_t g = std::uint32_t(std::uint64_t(group_count_) * m / team.size()); g < end;
         ++g) {
      fill_group(g);
    }
  });
  old_slots_ = {}, old_touching_ = {}, old_slot_begin_ = {}, old_slot_count_ = {};
  for (Member& m : members_) m.found = {};
  return order_;
}

template <typename Real>
std::int64_t NeighbourList<Real>::find(std::uint32_t row, std::uint32_t neighbour) const {
  const std::uint32_t group = row / kLanes, begin = slot_begin_[group];
  for (std::uint32_t s = begin; s < begin + slot_count_[group]; ++s) {
    if (slots_[s].neighbour[row % kLanes] == std::int32_t(neighbour) && neighbour != row) return s;
  }
  return -1;
}

template <typename Real>
std::size_t NeighbourList<Real>::bytes() const {
  const auto of = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return of(slots_) + of(touching_) + of(slot_begin_) + of(slot_count_) + of(slot_capacity_) +
         of(reference_) + of(row_count_) + of(order_) + of(found_) + of(has_moved_) + of(bound_m_) +
         chains_.bytes();
}

template <typename Real>
void NeighbourList<Real>::save(ByteWriter& out) const {
  out.put(reach_);
  out.put(cell_moves_), out.put(renewed_);
  out.put_all(bound_m_);
  out.put_all(reference_);
  // Histories of touching pairs: the place in the row, then the displacement.
  for (std::uint32_t row = 0; row < count_; ++row) {
    const std::uint32_t group = row / kLanes, lane = row % kLanes;
    for (std::uint32_t k = 0; k < row_count_[row]; ++k) {
      const std::uint32_t s = slot_begin_[group] + k;
      if (!(touching_[s] >> lane & 1)) continue;
      out.put(std::uint16_t(k));
      out.put(slots_[s].xi_x[lane]), out.put(slots_[s].xi_y[lane]), out.put(slots_[s].xi_z[lane]);
    }
    out.put(std::uint16_t(0xffff));
  }
}

template <typename Real>
void NeighbourList<Real>::load(ByteReader& in, const Records& records, std::uint32_t count,
                               const Domain& domain, ThreadTeam& team) {
  const Reach reach = in.get<Reach>();
  set_up(count, domain, reach, team.size());
  in.get(cell_moves_), in.get(renewed_);
  in.get_all(bound_m_);
  in.get_all(reference_);
  if (reference_.size() != count) throw std::runtime_error("is of another number of grains");
  order_.resize(count);
  for (std::uint32_t row = 0; row < count; ++row) order_[row] = row;
  chain_all();
  search_all(records, team);
  old_slot_begin_ = {};
  allot_slots();
  for (std::uint32_t g = 0; g < group_count_; ++g) fill_group(g);
  for (std::uint32_t row = 0; row < count; ++row) {
    const std::uint32_t lane = row % kLanes;
    for (std::uint16_t k = in.get<std::uint16_t>(); k != 0xffff; k = in.get<std::uint16_t>()) {
      if (k >= row_count_[row]) throw std::runtime_error("names a neighbour that is not there");
      const std::uint32_t s = slot_begin_[row / kLanes] + k;
      in.get(slots_[s].xi_x[lane]), in.get(slots_[s].xi_y[lane]), in.get(slots_[s].xi_z[lane]);
      touching_[s] |= std::uint16_t(1u << lane);
    }
  }
  for (Member& m : members_) m.found = {};
}

template class NeighbourList<float>;
template class NeighbourList<double>;

}  // namespace hoof::sim
