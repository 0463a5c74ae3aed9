#include "tools/faults/matrix_foot.h"

#include <stdexcept>

#include "tools/experiment/bench.h"

namespace hoof::tools {
namespace {

using firmware::control::Mode;
using firmware::protocol::Order;

constexpr double kToe_rad = 0.35;       // 20 degrees
constexpr double kFrequency_Hz = 0.45;  // the paper's slower one
constexpr double kLongest_s = 10;       // to reach a mode

}  // namespace

MatrixFoot::MatrixFoot()
    : run_(read_run_settings("traction", {"experiment.terrain=\"rigid\""})),
      experiment_(make_experiment(
          run_, [](double) { return true; }, [](const std::string&) {})),
      wires_(bridge::in_process_wires({})),
      faults_({}, {true, true, true}),
      lock_step_(*experiment_, run_.parameters, faults_.wires(*wires_)) {
  faults_.bind(lock_step_, *experiment_);
}

void MatrixFoot::tick() {
  lock_step_.tick();
  const bridge::TickRecord record{experiment_->observe(), lock_step_.firmware().telemetry(),
                                  lock_step_.torques()};
  faults_.update(record);
}

void MatrixFoot::wait_s(double time_s) {
  const double from_s = now_s();
  while (now_s() - from_s < time_s - 0.5e-3) tick();
}

void MatrixFoot::wait(Mode wanted, double then_s) {
  const double from_s = now_s();
  while (mode() != wanted) {
    if (now_s() - from_s > kLongest_s) {
      throw std::runtime_error("the foot does not reach mode " + bridge::mode_name(int(wanted)) +
                               "; it is in " + bridge::mode_name(int(mode())));
    }
    tick();
  }
  wait_s(then_s);
}

void MatrixFoot::order_ready() {
  lock_step_.supervisor().order(Order::kReady, kToe_rad);
}

/// Toes and leg are still on their way.
void MatrixFoot::become_ready() {
  order_ready();
  wait(Mode::kReady, 0.1);
}

/// A quarter of a second into the gait: the foot goes down.
void MatrixFoot::run() {
  lock_step_.supervisor().order(Order::kRun, kToe_rad, kFrequency_Hz);
  wait(Mode::kRunning, 0);
  experiment_->foot_ready();
  wait_s(0.25);
}

void MatrixFoot::silence_toe() {
  bridge::FaultSpec fault;
  fault.kind = bridge::FaultKind::kNodeSilent;
  fault.target = "toe";
  fault.at_s = now_s();
  fault.for_s = 0.03;
  faults_.add(fault);
}

void MatrixFoot::bring_to(Mode mode) {
  switch (mode) {
    case Mode::kOff:
      return wait_s(0.2);
    case Mode::kHoming:
      order_ready();
      return wait(Mode::kHoming, 0.05);
    case Mode::kReady:
      return become_ready();
    case Mode::kRunning:
      return run();
    case Mode::kDampedStop:
      run();
      lock_step_.supervisor().order(Order::kStop);
      return wait(Mode::kDampedStop, 0.005);
    case Mode::kEmergencyOff:
      become_ready();
      lock_step_.firmware().board()->pressed = true;
      wait(Mode::kEmergencyOff, 0.02);
      lock_step_.firmware().board()->pressed = false;
      return wait_s(0.1);
    case Mode::kFault:
      become_ready();
      silence_toe();
      return wait(Mode::kFault, 0.1);
  }
}

}  // namespace hoof::tools
