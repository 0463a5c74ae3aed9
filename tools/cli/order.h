// One order to a foot on a CAN bus, as a supervisor gives it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "firmware/protocol/messages.h"
#include "hal/can_bus.h"
#include "hal/clock.h"

namespace hoof::tools {

struct OrderRequest {
  firmware::protocol::Order order = firmware::protocol::Order::kStop;
  double toe_rad = 0;
  double frequency_Hz = 0;
  std::uint8_t id = 1;
  std::int64_t timeout_ns = 2'000'000'000;
};

/// Gives the order once a heartbeat was heard, and waits until the foot has answered it.
/// @param bus connection to bus 0
/// @param idle lets time pass between two looks at the bus, at most a millisecond
/// @return the foot's mode by its next heartbeat, as the dictionary names it
/// @throws CannotFinish where nobody answers in time, or where the foot refuses: with its reason
std::string give_order(hal::CanBus& bus, const hal::Clock& clock, const OrderRequest& request,
                       const std::function<void()>& idle);

/// Sends the e-stop frame: torque off at once, whoever owns the foot.
/// @return the foot's mode by a heartbeat that came after it
/// @throws CannotFinish where no foot reports that it has stopped
std::string press_emergency_stop(hal::CanBus& bus, const hal::Clock& clock, std::int64_t timeout_ns,
                                 const std::function<void()>& idle);

}  // namespace hoof::tools
