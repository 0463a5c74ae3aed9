#include "tools/faults/matrix_cell.h"

#include <algorithm>

#include "firmware/safety/limits.h"
#include "hil_bridge/reaction.h"

namespace hoof::tools {
namespace {

using firmware::control::Mode;
using firmware::protocol::Order;

constexpr double kLinger_s = 0.15;    // watched on behind the fault: what is slow to be noticed
constexpr double kStopLimit_s = 2.5;  // a damped stop lasts 2 s at most
constexpr double kResetLimit_s = 0.5;
constexpr double kMove_s = 0.1;          // of moving again without a fault
constexpr double kUndisturbed_s = 0.75;  // the longest fault of the matrix, and the lingering
constexpr double kTick_s = 1e-3;

/// The foot stands in the mode; from here on, the fault.
class CellRun {
 public:
  CellRun(MatrixFoot& foot, const MatrixCase& c, const JointTorques& undisturbed)
      : foot_(foot), case_(c), undisturbed_(undisturbed) {}

  Measured go() {
    before_ = foot_.lock_step().firmware().faults();
    began_s_ = foot_.now_s();
    bridge::FaultSpec fault = case_.fault;
    fault.at_s = began_s_;
    foot_.faults().add(fault);
    watch(*fault.for_s + kLinger_s, [] { return false; });
    watch(kStopLimit_s, [this] { return foot_.mode() != Mode::kDampedStop; });
    measured_.end_mode = int(foot_.mode());
    if (at_rest(foot_.mode())) recover();
    measured_.began_s = began_s_;
    measured_.changed = foot_.faults().outcomes().back().changed;
    return measured_;
  }

 private:
  template <typename Until>
  bool watch(double limit_s, const Until& until) {
    const double from_s = foot_.now_s();
    while (!until()) {
      if (foot_.now_s() - from_s >= limit_s - 0.5 * kTick_s) return false;
      foot_.tick();
      note();
    }
    return true;
  }

  void note() {
    const double since_s = foot_.now_s() - began_s_;
    const std::uint32_t now = foot_.lock_step().firmware().faults();
    measured_.faults |= now & ~before_;
    if (measured_.faults != 0 && measured_.trip_s < 0) measured_.trip_s = since_s;
    if (recovering_) return;
    note_torque();
    if (!bridge::all_passive(foot_.plant())) {
      measured_.safe_s = -1;
    } else if (measured_.safe_s < 0) {
      // Seen at the end of the first tick: it was so from the begin.
      measured_.safe_s = since_s < 1.5 * kTick_s ? 0 : since_s;
    }
  }

  /// A drive that brakes takes energy out, whatever its torque; one that pushes along its motion
  /// puts it in. A quarter of the gate's ceiling is what the firmware itself calls far off.
  void note_torque() {
    bool surge = false;
    for (std::size_t j = 0; j < measured_.push_Nm.size(); ++j) {
      const double push_Nm = foot_.lock_step().torques().push_Nm[j];
      measured_.push_Nm[j] = std::max(measured_.push_Nm[j], push_Nm);
      const double far_off_Nm = double(firmware::safety::kLimits[j].following_Nm);
      surge = surge || push_Nm > undisturbed_[j] + far_off_Nm;
    }
    if (surge) measured_.surge_s += kTick_s;
  }

  void recover() {
    recovering_ = true;
    const std::uint32_t found = measured_.faults;
    bridge::Supervisor& supervisor = foot_.lock_step().supervisor();
    supervisor.order(Order::kReset);
    measured_.reset = watch(kResetLimit_s, [&] {
      return supervisor.accepted() && foot_.mode() == Mode::kOff &&
             foot_.lock_step().firmware().faults() == 0;
    });
    if (!measured_.reset) return;
    foot_.order_ready();
    const auto away = [this] { return moving(foot_.mode()); };
    measured_.moves = watch(kResetLimit_s, away) && !watch(kMove_s, [&] { return !away(); });
    measured_.faults = found;
  }

  MatrixFoot& foot_;
  const MatrixCase& case_;
  const JointTorques& undisturbed_;
  std::uint32_t before_ = 0;
  double began_s_ = 0;
  bool recovering_ = false;
  Measured measured_;
};

}  // namespace

bool moving(Mode mode) {
  return mode == Mode::kHoming || mode == Mode::kReady || mode == Mode::kRunning;
}

bool at_rest(Mode mode) {
  return !moving(mode) && mode != Mode::kDampedStop;
}

JointTorques measure_undisturbed(MatrixFoot& foot) {
  JointTorques push_Nm{};
  const double until_s = foot.now_s() + kUndisturbed_s - 0.5 * kTick_s;
  while (foot.now_s() < until_s) {
    foot.tick();
    for (std::size_t j = 0; j < push_Nm.size(); ++j) {
      push_Nm[j] = std::max(push_Nm[j], foot.lock_step().torques().push_Nm[j]);
    }
  }
  return push_Nm;
}

Measured measure(MatrixFoot& foot, const MatrixCase& c, const JointTorques& undisturbed) {
  return CellRun(foot, c, undisturbed).go();
}

}  // namespace hoof::tools
