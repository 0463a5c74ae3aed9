// The SocketCAN interfaces to a firmware in another process.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "firmware/app/parameters.h"
#include "hal/socketcan/socketcan_bus.h"
#include "hil_bridge/foot_line.h"
#include "hil_bridge/service_client.h"

namespace hoof::bridge {

class RemoteLine final : public FootLine {
 public:
  /// @param interfaces "vcan0" for both buses, or "vcan0,vcan1"
  /// @throws std::runtime_error naming the interface and what to do
  explicit RemoteLine(const std::string& interfaces);

  std::string foot() const override { return "hoof-firmware on " + name_; }
  std::string advice() const override;
  bool one_interface() const override { return bus1_ == nullptr; }
  hal::SocketCanBus& bus(int index) override { return index == 1 && bus1_ ? *bus1_ : *bus0_; }
  void wait(std::int64_t longest_ns) override { bus0_->wait(longest_ns); }
  bool flush() override;

  /// Frames that the kernel lost on the way here; only known with the next frame.
  std::uint64_t dropped() const;

  /// Waits for a heartbeat with this program's protocol hash, and a moment longer for those of a
  /// second foot.
  /// @param stopped asked again and again; true ends the wait with an exception
  /// @throws std::runtime_error where none comes within the time, or one with another hash, or
  /// there are two feet
  void await_heartbeat(std::int64_t timeout_ns, const std::function<bool()>& stopped = {});

  /// True as soon as a heartbeat comes, with whatever protocol hash.
  bool hears_foot(std::int64_t longest_ns);

  /// Makes the foot's parameters these, in mode off, and reads them back.
  /// @return the names of those that were changed
  /// @throws std::runtime_error where the foot refuses, saying which and why
  std::vector<std::string> pass_parameters(const firmware::app::Parameters& parameters,
                                           std::int64_t timeout_ns);

 private:
  std::vector<std::string> pass_parameters(ServiceClient& client,
                                           const firmware::app::Parameters& parameters) const;

  std::string name_;
  std::unique_ptr<hal::SocketCanBus> bus0_;
  std::unique_ptr<hal::SocketCanBus> bus1_;  // null where one interface carries both
};

}  // namespace hoof::bridge
