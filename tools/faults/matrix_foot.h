// The foot of the fault matrix: the traction rig on rigid ground, brought to any mode.
#pragma once

#include <memory>

#include "firmware/control/types.h"
#include "hil_bridge/fault_timeline.h"
#include "hil_bridge/lock_step.h"
#include "hil_bridge/session.h"
#include "tools/experiment/run_settings.h"

namespace hoof::tools {

class MatrixFoot {
 public:
  MatrixFoot();

  /// The same ticks every time. @throws std::runtime_error where it takes too long
  void bring_to(firmware::control::Mode mode);

  void tick();
  double now_s() const { return double(lock_step_.now_ns()) * 1e-9; }
  bridge::FaultTimeline& faults() { return faults_; }
  bridge::LockStep& lock_step() { return lock_step_; }
  const sim::Plant& plant() const { return experiment_->plant(); }
  firmware::control::Mode mode() const { return lock_step_.firmware().mode(); }

  void order_ready();

 private:
  void become_ready();
  void run();
  void silence_toe();
  void wait(firmware::control::Mode mode, double then_s);
  void wait_s(double time_s);

  RunSettings run_;
  std::unique_ptr<sim::Experiment> experiment_;
  std::unique_ptr<bridge::Wires> wires_;
  bridge::FaultTimeline faults_;
  bridge::LockStep lock_step_;
};

}  // namespace hoof::tools
