// Parameters, calibration and fault log of a foot, as a tool on the bus sees them.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <vector>

#include "firmware/app/fault_record.h"
#include "firmware/protocol/messages.h"
#include "hal/can_bus.h"
#include "hal/clock.h"

namespace hoof::bridge {

/// The foot refused, or nobody answered: what() says what and why.
class ServiceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Connects by itself, repeats what is not answered, and keeps to the counter. Every call blocks
/// until it is done, calling `idle` while it waits.
class ServiceClient {
 public:
  /// @param bus connection to bus 0, `clock` and `idle`: must outlive the client
  /// @param id of this supervisor, 1 to 255
  /// @param timeout_ns longest wait for one answer
  ServiceClient(hal::CanBus& bus, const hal::Clock& clock, std::function<void()> idle,
                std::uint8_t id, std::int64_t timeout_ns);

  /// Connects; also checks that the foot's table of parameters is the one of this program.
  /// @throws ServiceError where the dictionary or the table differ, or nobody answers
  void connect();

  float read_parameter(std::uint8_t index);
  void write_parameter(std::uint8_t index, float value);
  /// @return number of the stored set, counted from the first store
  std::uint32_t store_parameters();
  void default_parameters();
  /// @param joint 0 toe, 1 hip, 2 knee @return the new zero, rad
  float calibrate_zero(std::uint8_t joint);

  /// One part of a firmware update, once: where the result is kBadCounter or kNotConnected the foot
  /// may have done it or not, and its status tells. Sent again after `repeat_ns` without an answer.
  firmware::protocol::ServiceResult write_update(firmware::protocol::UpdateObject object,
                                                 std::uint32_t value, std::int64_t repeat_ns);
  /// Connects again, to a foot that has started anew, say; of any table of parameters.
  void greet() { say_hello(); }
  void wait_until(std::int64_t time_ns);
  std::int64_t now_ns() const { return clock_.now_ns(); }

  std::uint32_t status(firmware::protocol::Status what);
  /// Nothing where the foot keeps no storage.
  std::optional<std::uint32_t> stored_status(firmware::protocol::Status what);
  /// One record of the fault log; nothing where it is cut or damaged.
  std::optional<firmware::app::FaultRecord> read_fault(std::uint8_t slot);
  void erase_fault_log();

 private:
  using Service = firmware::protocol::Service;
  using Answer = firmware::protocol::ServiceAnswer;

  Answer request(Service service, std::uint8_t index = 0, std::uint16_t offset = 0);
  Answer change(Service service, std::uint8_t index = 0, std::uint32_t value = 0);
  hal::CanFrame frame(Service service, std::uint8_t index, std::uint16_t offset,
                      std::uint32_t value, std::uint8_t counter) const;
  Answer exchange(const hal::CanFrame& frame, Service service, std::uint8_t index,
                  std::uint8_t counter, std::int64_t repeat_ns);
  void say_hello();
  template <typename Match>
  bool listen(std::int64_t until_ns, const Match& match);
  void send(const hal::CanFrame& frame);

  hal::CanBus& bus_;
  const hal::Clock& clock_;
  std::function<void()> idle_;
  std::uint8_t id_;
  std::int64_t timeout_ns_;
  std::uint8_t tag_ = 0;      // of requests that change nothing
  std::uint8_t counter_ = 0;  // expected of the next word that does
};

}  // namespace hoof::bridge
