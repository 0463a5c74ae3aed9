// The buses of a run: in one process with simulated time, or on SocketCAN interfaces.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "firmware/protocol/dictionary.h"
#include "hal/can_bus.h"

namespace hoof::bridge {

inline constexpr int kBusCount = int(firmware::protocol::kBusCount);

/// Names of nodes; those of the drives are their joints'.
inline constexpr char kSyncNode[] = "sync";
inline constexpr char kFootNode[] = "foot";
inline constexpr char kSupervisorNode[] = "supervisor";

class Wires {
 public:
  /// Called for every frame on any bus, in order; the frame's stamp counts from the run's time 0.
  using Observer = std::function<void(int bus, const hal::CanFrame&)>;

  virtual ~Wires() = default;

  /// A new node's connection to one bus. Lives as long as the wires.
  virtual hal::CanBus& attach(int bus, const std::string& node) = 0;

  /// Simulated time has come to t_ns: what has arrived until then can be received.
  virtual void advance_to(std::int64_t t_ns) = 0;

  /// Share of the time for which bus i was busy; negative where the wire cannot tell.
  virtual double load_ratio(int bus) const = 0;
  /// The same in the worst 10 ms.
  virtual double worst_load_ratio(int bus) const = 0;
  virtual std::uint64_t frames() const = 0;
  /// Frames that the kernel lost on the way to the nodes here, as far as they have noticed.
  virtual std::uint64_t dropped() const { return 0; }
  /// True where both logical buses share one wire, so that a frame for both goes out once.
  virtual bool one_wire() const { return false; }
};

/// Buses at 1 Mbit/s in this process: arbitration and frame times as on a real wire.
std::unique_ptr<Wires> in_process_wires(Wires::Observer observer);

/// Both logical buses on SocketCAN, for runs in real time: "vcan0" for both, or "can0,can1". Stamps
/// are the kernel's, counted from the time 0 of the run.
/// @throws std::runtime_error naming the interface and what to do
std::unique_ptr<Wires> socketcan_wires(const std::string& interfaces, Wires::Observer observer);

}  // namespace hoof::bridge
