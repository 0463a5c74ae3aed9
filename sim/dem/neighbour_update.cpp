// Keeping the lists good between sorts: see the head of neighbour_list.h.
#include <cstdint>

#include "sim/dem/neighbour_list_impl.h"

namespace hoof::sim {
namespace {

constexpr std::uint32_t kWindowRows = kLanes * kGroupsPerWindow;
// When any window must be looked at, so are those that soon will be; when a row is looked at, it
// gets a new reference if that is soon due. Work then comes in fewer, larger portions.
constexpr double kSoonWindow = 0.7;
constexpr double kSoonRow = 0.5;
constexpr double kRounding = 0.999;  // of single precision in gaps: 5e-10 m of a skin of 5e-5 m

}  // namespace

template <typename Real>
double NeighbourList<Real>::displacement_m(const Record& r, const Reference& at) const {
  const Reference now = reference_of(r);
  const double dx = double(lsb_m_[0]) * std::int32_t(now.x - at.x);
  const double dy = double(lsb_m_[1]) * std::int32_t(now.y - at.y);
  const double dz = double(lsb_m_[2]) * std::int32_t(now.z - at.z);
  return std::sqrt(dx * dx + dy * dy + dz * dz);
}

template <typename Real>
bool NeighbourList<Real>::find_moved(const Records& records, ThreadTeam& team) {
  const double half_m = 0.5 * kRounding * reach_.skin_m;
  bool due = false;
  for (const double bound_m : bound_m_) due |= bound_m >= half_m;
  moved_.clear();
  if (!due) return false;
  stale_.clear();
  for (std::uint32_t w = 0; w < bound_m_.size(); ++w) {
    if (bound_m_[w] >= kSoonWindow * half_m) stale_.push_back(w);
  }
  const std::size_t members = members_.size();
  team.run([&](int m) {
    std::vector<std::uint32_t>& moved = members_[std::size_t(m)].moved;
    moved.clear();
    const std::size_t end = stale_.size() * std::size_t(m + 1) / members;
    for (std::size_t i = stale_.size() * std::size_t(m) / members; i < end; ++i) {
      const std::uint32_t w = stale_[i];
      double rest_m = 0;
      for (std::uint32_t row = w * kWindowRows; row < std::min((w + 1) * kWindowRows, count_);
           ++row) {
        const double moved_m = displacement_m(records[row], reference_[row]);
        if (moved_m < kSoonRow * half_m) {
          rest_m = std::max(rest_m, moved_m);
        } else {
          moved.push_back(row);
        }
      }
      bound_m_[w] = rest_m;
    }
  });
  for (const Member& m : members_) moved_.insert(moved_.end(), m.moved.begin(), m.moved.end());
  renewed_ += moved_.size();
  return !moved_.empty();
}

template <typename Real>
void NeighbourList<Real>::renew_references(const Records& records) {
  for (const std::uint32_t row : moved_) {
    const Reference to = reference_of(records[row]);
    cell_moves_ += chains_.move(row, reference_[row], to);
    reference_[row] = to;
    has_moved_[row] = 1;
  }
}

template <typename Real>
void NeighbourList<Real>::search_moved(const Records& records, ThreadTeam& team) {
  const std::size_t members = members_.size();
  team.run([&](int m) {
    std::vector<Candidate>& found = members_[std::size_t(m)].found;
    found.clear();
    const std::size_t end = moved_.size() * std::size_t(m + 1) / members;
    for (std::size_t i = moved_.size() * std::size_t(m) / members; i < end; ++i) {
      const auto begin = std::uint32_t(found.size());
      search(moved_[i], records, found);
      found_[i] = {begin, std::uint32_t(found.size()) - begin};
    }
  });
}

/// Which rows of a member's own windows are to be written anew, and what they gain.
template <typename Real>
void NeighbourList<Real>::collect_edits(int member, int members) {
  Member& own = members_[std::size_t(member)];
  own.edits.clear();
  const auto is_mine = [&](std::uint32_t row) {
    return owner(row, members) == std::uint32_t(member);
  };
  for (std::size_t i = 0; i < moved_.size(); ++i) {
    const std::uint32_t row = moved_[i], group = row / kLanes, lane = row % kLanes;
    if (is_mine(row)) own.edits.push_back({row, std::uint32_t(i), 0});
    for (std::uint32_t k = 0; k < row_count_[row]; ++k) {
      const auto other = std::uint32_t(slots_[slot_begin_[group] + k].neighbour[lane]);
      if (is_mine(other) && !has_moved_[other]) own.edits.push_back({other, kNone, 0});
    }
    std::size_t finder = 0;
    while (i >= moved_.size() * (finder + 1) / members_.size()) ++finder;
    const Candidate* found = members_[finder].found.data() + found_[i].begin;
    for (std::uint32_t k = 0; k < found_[i].count; ++k) {
      const std::uint32_t other = found[k].row;
      if (is_mine(other) && !has_moved_[other]) own.edits.push_back({other, row, found[k].gap_m});
    }
  }
  std::sort(own.edits.begin(), own.edits.end(), [](const Edit& a, const Edit& b) {
    return a.row != b.row ? a.row < b.row : a.partner < b.partner;
  });
}

template <typename Real>
void NeighbourList<Real>::keep_history(std::uint32_t row, Entry& entry) const {
  entry.touching = false;
  entry.xi_x = entry.xi_y = entry.xi_z = 0;
  const std::uint32_t begin = slot_begin_[row / kLanes], lane = row % kLanes;
  for (std::uint32_t s = begin; s < begin + row_count_[row]; ++s) {
    if (std::uint32_t(slots_[s].neighbour[lane]) != entry.row) continue;
    entry.touching = touching_[s] >> lane & 1;
    entry.xi_x = slots_[s].xi_x[lane];
    entry.xi_y = slots_[s].xi_y[lane];
    entry.xi_z = slots_[s].xi_z[lane];
    return;
  }
}

template <typename Real>
void NeighbourList<Real>::make_row(std::uint32_t row, const Edit* edit, const Edit* end,
                                   const Records& records, Member& m) {
  const auto first = std::uint32_t(m.entries.size());
  const auto add = [&](std::uint32_t partner, float gap) {
    m.entries.push_back({gap, partner, false, 0, 0, 0});
  };
  if (has_moved_[row]) {  // all of it was looked up
    const std::size_t i = edit->partner;
    std::size_t finder = 0;
    while (i >= moved_.size() * (finder + 1) / members_.size()) ++finder;
    const Candidate* found = members_[finder].found.data() + found_[i].begin;
    for (std::uint32_t k = 0; k < found_[i].count; ++k) add(found[k].row, found[k].gap_m);
  } else {
    const std::uint32_t begin = slot_begin_[row / kLanes];
    for (std::uint32_t s = begin; s < begin + row_count_[row]; ++s) {
      const auto other = std::uint32_t(slots_[s].neighbour[row % kLanes]);
      if (!has_moved_[other]) add(other, gap_m(reference_[row], reference_[other]));
    }
    for (; edit != end; ++edit) {
      if (edit->partner != kNone) add(edit->partner, edit->gap_m);
    }
  }
  sort_by_gap(m.entries.data() + first, m.entries.data() + m.entries.size(), records);
  for (std::size_t e = first; e < m.entries.size(); ++e) keep_history(row, m.entries[e]);
  m.rows.push_back({row, first, std::uint32_t(m.entries.size()) - first});
}

template <typename Real>
void NeighbourList<Real>::make_rows(const Records& records, Member& m) {
  m.rows.clear();
  m.entries.clear();
  for (std::size_t i = 0; i < m.edits.size();) {
    std::size_t end = i + 1;
    while (end < m.edits.size() && m.edits[end].row == m.edits[i].row) ++end;
    make_row(m.edits[i].row, m.edits.data() + i, m.edits.data() + end, records, m);
    i = end;
  }
}

/// Groups whose new rows do not fit move to the end of the slots.
template <typename Real>
void NeighbourList<Real>::grow_groups() {
  for (const Member& m : members_) {
    for (const NewRow& r : m.rows) {
      const std::uint32_t group = r.row / kLanes;
      if (r.count <= slot_capacity_[group]) continue;
      const std::uint32_t from = slot_begin_[group], old_capacity = slot_capacity_[group];
      const auto to = std::uint32_t(slots_.size());
      slot_capacity_[group] = r.count + 1;
      slots_.resize(to + slot_capacity_[group]);
      touching_.resize(slots_.size());
      std::copy_n(slots_.begin() + from, old_capacity, slots_.begin() + to);
      std::copy_n(touching_.begin() + from, old_capacity, touching_.begin() + to);
      slot_begin_[group] = to;
      for (std::uint32_t s = to + old_capacity; s < slots_.size(); ++s) {
        for (std::uint32_t lane = 0; lane < kLanes; ++lane) clear_place(s, group * kLanes + lane);
      }
      wasted_slots_ += old_capacity;
    }
  }
}

/// Gives all groups places side by side again. Changes where things lie, nothing else.
template <typename Real>
void NeighbourList<Real>::pack_slots() {
  Slots packed;
  std::vector<std::uint16_t> packed_touching;
  packed.reserve(slots_.size());
  packed_touching.reserve(slots_.size());
  for (std::uint32_t group = 0; group < group_count_; ++group) {
    const std::uint32_t from = slot_begin_[group], end = from + slot_capacity_[group];
    slot_begin_[group] = std::uint32_t(packed.size());
    packed.insert(packed.end(), slots_.begin() + from, slots_.begin() + end);
    packed_touching.insert(packed_touching.end(), touching_.begin() + from,
                           touching_.begin() + end);
  }
  slot_begin_[group_count_] = std::uint32_t(packed.size());
  slots_.swap(packed);
  touching_.swap(packed_touching);
  wasted_slots_ = 0;
}

template <typename Real>
void NeighbourList<Real>::write_rows(const Member& m) {
  for (const NewRow& r : m.rows) {
    const std::uint32_t group = r.row / kLanes, lane = r.row % kLanes, begin = slot_begin_[group];
    for (std::uint32_t k = 0; k < r.count; ++k) {
      const Entry& e = m.entries[r.begin + k];
      EllSlot<Real>& slot = slots_[begin + k];
      slot.neighbour[lane] = std::int32_t(e.row);
      slot.xi_x[lane] = e.xi_x, slot.xi_y[lane] = e.xi_y, slot.xi_z[lane] = e.xi_z;
      const auto bit = std::uint16_t(1u << lane);
      touching_[begin + k] = std::uint16_t((touching_[begin + k] & ~bit) | (e.touching ? bit : 0));
    }
    for (std::uint32_t k = r.count; k < row_count_[r.row]; ++k) clear_place(begin + k, r.row);
    row_count_[r.row] = std::uint16_t(r.count);
    const std::uint32_t first = group * kLanes, last = std::min(first + kLanes, count_);
    slot_count_[group] = *std::max_element(row_count_.begin() + first, row_count_.begin() + last);
  }
}

template <typename Real>
std::size_t NeighbourList<Real>::update(const Records& records, ThreadTeam& team) {
  if (!find_moved(records, team)) return 0;
  renew_references(records);
  search_moved(records, team);
  team.run([&](int m) {
    collect_edits(m, team.size());
    make_rows(records, members_[std::size_t(m)]);
  });
  grow_groups();
  if (wasted_slots_ > slots_.size() / 8) pack_slots();
  team.run([&](int m) { write_rows(members_[std::size_t(m)]); });
  for (const std::uint32_t row : moved_) has_moved_[row] = 0;
  return moved_.size();
}

#define HOOF_INSTANTIATE(Real)                                                                \
  template double NeighbourList<Real>::displacement_m(const Record&, const Reference&) const; \
  template std::size_t NeighbourList<Real>::update(const Records&, ThreadTeam&);
HOOF_INSTANTIATE(float)
HOOF_INSTANTIATE(double)
#undef HOOF_INSTANTIATE

}  // namespace hoof::sim
