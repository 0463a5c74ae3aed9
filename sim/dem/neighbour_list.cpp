#include "sim/dem/neighbour_list.h"

#include <algorithm>
#include <stdexcept>

namespace hoof::sim {
namespace {

constexpr std::uint32_t kWindow = 256;  // rows sorted by list length within this many; best of 16
                                        // ... 1024 on a trial kernel of the same layout

/// Bits of a cell number spread three apart (ten bits an axis).
std::uint32_t spread_bits(std::uint32_t v) {
  v &= 0x3ff;
  v = (v | (v << 16)) & 0x030000ff;
  v = (v | (v << 8)) & 0x0300f00f;
  v = (v | (v << 4)) & 0x030c30c3;
  return (v | (v << 2)) & 0x09249249;
}

/// Stable radix sort of `order` by `key`, 30 bits.
void sort_by_key(std::vector<std::uint32_t>& key, std::vector<std::uint32_t>& order,
                 std::vector<std::uint32_t>& key_scratch,
                 std::vector<std::uint32_t>& order_scratch) {
  key_scratch.resize(key.size());
  order_scratch.resize(order.size());
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

int cells_along(double length_m, double reach_m) {
  return int(std::clamp(std::floor(length_m / reach_m), 1.0, 1023.0));
}

}  // namespace

template <typename Real>
void NeighbourList<Real>::sort_into_cells(const Records& records, std::uint32_t count,
                                          const Domain& domain, double reach_m) {
  for (int axis = 0; axis < 3; ++axis) {
    cells_.count[axis] = cells_along(domain.length_m(axis), reach_m);
    if (domain.periodic[axis] && cells_.count[axis] < 3) {
      throw std::invalid_argument("a periodic bed must be at least three reaches wide: " +
                                  std::to_string(domain.length_m(axis)) + " m is under 3 x " +
                                  std::to_string(reach_m) + " m");
    }
  }
  const auto& n = cells_.count;
  key_.resize(count);
  order_.resize(count);
  for (std::uint32_t row = 0; row < count; ++row) {
    const Record& p = records[row];
    key_[row] = spread_bits(CellGrid::cell_of(p.x, n[0])) |
                spread_bits(CellGrid::cell_of(p.y, n[1])) << 1 |
                spread_bits(CellGrid::cell_of(p.z, n[2])) << 2;
    order_[row] = row;
  }
  sort_by_key(key_, order_, key_scratch_, order_scratch_);

  const std::size_t cell_total = std::size_t(n[0]) * n[1] * n[2];
  cells_.begin.assign(cell_total, 0);
  cells_.end.assign(cell_total, 0);
  sorted_.resize(count);
  for (std::uint32_t place = 0; place < count; ++place) {
    const Record& p = records[order_[place]];
    sorted_[place] = p;
    const std::size_t cell = cells_.index(
        CellGrid::cell_of(p.x, n[0]), CellGrid::cell_of(p.y, n[1]), CellGrid::cell_of(p.z, n[2]));
    if (cells_.end[cell] == 0) cells_.begin[cell] = place;
    cells_.end[cell] = place + 1;
  }
}

template <typename Real>
void NeighbourList<Real>::search_from(std::uint32_t place, const Domain& domain, Real skin_m,
                                      std::vector<Candidate>& found) const {
  const Record& p = sorted_[place];
  const auto& n = cells_.count;
  const std::array<int, 3> at = {CellGrid::cell_of(p.x, n[0]), CellGrid::cell_of(p.y, n[1]),
                                 CellGrid::cell_of(p.z, n[2])};
  const Real lsb[3] = {Real(domain.lsb_m.x()), Real(domain.lsb_m.y()), Real(domain.lsb_m.z())};
  std::array<std::array<int, 3>, 3> cell{};
  for (int axis = 0; axis < 3; ++axis) {
    for (int d = -1; d <= 1; ++d) {
      int c = at[axis] + d;
      if (c < 0 || c >= n[axis]) c = domain.periodic[axis] ? (c + n[axis]) % n[axis] : -1;
      cell[axis][d + 1] = c;
    }
  }
  for (const int cz : cell[2]) {
    if (cz < 0) continue;
    for (const int cy : cell[1]) {
      if (cy < 0) continue;
      for (const int cx : cell[0]) {
        if (cx < 0) continue;
        const std::size_t c = cells_.index(cx, cy, cz);
        for (std::uint32_t other = cells_.begin[c]; other < cells_.end[c]; ++other) {
          if (other == place) continue;
          const Record& q = sorted_[other];
          const auto difference = [](std::int32_t a, std::int32_t b) {
            return Real(std::int32_t(std::uint32_t(a) - std::uint32_t(b)));
          };
          const Real dx = lsb[0] * difference(p.x, q.x), dy = lsb[1] * difference(p.y, q.y),
                     dz = lsb[2] * difference(p.z, q.z);
          const Real reach = p.radius_m + q.radius_m + skin_m;
          const Real d2 = dx * dx + dy * dy + dz * dz;
          if (d2 < reach * reach) {
            found.push_back({std::sqrt(d2) - p.radius_m - q.radius_m, other});
          }
        }
      }
    }
  }
}

template <typename Real>
void NeighbourList<Real>::search(std::uint32_t begin, std::uint32_t end, const Domain& domain,
                                 Real skin_m, Chunk& chunk) const {
  chunk.found.clear();
  chunk.first.clear();
  for (std::uint32_t place = begin; place < end; ++place) {
    const auto first = std::uint32_t(chunk.found.size());
    chunk.first.push_back(first);
    search_from(place, domain, skin_m, chunk.found);
    // Nearest first: places without a touching lane then come last and stop after the distance.
    std::sort(chunk.found.begin() + first, chunk.found.end(),
              [](const Candidate& a, const Candidate& b) {
                return a.gap_m != b.gap_m ? a.gap_m < b.gap_m : a.place < b.place;
              });
  }
  chunk.first.push_back(std::uint32_t(chunk.found.size()));
}

template <typename Real>
void NeighbourList<Real>::order_rows(std::uint32_t count) {
  row_of_place_.resize(count);
  place_of_row_.resize(count);
  for (std::uint32_t first = 0; first < count; first += kWindow) {
    const std::uint32_t last = std::min(first + kWindow, count);
    for (std::uint32_t place = first; place < last; ++place) place_of_row_[place] = place;
    std::stable_sort(place_of_row_.begin() + first, place_of_row_.begin() + last,
                     [&](std::uint32_t a, std::uint32_t b) {
                       return neighbour_count_[a] > neighbour_count_[b];
                     });
    for (std::uint32_t row = first; row < last; ++row) row_of_place_[place_of_row_[row]] = row;
  }
  slot_begin_.assign(group_count_ + 2, 0);
  for (std::uint32_t group = 0; group < group_count_; ++group) {
    std::uint32_t longest = 0;
    for (std::uint32_t row = group * kLanes; row < std::min((group + 1) * kLanes, count); ++row) {
      longest = std::max(longest, neighbour_count_[place_of_row_[row]]);
    }
    slot_begin_[group + 1] = slot_begin_[group] + longest;
  }
  slot_begin_[group_count_ + 1] = slot_begin_[group_count_];
}

template <typename Real>
void NeighbourList<Real>::carry_history(std::uint32_t row, std::uint32_t place) {
  const std::uint32_t old_row = order_[place];
  const std::uint32_t old_group = old_row / kLanes, old_lane = old_row % kLanes;
  if (old_group + 1 >= old_slot_begin_.size()) return;
  const std::uint32_t group = row / kLanes, lane = row % kLanes;
  const Candidate* mine = neighbours_of(place);
  for (std::uint32_t s = old_slot_begin_[old_group]; s < old_slot_begin_[old_group + 1]; ++s) {
    if (!(old_touching_[s] >> old_lane & 1)) continue;
    const auto partner = std::uint32_t(old_slots_[s].neighbour[old_lane]);
    for (std::uint32_t k = 0; k < neighbour_count_[place]; ++k) {
      if (order_[mine[k].place] != partner) continue;
      EllSlot<Real>& slot = slots_[slot_begin_[group] + k];
      slot.xi_x[lane] = old_slots_[s].xi_x[old_lane];
      slot.xi_y[lane] = old_slots_[s].xi_y[old_lane];
      slot.xi_z[lane] = old_slots_[s].xi_z[old_lane];
      touching_[slot_begin_[group] + k] |= std::uint16_t(1u << lane);
      break;
    }
  }
}

template <typename Real>
void NeighbourList<Real>::fill_group(std::uint32_t group, std::uint32_t count) {
  for (std::uint32_t s = slot_begin_[group]; s < slot_begin_[group + 1]; ++s) {
    EllSlot<Real>& slot = slots_[s];
    slot = {};
    for (int lane = 0; lane < kLanes; ++lane) slot.neighbour[lane] = int(group * kLanes) + lane;
    touching_[s] = 0;
  }
  for (std::uint32_t row = group * kLanes; row < std::min((group + 1) * kLanes, count); ++row) {
    const std::uint32_t place = place_of_row_[row];
    const Candidate* mine = neighbours_of(place);
    for (std::uint32_t k = 0; k < neighbour_count_[place]; ++k) {
      slots_[slot_begin_[group] + k].neighbour[row % kLanes] =
          std::int32_t(row_of_place_[mine[k].place]);
    }
    carry_history(row, place);
  }
}

template <typename Real>
const std::vector<std::uint32_t>& NeighbourList<Real>::rebuild(Records& records,
                                                               std::uint32_t count,
                                                               const Domain& domain,
                                                               double largest_radius_m,
                                                               double skin_m, ThreadTeam& team) {
  sort_into_cells(records, count, domain, 2 * largest_radius_m + skin_m);

  const int members = team.size();
  chunks_.resize(members);
  const auto chunk_begin = [&](int m) { return std::uint32_t(std::uint64_t(count) * m / members); };
  team.run(
      [&](int m) { search(chunk_begin(m), chunk_begin(m + 1), domain, Real(skin_m), chunks_[m]); });
  neighbours_.resize(count);
  neighbour_count_.resize(count);
  for (int m = 0; m < members; ++m) {
    const Chunk& chunk = chunks_[m];
    for (std::uint32_t place = chunk_begin(m); place < chunk_begin(m + 1); ++place) {
      const std::uint32_t i = place - chunk_begin(m);
      neighbours_[place] = chunk.found.data() + chunk.first[i];
      neighbour_count_[place] = chunk.first[i + 1] - chunk.first[i];
    }
  }

  slots_.swap(old_slots_);
  touching_.swap(old_touching_);
  slot_begin_.swap(old_slot_begin_);
  group_count_ = (count + kLanes - 1) / kLanes;
  order_rows(count);
  slots_.resize(slot_begin_[group_count_]);
  touching_.resize(slot_begin_[group_count_]);
  team.run([&](int m) {
    const std::uint32_t end = std::uint32_t(std::uint64_t(group_count_) * (m + 1) / members);
    for (std::uint32_t g = std::uint32_t(std::uint64_t(group_count_) * m / members); g < end; ++g) {
      fill_group(g, count);
    }
  });

  old_row_.resize(count);
  for (std::uint32_t row = 0; row < count; ++row) {
    records[row] = sorted_[place_of_row_[row]];
    old_row_[row] = order_[place_of_row_[row]];
  }
  cells_.rows.resize(count);
  for (std::uint32_t place = 0; place < count; ++place) cells_.rows[place] = row_of_place_[place];
  return old_row_;
}

template <typename Real>
std::int64_t NeighbourList<Real>::find(std::uint32_t row, std::uint32_t neighbour) const {
  const std::uint32_t group = row / kLanes;
  for (std::uint32_t s = slot_begin_[group]; s < slot_begin_[group + 1]; ++s) {
    if (slots_[s].neighbour[row % kLanes] == std::int32_t(neighbour) && neighbour != row) return s;
  }
  return -1;
}

template class NeighbourList<float>;
template class NeighbourList<double>;

}  // namespace hoof::sim
