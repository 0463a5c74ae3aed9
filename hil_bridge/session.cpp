#include "hil_bridge/session.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace hoof::bridge {
namespace {

using firmware::protocol::Mode;
using firmware::protocol::Order;

class Session {
 public:
  Session(sim::Experiment& experiment, const FirmwareMaker& firmware, Wires& wires,
          const SessionSettings& settings, const TickObserver& observer, Pace* pace)
      : experiment_(experiment),
        wires_(wires),
        settings_(settings),
        observer_(observer),
        lock_step_(experiment, firmware, settings.faults ? settings.faults->wires(wires) : wires,
                   pace) {
    if (settings_.faults) settings_.faults->bind(lock_step_, experiment_);
  }

  SessionResult run() {
    result_.toe_command_rad = settings_.toe_rad;
    if (prepare() && perform()) close();
    if (ended_ && !result_.interrupted) recover();
    finish();
    if (settings_.faults && !result_.interrupted) settings_.faults->require_changes();
    return result_;
  }

 private:
  /// @return false when the observer wants to stop
  bool tick() {
    const bool go_on = record_tick();
    if (!lock_step_.firmware().lost().empty()) run_on_in_silence();
    if (const std::string& trouble = lock_step_.supervisor().trouble(); !trouble.empty()) {
      end("at " + std::to_string(experiment_.time_s()) + " s: " + trouble);
    }
    result_.interrupted = result_.interrupted || !go_on;
    return go_on && !ended_;
  }

  bool record_tick() {
    lock_step_.tick();
    const TickRecord record{experiment_.observe(), lock_step_.firmware().telemetry(),
                            lock_step_.torques()};
    if (record.plant.phase == sim::Phase::kLoaded) note_deflection(record.plant);
    for (int j = 0; j < sim::kJointCount; ++j) {
      result_.torque_peak_Nm[j] = std::max(result_.torque_peak_Nm[j], record.torques.peak_Nm[j]);
      result_.torque_limited_s[j] += record.torques.limited_s[j];
    }
    if (settings_.faults) note_faults(record);
    return !observer_ || observer_(record);
  }

  bool drives_have_torque() const {
    for (int j = 0; j < sim::kJointCount; ++j) {
      const sim::Drive* drive = experiment_.plant().drive(sim::Joint(j));
      if (drive != nullptr && drive->motor_torque_Nm() != 0) return true;
    }
    return false;
  }

  /// Nobody commands the drives any more: their own time-outs must act, in the plant's time.
  [[noreturn]] void run_on_in_silence() {
    const double silent_s = experiment_.time_s() - 1e-3;  // the SYNC that had no answer
    double without_s = -1;                                // since when no drive has had torque
    for (int i = 0; i < settings_.silent_ticks; ++i) {
      if (drives_have_torque()) {
        without_s = -1;
      } else if (without_s < 0) {
        without_s = experiment_.time_s() - silent_s;
      }
      if (!record_tick()) break;
    }
    char text[120];
    if (without_s >= 0) {
      std::snprintf(text, sizeof text, "; the drives were without torque %.0f ms after it",
                    without_s * 1e3);
    } else {
      std::snprintf(text, sizeof text, "; a drive still had torque %d ms after it",
                    settings_.silent_ticks);
    }
    throw std::runtime_error("at " + std::to_string(silent_s) +
                             " s: " + lock_step_.firmware().lost() + text);
  }

  /// Without faults an error; with them the end of the test.
  void end(const std::string& why) {
    if (!settings_.faults) throw std::runtime_error(why);
    if (!ended_) result_.ended_by = why;
    ended_ = true;
  }

  void note_faults(const TickRecord& record) {
    settings_.faults->update(record);
    if (!settings_.faults->first_s()) return;
    // Of now: the record's is of before the orders that came with the tick.
    watch_.note(record.plant.time_s, experiment_.plant(), lock_step_.firmware().mode(),
                lock_step_.firmware().faults());
  }

