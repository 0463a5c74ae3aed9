#include "firmware/app/ownership.h"

#include "firmware/protocol/protocol_hash.h"

namespace hoof::firmware::app {

using control::Mode;

namespace {

bool is_idle(Mode mode) {
  return mode == Mode::kOff || mode == Mode::kEmergencyOff || mode == Mode::kFault;
}

}  // namespace

bool Ownership::connect(std::uint8_t supervisor_id, std::uint32_t protocol_hash,
                        std::int64_t now_ns) {
  if (supervisor_id == 0) return false;
  Place* const known = find(supervisor_id);
  if (protocol_hash != protocol::kProtocolHash) {
    if (known != nullptr) *known = {};
    return false;
  }
  Place& place = known != nullptr ? *known : place_for_new(now_ns);
  place = {supervisor_id, now_ns};
  return true;
}

bool Ownership::connected(std::uint8_t supervisor_id, std::int64_t now_ns) const {
  for (const Place& place : places_) {
    if (place.id == supervisor_id && fresh(place, now_ns)) return true;
  }
  return false;
}

Ownership::Standing Ownership::judge(std::uint8_t supervisor_id, std::uint8_t counter, Mode mode,
                                     std::int64_t now_ns) const {
  if (!connected(supervisor_id, now_ns)) return Standing::kNotConnected;
  const bool lapsed = is_idle(mode) && now_ns - owner_heard_ns_ > kLease_ns;
  const bool may = owner_id_ == 0 || owner_id_ == supervisor_id || lapsed;
  if (!may) return Standing::kNotOwner;
  return counter == expected_counter_ ? Standing::kGranted : Standing::kBadCounter;
}

void Ownership::hear(std::uint8_t supervisor_id, std::int64_t now_ns) {
  Place* const place = find(supervisor_id);
  if (place != nullptr && fresh(*place, now_ns)) place->heard_ns = now_ns;
}

void Ownership::own(std::uint8_t supervisor_id, std::int64_t now_ns) {
  owner_id_ = supervisor_id;
  owner_heard_ns_ = now_ns;
}

Ownership::Place* Ownership::find(std::uint8_t supervisor_id) {
  for (Place& place : places_) {
    if (place.id == supervisor_id) return &place;
  }
  return nullptr;
}

/// A free place, or that of whoever has been silent for longest; the owner keeps its own.
Ownership::Place& Ownership::place_for_new(std::int64_t now_ns) {
  Place* oldest = nullptr;
  for (Place& place : places_) {
    if (!fresh(place, now_ns)) return place;
    if (place.id == owner_id_) continue;
    if (oldest == nullptr || place.heard_ns < oldest->heard_ns) oldest = &place;
  }
  return *oldest;
}

}  // namespace hoof::firmware::app
