// The operator's side of the bus: gives orders, watches heartbeat and telemetry. Knows the firmware
// only through its frames.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "firmware/protocol/messages.h"
#include "hal/can_bus.h"

namespace hoof::bridge {

class Supervisor {
 public:
  /// @param bus connection to bus 0; must outlive the supervisor
  /// @param id of this supervisor, 1 to 255
  explicit Supervisor(hal::CanBus& bus, std::uint8_t id = 1) : bus_(bus), id_(id) {}

  /// Replaces the order in force: it is sent, and sent again until it is acknowledged. Where the
  /// foot does not know this supervisor (any more), it connects first.
  void order(firmware::protocol::Order order, double toe_angle_rad = 0, double frequency_Hz = 0);

  /// Takes all waiting frames and sends what is due. Call it at least once per millisecond.
  void poll(std::int64_t now_ns);

  /// True once the order in force was accepted.
  bool accepted() const { return accepted_; }
  /// The last heartbeat, if one came and its protocol hash was ours.
  const std::optional<firmware::protocol::Heartbeat>& heartbeat() const { return heartbeat_; }
  /// The toes as last told by the firmware.
  const std::optional<firmware::protocol::FootToe>& toe() const { return toe_; }

  /// The mode as last told, by heartbeat or by the answer to an order.
  const std::optional<firmware::protocol::Mode>& mode() const { return mode_; }

  /// Why the order in force will not be obeyed, in words: it was refused, or the firmware speaks
  /// another dictionary; else empty.
  const std::string& refusal() const { return refusal_; }
  /// Why a test cannot go on: the refusal, or else the faults in the last heartbeat; else empty.
  const std::string& trouble() const { return refusal_.empty() ? faults_ : refusal_; }

 private:
  void take(const hal::CanFrame& frame);
  void take_acknowledge(const firmware::protocol::OrderAcknowledge& answer);
  void take_heartbeat(const firmware::protocol::Heartbeat& heartbeat);
  void take_connection(const firmware::protocol::OrderAcknowledge& answer);
  void send(std::int64_t now_ns);
  void send_connect(std::int64_t now_ns);

  hal::CanBus& bus_;
  std::uint8_t id_;
  std::optional<firmware::protocol::SupervisorOrder> order_;
  std::uint8_t counter_ = 0;
  bool accepted_ = false;
  bool sent_ = false;      // the order in force, at least once
  bool awaiting_ = false;  // the answer to the frame sent last
  bool connected_ = false;
  bool connecting_ = false;  // the frame sent last was a connect
  std::uint8_t sent_counter_ = 0;
  std::uint8_t connect_counter_ = 0;
  std::int64_t sent_ns_ = 0;
  std::optional<firmware::protocol::Heartbeat> heartbeat_;
  std::optional<firmware::protocol::FootToe> toe_;
  std::optional<firmware::protocol::Mode> mode_;
  std::string refusal_;
  std::string faults_;
};

}  // namespace hoof::bridge
