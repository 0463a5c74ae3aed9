// Whose word counts: who is connected, who owns the foot, which counter the next word must carry.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/control/types.h"
#include "firmware/protocol/messages.h"

namespace hoof::firmware::app {

/// A supervisor connects first, telling the hash of its dictionary; another one than ours is
/// refused, since its bits would mean something else here. A connection lapses after a second
/// without a word. One of the connected owns the foot from its first accepted order until it
/// releases it, or until the foot is idle and the owner has been silent for a second. Every word
/// that changes something must carry the expected counter, told in each answer, so that a repeated,
/// replayed or reordered frame does nothing.
class Ownership {
 public:
  static constexpr std::int64_t kLease_ns = 1'000'000'000;
  static constexpr std::size_t kPlaces = 4;

  enum class Standing : std::uint8_t { kGranted = 0, kNotConnected, kNotOwner, kBadCounter };

  /// @return false for another dictionary, which also ends an earlier connection of that
  /// supervisor, and for number 0
  bool connect(std::uint8_t supervisor_id, std::uint32_t protocol_hash, std::int64_t now_ns);

  bool connected(std::uint8_t supervisor_id, std::int64_t now_ns) const;

  /// Whether a word of this supervisor that changes something may be carried out.
  Standing judge(std::uint8_t supervisor_id, std::uint8_t counter, control::Mode mode,
                 std::int64_t now_ns) const;

  /// A word with the right counter was heard: the next one must carry the next.
  void count() { ++expected_counter_; }
  /// The supervisor spoke, and its connection lasts.
  void hear(std::uint8_t supervisor_id, std::int64_t now_ns);
  /// An accepted word makes its supervisor the owner.
  void own(std::uint8_t supervisor_id, std::int64_t now_ns);
  void release() { owner_id_ = 0; }

  std::uint8_t owner_id() const { return owner_id_; }  // 0: nobody
  std::uint8_t expected_counter() const { return expected_counter_; }

 private:
  struct Place {
    std::uint8_t id = 0;  // 0: free
    std::int64_t heard_ns = 0;
  };

  Place* find(std::uint8_t supervisor_id);
  Place& place_for_new(std::int64_t now_ns);
  bool fresh(const Place& place, std::int64_t now_ns) const {
    return place.id != 0 && now_ns - place.heard_ns <= kLease_ns;
  }

  std::array<Place, kPlaces> places_{};
  std::uint8_t owner_id_ = 0;
  std::int64_t owner_heard_ns_ = 0;  // last accepted word of the owner
  std::uint8_t expected_counter_ = 0;
};

}  // namespace hoof::firmware::app
