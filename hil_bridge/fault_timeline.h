// The faults of a run: begun and ended on time, each counting what it really changed.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hil_bridge/effects/faulty_wires.h"
#include "hil_bridge/fault_spec.h"
#include "sim/effects/drive_effect.h"
#include "sim/multibody/rig.h"

namespace hoof::hal {
class SoftBoard;
}
namespace hoof::sim {
class Experiment;
}

namespace hoof::bridge {

class LockStep;

/// What became of one fault.
struct FaultOutcome {
  std::string name;
  std::string kind;
  std::string target;
  std::optional<double> began_s;
  std::optional<double> ended_s;
  std::uint64_t changed = 0;  // frames, samples, torques or ticks that were not as without it
};

class FaultTimeline {
 public:
  using Drives = std::array<bool, sim::kJointCount>;

  /// @param drives which of the rig's joints have one
  /// @throws sim::ConfigError for a target that this rig does not have or the kind cannot have
  FaultTimeline(const std::vector<FaultSpec>& faults, const Drives& drives);
  ~FaultTimeline();

  /// One more, also in the middle of a run; counts from the tick after.
  void add(const FaultSpec& fault);

  /// Through which the nodes have to be attached; once. The timeline must outlive its users.
  Wires& wires(Wires& inner);
  /// Once, before the first tick.
  /// @throws sim::ConfigError for a fault of the board where the firmware is not in this process
  void bind(LockStep& lock_step, sim::Experiment& experiment);
  /// After every tick: ends and begins what is due.
  void update(const TickRecord& record);

  bool any_active() const;
  /// True once each has begun and ended; never with one that has no end.
  bool all_over() const;
  /// When the first one began.
  std::optional<double> first_s() const;
  std::vector<FaultOutcome> outcomes() const;
  /// @throws std::runtime_error naming those that never began or changed nothing
  void require_changes() const;
  std::uint64_t lost_syncs() const { return wires_ ? wires_->lost_syncs() : 0; }

 private:
  struct Item;

  void connect(Item& item);
  void require_reach(const Item& item) const;
  hal::SoftBoard& board() const;
  void begin(Item& item, double now_s);
  void end(Item& item, double now_s);
  void restart(Item& item);
  void begin_due(double now_s, const TickRecord* record);

  Drives drives_;
  std::vector<std::unique_ptr<Item>> items_;
  std::unique_ptr<FaultyWires> wires_;
  LockStep* lock_step_ = nullptr;
  sim::Experiment* experiment_ = nullptr;
};

}  // namespace hoof::bridge
