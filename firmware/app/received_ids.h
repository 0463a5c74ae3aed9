// What the foot listens to on each bus, for the acceptance filters of a board.
#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/protocol/dictionary.h"

namespace hoof::firmware::app {

/// The one of them that must never be crowded out.
inline constexpr std::uint32_t kEmergencyStopId =
    protocol::spec(protocol::Message::kEmergencyStop).id;

/// Calls visit(identifier) for every frame that the dictionary addresses to the foot on bus 0 or 1,
/// and for the e-stop's on either: the loop obeys it wherever it comes from.
template <typename Visit>
constexpr void for_each_received_id(std::size_t bus_index, Visit&& visit) {
  const protocol::BusMask bus = bus_index == 0 ? protocol::kBus0 : protocol::kBus1;
  for (const protocol::MessageSpec& message : protocol::kMessages) {
    const bool here = (message.buses & bus) != 0 || message.id == kEmergencyStopId;
    const bool for_us = message.receiver == protocol::Node::kFoot && here;
    if (for_us) visit(message.id);
  }
}

}  // namespace hoof::firmware::app