  /// The foot comes to rest, the faults end, and an operator resets it, who knows what the
  /// heartbeat tells: the same whether the firmware is in this process or not.
  void recover() {
    const auto told = [this](bool without_fault, auto... modes) {
      const auto& heartbeat = lock_step_.supervisor().heartbeat();
      if (!heartbeat || (without_fault && heartbeat->faults != 0)) return false;
      return ((heartbeat->mode == modes) || ...);
    };
    const auto at_rest = [&told] {
      return told(false, Mode::kOff, Mode::kFault, Mode::kEmergencyOff);
    };
    const auto go_on = [this](double limit_s, const auto& until) {
      const double from_s = experiment_.time_s();
      while (!until() && experiment_.time_s() - from_s < limit_s) {
        tick();
        if (result_.interrupted) return false;
      }
      return until();
    };
    if (!go_on(settings_.rest_limit_s, at_rest)) return;
    const auto over = [this] { return !settings_.faults->any_active(); };
    if (!go_on(settings_.rest_limit_s, over)) return;
    lock_step_.supervisor().order(Order::kReset);
    const auto reset = [&] { return lock_step_.supervisor().accepted() && told(true, Mode::kOff); };
    if (go_on(settings_.reset_limit_s, reset)) watch_.note_reset(experiment_.time_s());
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

  /// As an operator learns it: the same whether the firmware is in this process or not.
  bool running() const {
    const Supervisor& s = lock_step_.supervisor();
    return s.heartbeat() && s.heartbeat()->mode == Mode::kRunning;
  }

  bool prepare() {
    lock_step_.supervisor().order(Order::kReady, settings_.toe_rad);
    while (!ready()) {
      if (!tick()) return false;
      if (experiment_.time_s() > settings_.prepare_limit_s) return not_ready();
    }
    if (settings_.has_toes) {
      const sim::Rig& rig = experiment_.plant().rig();
      result_.toe_reached_rad = 0.5 * (rig.toe_opening_rad(0) + rig.toe_opening_rad(1));
    }
    return true;
  }

  bool not_ready() {
    const firmware::app::Telemetry& t = lock_step_.firmware().telemetry();
    end("the foot did not become ready within " + std::to_string(settings_.prepare_limit_s) +
        " s of simulated time: mode " + std::to_string(int(t.mode)) + ", toes at " +
        std::to_string(double(t.state[0].position_rad)) + " of " +
        std::to_string(settings_.toe_rad) + " rad");
    return false;
  }

  bool perform() {
    if (settings_.firmware_leg) {
      lock_step_.supervisor().order(Order::kRun, settings_.toe_rad, settings_.frequency_Hz);
      // The leg goes to the start of its path first, by itself; the test waits for the gait.
      while (!running()) {
        if (!tick()) return false;
        if (experiment_.time_s() > 2 * settings_.prepare_limit_s) return not_ready();
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
    if (!settings_.faults) return;
    result_.faults = settings_.faults->outcomes();
    result_.reaction = watch_.reaction();
  }

  sim::Experiment& experiment_;
  Wires& wires_;
  const SessionSettings& settings_;
  const TickObserver& observer_;
  LockStep lock_step_;
  SessionResult result_;
  ReactionWatch watch_;
  bool ended_ = false;  // by what the firmware reported
};

}  // namespace

SessionResult run_session(sim::Experiment& experiment, const FirmwareMaker& firmware, Wires& wires,
                          const SessionSettings& settings, const TickObserver& observer,
                          Pace* pace) {
  return Session(experiment, firmware, wires, settings, observer, pace).run();
}

SessionResult run_session(sim::Experiment& experiment, const firmware::app::Parameters& parameters,
                          Wires& wires, const SessionSettings& settings,
                          const TickObserver& observer) {
  return run_session(experiment, local_firmware(parameters), wires, settings, observer);
}

}  // namespace hoof::bridge
