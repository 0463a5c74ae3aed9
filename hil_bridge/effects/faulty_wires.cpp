#include "hil_bridge/effects/faulty_wires.h"

#include <algorithm>
#include <utility>

namespace hoof::bridge {

class FaultyWires::Port final : public hal::CanBus {
 public:
  Port(FaultyWires& wires, hal::CanBus& inner, int number, int bus, std::string node)
      : wires_(wires),
        inner_(inner),
        number_(number),
        bus_(bus),
        node_(std::move(node)),
        master_(node_ == kSyncNode) {}

  void add(FrameEffect& effect) {
    if (effect.settings().target.has_node(node_, bus_)) effects_.push_back(&effect);
  }

  hal::SendResult send(const hal::CanFrame& frame) override {
    for (FrameEffect* effect : effects_) {
      if (!effect->mutes()) continue;
      effect->count();
      const bool told = effect->bus_off() && !master_;
      return told ? hal::SendResult::kBusOff : hal::SendResult::kQueued;
    }
    const bool touched =
        std::any_of(effects_.begin(), effects_.end(),
                    [](const FrameEffect* effect) { return effect->concerns_frames(); });
    if (!touched) return put(frame);
    std::vector<Passing> frames{{frame, 0}};
    for (FrameEffect* effect : effects_) {
      if (effect->concerns_frames()) effect->pass(number_, frames);
    }
    hal::SendResult result = hal::SendResult::kQueued;
    for (const Passing& passing : frames) {
      if (passing.hold_ns > 0) {
        held_.push_back({passing.frame, wires_.now_ns_ + passing.hold_ns});
      } else if (&passing == &frames.front()) {
        result = put(passing.frame);
      } else {
        put(passing.frame);
      }
    }
    return result;
  }

  void withdraw(std::uint32_t id) override { inner_.withdraw(id); }

  bool receive(hal::CanFrame& frame) override {
    while (inner_.receive(frame)) {
      FrameEffect* deaf = nullptr;
      for (FrameEffect* effect : effects_) {
        if (effect->deafens()) deaf = effect;
      }
      if (deaf == nullptr) return true;
      deaf->count();
    }
    return false;
  }

  hal::BusStatus status() const override {
    hal::BusStatus status = inner_.status();
    for (const FrameEffect* effect : effects_) status.bus_off |= effect->bus_off();
    return status;
  }

  /// Held frames whose time has come, the earlier ones first.
  void release(std::int64_t now_ns) {
    std::stable_sort(held_.begin(), held_.end(),
                     [](const Passing& a, const Passing& b) { return a.hold_ns < b.hold_ns; });
    std::size_t due = 0;
    while (due < held_.size() && held_[due].hold_ns <= now_ns) put(held_[due++].frame);
    held_.erase(held_.begin(), held_.begin() + std::ptrdiff_t(due));
  }

 private:
  /// The master of a lock-step run cannot wait: what the wire does not take is lost, and counted.
  hal::SendResult put(const hal::CanFrame& frame) {
    const hal::SendResult result = inner_.send(frame);
    if (!master_ || result == hal::SendResult::kQueued) return result;
    ++wires_.lost_syncs_;
    return hal::SendResult::kQueued;
  }

  FaultyWires& wires_;
  hal::CanBus& inner_;
  int number_;
  int bus_;
  std::string node_;
  bool master_;
  std::vector<FrameEffect*> effects_;
  std::vector<Passing> held_;  // hold_ns: until when
};

FaultyWires::FaultyWires(Wires& inner) : inner_(inner) {}

FaultyWires::~FaultyWires() = default;

void FaultyWires::add(FrameEffect& effect) {
  effects_.push_back(&effect);
  for (const auto& port : ports_) port->add(effect);
}

void FaultyWires::add(Flood& flood) {
  flood.port = &inner_.attach(flood.bus, "flood");
  floods_.push_back(&flood);
}

hal::CanBus& FaultyWires::attach(int bus, const std::string& node) {
  ports_.push_back(
      std::make_unique<Port>(*this, inner_.attach(bus, node), int(ports_.size()), bus, node));
  for (FrameEffect* effect : effects_) ports_.back()->add(*effect);
  return *ports_.back();
}

void FaultyWires::advance_to(std::int64_t t_ns) {
  for (const auto& port : ports_) port->release(now_ns_);
  for (Flood* flood : floods_) {
    if (!flood->active || now_ns_ < flood->next_ns) continue;
    while (flood->port->send(flood->frame) == hal::SendResult::kQueued) {
      ++flood->sent;
      if (flood->period_ns == 0) continue;
      flood->next_ns = now_ns_ + flood->period_ns;
      break;
    }
    // Nobody listens at this node: its queue must not fill up.
    hal::CanFrame heard;
    while (flood->port->receive(heard)) {
    }
  }
  now_ns_ = t_ns;
  inner_.advance_to(t_ns);
}

}  // namespace hoof::bridge
