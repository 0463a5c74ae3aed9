#include "tools/emulator/can_wire.h"

#include <algorithm>
#include <utility>

#include "hal/in_process/in_process_bus.h"

namespace hoof::tools::emulator {
namespace {

class SilentWire final : public CanWire {
 public:
  bool offer(const hal::CanFrame& frame) override {
    sent_.push_back(frame);
    return true;
  }
  bool withdraw(const hal::CanFrame&) override { return false; }
  bool take(hal::CanFrame&) override { return false; }
  std::vector<hal::CanFrame> take_sent() override { return std::exchange(sent_, {}); }
  hal::BusStatus status() const override { return {}; }
  void join_again() override {}

 private:
  std::vector<hal::CanFrame> sent_;
};

class BusWire final : public CanWire {
 public:
  explicit BusWire(hal::CanBus& bus)
      : bus_(bus), in_process_(dynamic_cast<hal::InProcessPort*>(&bus)) {
    if (in_process_ != nullptr) {
      in_process_->on_sent([this](const hal::CanFrame& frame) { sent_.push_back(frame); });
    }
    counted_ = bus_.status().sent;
    mailboxes_ = bus_.status().free;
  }
  ~BusWire() override {
    if (in_process_ != nullptr) in_process_->on_sent({});
  }

  bool offer(const hal::CanFrame& frame) override {
    if (bus_.send(frame) != hal::SendResult::kQueued) return false;
    if (in_process_ != nullptr) return true;
    offered_.push_back(frame);
    tells_free_ = tells_free_ || bus_.status().free < mailboxes_;
    return true;
  }

  bool withdraw(const hal::CanFrame& frame) override {
    const int free_before = bus_.status().free;
    bus_.withdraw(frame.id);
    if (bus_.status().free <= free_before) return false;
    std::erase(offered_, frame);
    return true;
  }

  bool take(hal::CanFrame& frame) override { return bus_.receive(frame); }

  std::vector<hal::CanFrame> take_sent() override {
    if (in_process_ != nullptr) return std::exchange(sent_, {});
    const hal::BusStatus now = bus_.status();
    // Where nothing waits any more everything has gone out, or was lost on purpose on the way.
    const auto count = tells_free_ && now.free == mailboxes_
                           ? offered_.size()
                           : std::min<std::size_t>(now.sent - counted_, offered_.size());
    counted_ = now.sent;
    const auto end = offered_.begin() + std::ptrdiff_t(count);
    std::vector<hal::CanFrame> sent(offered_.begin(), end);
    offered_.erase(offered_.begin(), end);
    return sent;
  }

  hal::BusStatus status() const override { return bus_.status(); }

  void join_again() override {
    if (in_process_ != nullptr) in_process_->set_bus_off(false);
  }

 private:
  hal::CanBus& bus_;
  hal::InProcessPort* in_process_;
  std::vector<hal::CanFrame> sent_;     // in process: as told
  std::vector<hal::CanFrame> offered_;  // else: not yet counted as sent
  std::uint64_t counted_ = 0;
  std::uint8_t mailboxes_ = 0;
  bool tells_free_ = false;  // SocketCAN cannot
};

}  // namespace

std::unique_ptr<CanWire> silent_wire() {
  return std::make_unique<SilentWire>();
}

std::unique_ptr<CanWire> wire_of(hal::CanBus& bus) {
  return std::make_unique<BusWire>(bus);
}

}  // namespace hoof::tools::emulator
