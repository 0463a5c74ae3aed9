#include "hil_bridge/session.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hoof::bridge {
namespace {

using firmware::protocol::Mode;
using firmware::protocol::Order;

class Session {
 public:
  Session(sim::Experiment& experiment, const FirmwareFactory& firmware, Wires& wires,
          const SessionSettings& settings, const TickObserver& observer)
      : experiment_(experiment),
        wires_(wires),
        settings_(settings),
        observer_(observer),
        lock_step_(experiment, firmware, wires) {}

  SessionResult run() {
    result_.toe_command_rad = settings_.toe_rad;
    if (prepare() && perform()) close();
    finish();
    return result_;
  }

 private:
  /// @return false when the observer wants to stop
  bool tick() {
    lock_step_.tick();
    const TickRecord record{experiment_.observe(), lock_step_.firmware().telemetry(),
                            lock_step_.torques()};
    if (record.plant.phase == sim::Phase::kLoaded) note_deflection(record.plant);
    for (int j = 0; j < sim::kJointCount; ++j) {
      result_.torque_peak_Nm[j] = std::max(result_.torque_peak_Nm[j], record.torques.peak_Nm[j]);
      result_.torque_limited_s[j] += record.torques.limited_s[j];
    }
    if (const std::string& trouble = lock_step_.supervisor().trouble(); !trouble.empty()) {
      throw std::runtime_error("at " + std::to_string(record.plant.time_s) + " s: " + trouble);
    }
    if (observer_ && !observer_(record)) {
      result_.interrupted = true;
      return false;
    }
    return true;
  }

  static double mean_opening(const sim::Observation& o) {
    return 0.5 * (o.toe_left_rad + o.toe_right_rad);
  }

  void note_deflection(const sim::Observation& o) {
    if (!settings_.has_toes) return;
    result_.toe_deflection_rad =
        std::max(result_.toe_deflection_rad, std::abs(mean_opening(o) - settings_.toe_rad));
  }

  bool ready() const {
    const Supervisor& s = lock_step_.supervisor();
    if (!s.accepted() || !s.heartbeat() || s.heartbeat()->mode != Mode::kReady) return false;
    if (!settings_.has_toes) return true;
    // Told by the firmware over the bus, as an operator would see it.
    return s.toe() && !s.toe()->moving &&
           std::abs(double(s.toe()->commanded_rad) - settings_.toe_rad) < 1e-3 &&
           std::abs(double(s.toe()->measured_rad) - settings_.toe_rad) <
               settings_.toe_tolerance_rad;
  }

  bool prepare() {
    lock_step_.supervisor().order(Order::kReady, settings_.toe_rad);
    while (!ready()) {
      if (!tick()) return false;
      if (experiment_.time_s() > settings_.prepare_limit_s) throw_not_ready();
    }
    if (settings_.has_toes) {
      const sim::Rig& rig = experiment_.plant().rig();
      result_.toe_reached_rad = 0.5 * (rig.toe_opening_rad(0) + rig.toe_opening_rad(1));
    }
    return true;
  }

  [[noreturn]] void throw_not_ready() {
    const firmware::app::Telemetry& t = lock_step_.firmware().telemetry();
    throw std::runtime_error("the foot did not become ready within " +
                             std::to_string(settings_.prepare_limit_s) +
                             " s of simulated time: mode " + std::to_string(int(t.mode)) +
                             ", toes at " + std::to_string(double(t.state[0].position_rad)) +
                             " of " + std::to_string(settings_.toe_rad) + " rad");
  }

  bool perform() {
    if (settings_.firmware_leg) {
      lock_step_.supervisor().order(Order::kRun, settings_.toe_rad, settings_.frequency_Hz);
      // The leg goes to the start of its path first, by itself; the test waits for the gait.
      // It is told so by heartbeat, as an operator would be.
      while (lock_step_.supervisor().mode() != Mode::kRunning) {
        if (!tick()) return false;
        if (experiment_.time_s() > 2 * settings_.prepare_limit_s) throw_not_ready();
      }
    }
    experiment_.foot_ready();
    while (!experiment_.finished()) {
      if (!tick()) return false;
    }
    return true;
  }

  void close() {
    lock_step_.supervisor().order(Order::kStop);
    for (int i = 0; i < settings_.closing_ticks; ++i) {
      if (!tick()) return;
    }
  }

  void finish() {
    result_.ticks = lock_step_.ticks();
    result_.frames = wires_.frames();
    result_.gate_interventions = lock_step_.firmware().telemetry().gate_interventions;
    for (int bus = 0; bus < kBusCount; ++bus) {
      result_.bus_load_ratio[bus] = wires_.load_ratio(bus);
      result_.worst_bus_load_ratio[bus] = wires_.worst_load_ratio(bus);
    }
  }

  sim::Experiment& experiment_;
  Wires& wires_;
  const SessionSettings& settings_;
  const TickObserver& observer_;
  LockStep lock_step_;
  SessionResult result_;
};

}  // namespace

SessionResult run_session(sim::Experiment& experiment, const FirmwareFactory& firmware,
                          Wires& wires, const SessionSettings& settings,
                          const TickObserver& observer) {
  return Session(experiment, firmware, wires, settings, observer).run();
}

}  // namespace hoof::bridge
