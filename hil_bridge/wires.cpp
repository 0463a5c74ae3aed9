#include "hil_bridge/wires.h"

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <vector>

#include "hal/in_process/in_process_bus.h"
#include "hal/monotonic_clock.h"
#include "hal/socketcan/socketcan_bus.h"
#include "sim/multibody/rig.h"

namespace hoof::bridge {
namespace {

class InProcessWires final : public Wires {
 public:
  explicit InProcessWires(Observer observer) : observer_(std::move(observer)) {
    for (int bus = 0; bus < kBusCount; ++bus) {
      hal::InProcessBusSettings settings;
      settings.name = "can" + std::to_string(bus);
      // The frames of all buses must reach the observer in the order of time, so they wait here
      // until both wires have come equally far.
      buses_[bus] =
          std::make_unique<hal::InProcessBus>(settings, [this, bus](const hal::WireRecord& record) {
            seen_.push_back({bus, record.frame});
          });
    }
  }

  hal::CanBus& attach(int bus, const std::string& node) override {
    return buses_[bus]->attach(node);
  }

  void advance_to(std::int64_t t_ns) override {
    for (const auto& bus : buses_) bus->advance_to(t_ns);
    if (seen_.empty()) return;
    if (seen_.size() > 1) {
      std::stable_sort(seen_.begin(), seen_.end(), [](const Seen& a, const Seen& b) {
        return a.frame.stamp_ns < b.frame.stamp_ns;
      });
    }
    frames_ += seen_.size();
    if (observer_) {
      for (const Seen& s : seen_) observer_(s.bus, s.frame);
    }
    seen_.clear();
  }

  double load_ratio(int bus) const override { return buses_[bus]->mean_load_ratio(); }
  double worst_load_ratio(int bus) const override { return buses_[bus]->load().worst_10ms_ratio(); }
  std::uint64_t frames() const override { return frames_; }

 private:
  struct Seen {
    int bus;
    hal::CanFrame frame;
  };

  Observer observer_;
  std::array<std::unique_ptr<hal::InProcessBus>, kBusCount> buses_;
  std::vector<Seen> seen_;
  std::uint64_t frames_ = 0;
};

class SocketCanWires final : public Wires {
 public:
  SocketCanWires(const std::string& interfaces, Observer observer)
      : observer_(std::move(observer)) {
    const std::size_t comma = interfaces.find(',');
    names_[0] = interfaces.substr(0, comma);
    names_[1] = comma == std::string::npos ? names_[0] : interfaces.substr(comma + 1);
    // One listener per interface: a frame on a shared interface is logged once.
    for (int bus = 0; bus < kBusCount; ++bus) {
      if (bus == 0 || names_[bus] != names_[0]) listeners_[bus] = open(names_[bus]);
    }
  }

  hal::CanBus& attach(int bus, const std::string& node) override {
    hal::SocketCanSettings settings;
    settings.interface = names_[bus];
    settings.filters = wanted_by(node, bus);
    settings.stamps = false;  // the listener's are the recording's
    nodes_.push_back(std::make_unique<hal::SocketCanBus>(settings));
    return *nodes_.back();
  }

  void advance_to(std::int64_t t_ns) override {
    // The kernel's stamps, on the run's own scale.
    if (!origin_ns_) origin_ns_ = hal::MonotonicClock().now_ns() - t_ns;
    hal::CanFrame frame;
    for (int bus = 0; bus < kBusCount; ++bus) {
      while (listeners_[bus] && listeners_[bus]->receive(frame)) {
        ++frames_;
        frame.stamp_ns = std::max<std::int64_t>(0, frame.stamp_ns - *origin_ns_);
        if (observer_) observer_(bus, frame);
      }
    }
  }

  double load_ratio(int) const override { return -1; }
  double worst_load_ratio(int) const override { return -1; }
  std::uint64_t frames() const override { return frames_; }
  std::uint64_t dropped() const override {
    std::uint64_t sum = 0;
    for (const auto& listener : listeners_) sum += listener ? listener->status().dropped : 0;
    for (const auto& node : nodes_) sum += node->status().dropped;
    return sum;
  }
  bool one_wire() const override { return names_[0] == names_[1]; }

 private:
  /// What a node acts upon. The kernel copies every frame to every socket that wants it, and that
  /// is most of what a frame costs. Empty: everything.
  std::vector<hal::CanFilter> wanted_by(const std::string& node, int bus) const {
    using namespace firmware::protocol;
    const auto only = [](std::initializer_list<std::uint32_t> ids) {
      std::vector<hal::CanFilter> filters;
      for (const std::uint32_t id : ids) filters.push_back({.id = id, .mask = 0x7FF});
      return filters;
    };
    const std::uint32_t sync = spec(Message::kSync).id;
    if (node == kSyncNode) return only({sync});  // others', which it does not read
    if (node == kFootNode && bus == 1 && one_wire()) return only({sync});  // bus 0 brings it all
    if (node == kSupervisorNode) {
      return only({spec(Message::kHeartbeat).id, spec(Message::kOrderAcknowledge).id,
                   spec(Message::kFootToe).id});
    }
    for (const Drive drive : kDrives) {
      if (node == sim::joint_name(sim::Joint(int(drive)))) return only({command_spec(drive).id});
    }
    return {};
  }

  static std::unique_ptr<hal::SocketCanBus> open(const std::string& name) {
    hal::SocketCanSettings settings;
    settings.interface = name;
    return std::make_unique<hal::SocketCanBus>(settings);
  }

  Observer observer_;
  std::array<std::string, kBusCount> names_;
  std::array<std::unique_ptr<hal::SocketCanBus>, kBusCount> listeners_;
  std::vector<std::unique_ptr<hal::SocketCanBus>> nodes_;
  std::optional<std::int64_t> origin_ns_;  // of the run, on the clock of the stamps
  std::uint64_t frames_ = 0;
};

}  // namespace

std::unique_ptr<Wires> in_process_wires(Wires::Observer observer) {
  return std::make_unique<InProcessWires>(std::move(observer));
}

std::unique_ptr<Wires> socketcan_wires(const std::string& interfaces, Wires::Observer observer) {
  return std::make_unique<SocketCanWires>(interfaces, std::move(observer));
}

}  // namespace hoof::bridge
