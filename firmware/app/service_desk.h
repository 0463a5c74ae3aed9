// Parameters, calibration, fault log and firmware update over the bus.
#pragma once

#include <cstdint>

#include "firmware/app/inbox.h"
#include "firmware/app/ownership.h"
#include "firmware/app/parameters.h"
#include "firmware/app/storage.h"
#include "firmware/app/update_desk.h"
#include "firmware/protocol/messages.h"
#include "hal/board.h"

namespace hoof::firmware::app {

/// Any connected supervisor may read. What changes something needs the owner's standing and the
/// expected counter, as an order does, and mode off: no drive is under torque then, and an erase,
/// which stalls the core, keeps nobody waiting.
class ServiceDesk {
 public:
  /// @param storage null on a board that keeps nothing
  /// @param update null on a board that cannot be updated
  ServiceDesk(Parameters& parameters, Storage* storage, Ownership& ownership, const Inbox& inbox,
              hal::ResetCause reset_cause, UpdateDesk* update = nullptr)
      : parameters_(parameters),
        storage_(storage),
        ownership_(ownership),
        inbox_(inbox),
        reset_cause_(reset_cause),
        update_(update) {}

  protocol::ServiceAnswer handle(const protocol::ServiceRequest& request, control::Mode mode,
                                 std::int64_t now_ns);
  protocol::ServiceAnswer handle(const protocol::ParameterWrite& write, control::Mode mode,
                                 std::int64_t now_ns);

  /// Whether a parameter has changed since the last call.
  bool take_changed();

 private:
  /// What a service says: `value` stands for something where it is done.
  struct Outcome {
    protocol::ServiceResult result;
    std::uint32_t value = 0;
  };

  Outcome admit(std::uint8_t supervisor_id, std::uint8_t counter, control::Mode mode,
                std::int64_t now_ns);
  Outcome serve(const protocol::ServiceRequest& request, control::Mode mode, std::int64_t now_ns);
  Outcome change(const protocol::ServiceRequest& request, control::Mode mode, std::int64_t now_ns);
  Outcome read_parameter(std::uint8_t index);
  Outcome write_parameter(std::uint8_t index, std::uint32_t bits);
  Outcome write_update(std::uint8_t index, std::uint32_t value);
  Outcome store(control::Mode mode);
  Outcome calibrate(std::uint8_t joint, std::int64_t now_ns);
  Outcome read_status(std::uint8_t index) const;
  Outcome read_fault_log(std::uint8_t slot, std::uint16_t word) const;
  Outcome erase_fault_log(control::Mode mode);

  Parameters& parameters_;
  Storage* storage_;
  Ownership& ownership_;
  const Inbox& inbox_;
  hal::ResetCause reset_cause_;
  UpdateDesk* update_;
  bool changed_ = false;
};

}  // namespace hoof::firmware::app
