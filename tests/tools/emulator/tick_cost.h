// What the image's control ticks cost: instructions, and cycles by the rule of
// tests/firmware/cost/cycle_rule.h.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tests/firmware/cost/flash_accelerator.h"
#include "tests/firmware/cost/thumb_timing.h"
#include "tools/emulator/board.h"

namespace hoof::test {

/// The folders of the firmware, by the namespace of the function that runs; what the compiler
/// merged into another function counts there.
inline constexpr std::array kPartNames = {"app",      "control", "trajectory", "safety",
                                          "protocol", "board",   "library"};
inline constexpr std::size_t kParts = kPartNames.size();

/// What a tick does, by the function on the chain of calls that was entered last; kStageFunctions
/// in tick_cost.cpp names them. What the compiler merged into another function counts there.
enum class Stage : std::uint8_t {
  kReceive,    // frames taken from the buses, checked and decoded
  kControl,    // modes, set points, kinematics, what the leg feels
  kPlan,       // of control: planning of trajectories
  kGate,       // replies inspected, wishes judged
  kSend,       // commands encoded and handed to the bus
  kTelemetry,  // what is told: record, frame, heartbeat, fault log's trace
  kTick,       // the rest of the loop's tick
  kInterrupt,  // handlers
  kPoll,       // the rest: the main loop's polls and its way to sleep
};
inline constexpr std::array kStageNames = {"receive",   "control", "plan",      "gate", "send",
                                           "telemetry", "tick",    "interrupt", "poll"};
inline constexpr std::size_t kStages = kStageNames.size();

/// All that runs from one begin of the loop's tick to the next one: the tick, its frames, the
/// interrupts, and the polls that find nothing to do.
struct TickCost {
  std::uint64_t instructions = 0;
  std::uint64_t cycles = 0;
  std::array<std::uint64_t, kParts> part_instructions{};
  std::array<std::uint64_t, kStages> stage_instructions{};
  bool plans = false;  // the trajectory generator's planner worked in it
};

/// Watches a board that runs. The flash's accelerator keeps its lines from tick to tick, as there.
/// Loads of constants wait for the flash only where their address is relative to the program
/// counter; entering and leaving an exception costs 12 cycles each ([TRM], interrupt latency).
class TickCostCounter {
 public:
  explicit TickCostCounter(tools::emulator::Board& board);

  const std::vector<TickCost>& ticks() const { return ticks_; }

 private:
  struct Place {
    tests::cost::Timing timing;
    std::uint8_t part = 0;
    bool tick_begins = false;
    bool plans = false;
    bool handler = false;                  // the first instruction of an exception's handler
    std::optional<Stage> stage;            // the first instruction of a function that is one
    std::optional<std::uint32_t> literal;  // address that it loads from
  };

  /// A stage under way.
  struct Open {
    Stage stage;
    std::uint32_t back = 0;   // the instruction after it
    std::uint32_t stack = 0;  // pointer when it began; at its end it is there again, or above
  };

  void execute(std::uint32_t address);
  void follow(std::uint32_t address, const Place& place, bool jumped);
  const Place& place_at(std::uint32_t address);
  Place examine(std::uint32_t address);

  tools::emulator::Board& board_;
  std::vector<std::uint32_t> handlers_;
  std::vector<std::optional<Place>> places_;
  tests::cost::FlashAccelerator flash_;
  std::uint32_t expected_ = 0;
  std::uint32_t late_registers_ = 0;
  std::vector<Open> open_;
  bool begun_ = false;
  TickCost now_;
  std::vector<TickCost> ticks_;
};

}  // namespace hoof::test
