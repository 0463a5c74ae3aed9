#include "tools/faults/matrix_cases.h"

#include <stdexcept>

namespace hoof::tools {
namespace {

using bridge::FaultKind;
using bridge::FaultSpec;
using firmware::control::Mode;
namespace fault = firmware::control::fault;

constexpr double kDegree_rad = 0.017453292519943295;

// Bounds, each from the time-outs of firmware and drives (firmware/safety/limits.h) and the way of
// a frame: sent in one tick, seen in the next, acted upon by the drive with the one after.

/// Silence is called after 20 ms, by the firmware and by each drive.
constexpr double kSilence_s = 0.024;
/// A tick to see it, one to act, one on the way.
constexpr double kAtOnce_s = 0.003;
/// The drive's speed filter (200 Hz, 0.8 ms) forgets a jump of 5 degrees within a sample, 107
/// rad/s, down to the 0.4 rad/s that damping makes a quarter of the ceiling of: 4.5 ms, and
/// kAtOnce.
constexpr double kJumpEchoes_s = 0.0075;
/// 100 ticks of not following, and until so much is asked: a quarter of the ceiling.
constexpr double kFollowing_s = 0.3;
/// Eleven replies on one code, and until the set point has gone on by what changes the torque by 4
/// or 30 Nm: 16 and 2 mrad. In homing a stuck encoder is first taken for the stop (50 ms).
constexpr double kStuck_s = 0.12;

FaultSpec spec(FaultKind kind, const std::string& target, double for_s) {
  FaultSpec fault;
  fault.kind = kind;
  fault.target = target;
  fault.for_s = for_s;
  fault.key = "fault";
  fault.origin.file = "matrix";
  return fault;
}

/// Harmless in every mode.
MatrixCase harmless(const std::string& name, FaultSpec fault) {
  return {name, std::move(fault), {}, {}, {}, {}, ""};
}

/// A moving foot stops with one of these bits; one that is stopping may tell it, too; a still one
/// has no use for it.
MatrixCase stops(const std::string& name, FaultSpec fault, std::uint32_t bits, double safe_s) {
  return {name, std::move(fault), {bits, safe_s}, {bits, 0}, {}, {}, ""};
}

/// Latched in every mode.
MatrixCase always(const std::string& name, FaultSpec fault, std::uint32_t bits, double safe_s) {
  return {name, std::move(fault), {bits, safe_s}, {bits, 0}, {bits, 0}, {}, ""};
}

MatrixCase because(MatrixCase c, const std::string& why) {
  c.why = why;
  return c;
}

/// What should be found and is not: told in the table, and no miss.
MatrixCase gap(MatrixCase c, const std::string& why) {
  c.gap = true;
  return because(std::move(c), why);
}

/// The drive's own law acts on its own wrong encoder, or on a wrong command, before anyone can
/// know.
MatrixCase surging(MatrixCase c, double surge_s) {
  for (Expectation* e : {&c.moving, &c.stopping}) e->surge_s = surge_s;
  return c;
}

MatrixCase except(MatrixCase c, std::vector<Mode> modes, Expectation expected) {
  for (const Mode mode : modes) c.except.emplace_back(mode, expected);
  return c;
}

FaultSpec with(FaultSpec fault, double FaultSpec::*member, double value) {
  fault.*member = value;
  return fault;
}

FaultSpec flood(const std::string& bus, int id, double for_s) {
  FaultSpec fault = spec(FaultKind::kFlood, bus, for_s);
  fault.id = id;
  return fault;
}

FaultSpec restart(const std::string& node, hal::ResetCause cause, double for_s = 0.05) {
  FaultSpec fault = spec(FaultKind::kNodeRestart, node, for_s);
  fault.cause = cause;
  return fault;
}

void add_frame_cases(std::vector<MatrixCase>& cases) {
  using K = FaultKind;
  const auto delay = [](const std::string& target, double delay_s, double for_s) {
    return with(spec(K::kDelay, target, for_s), &FaultSpec::delay_s, delay_s);
  };
  cases.push_back(stops("drop: replies of the hip", spec(K::kDrop, "HipReply", 0.1),
                        fault::kDriveLost, kSilence_s));
  cases.push_back(stops("drop: commands of the knee", spec(K::kDrop, "KneeCommand", 0.1),
                        fault::kDriveLost, kSilence_s));
  cases.push_back(stops("drop: SYNC", spec(K::kDrop, "Sync", 0.1), fault::kSyncLost, kSilence_s));
  cases.push_back(harmless("drop: SYNC for 10 ms", spec(K::kDrop, "Sync", 0.01)));
  cases.push_back(harmless("drop: a tenth of bus 1",
                           with(spec(K::kDrop, "can1", 0.3), &FaultSpec::probability, 0.1)));
  cases.push_back(harmless("drop: heartbeat", spec(K::kDrop, "Heartbeat", 0.3)));
  cases.push_back(harmless("delay: replies of the hip by 3 ms", delay("HipReply", 0.003, 0.2)));
  cases.push_back(stops("delay: replies of the knee by 50 ms", delay("KneeReply", 0.05, 0.1),
                        fault::kDriveLost, kSilence_s));
  cases.push_back(harmless("delay: commands of the hip by 3 ms", delay("HipCommand", 0.003, 0.2)));
  cases.push_back(because(
      stops("delay: commands of the knee by 50 ms", delay("KneeCommand", 0.05, 0.1),
            fault::kDriveLost, 0.05 + kSilence_s),
      "what was ordered before the stop arrives up to 50 ms behind it: a drive's frames have no "
      "time stamp"));
  cases.push_back(harmless("delay: SYNC by 5 ms", delay("Sync", 0.005, 0.2)));
  cases.push_back(harmless("reorder: replies of the hip", spec(K::kReorder, "HipReply", 0.2)));
  cases.push_back(harmless("reorder: commands of the hip", spec(K::kReorder, "HipCommand", 0.2)));
  cases.push_back(harmless("reorder: SYNC", spec(K::kReorder, "Sync", 0.2)));
  cases.push_back(harmless("duplicate: bus 0", spec(K::kDuplicate, "can0", 0.2)));
  cases.push_back(harmless("duplicate: bus 1", spec(K::kDuplicate, "can1", 0.2)));
  cases.push_back(stops("corrupt: replies of the hip", spec(K::kCorrupt, "HipReply", 0.2),
                        fault::kImplausibleReply | fault::kDriveError | fault::kOverTemperature |
                            fault::kOutsideTravel | fault::kNotFollowing,
                        kSilence_s));
  cases.push_back(because(
      stops("corrupt: SYNC", spec(K::kCorrupt, "Sync", 0.1), fault::kSyncLost, 0.1 + kSilence_s),
      "a flipped number that runs ahead is a tick, and makes the true ones old; SYNC is lost 20 ms "
      "behind the farthest, at the latest behind the end"));
  cases.push_back(gap(
      surging(stops("corrupt: commands of the knee", spec(K::kCorrupt, "KneeCommand", 0.2),
                    fault::kNotFollowing | fault::kImplausibleReply, kFollowing_s),
              kFollowing_s),
      "a drive's command has no CRC beyond CAN's own: what a broken or foreign node sends under "
      "its "
      "identifier is obeyed, and an exit frame is a bit away from enter. The firmware can tell it "
      "only where the drive is astray for longer than not, and does not look in mode off"));
  cases.push_back(harmless("corrupt: heartbeat", spec(K::kCorrupt, "Heartbeat", 0.3)));
  cases.push_back(harmless("sync_jitter: up to 0.8 ms",
                           with(spec(K::kSyncJitter, "Sync", 0.3), &FaultSpec::delay_s, 0.0008)));
}

void add_bus_cases(std::vector<MatrixCase>& cases) {
  using K = FaultKind;
  cases.push_back(stops("flood: bus 0, highest priority", flood("can0", 0, 0.1),
                        fault::kSyncLost | fault::kDriveLost, kSilence_s));
  cases.push_back(stops("flood: bus 1, highest priority", flood("can1", 0, 0.1), fault::kDriveLost,
                        kSilence_s));
  cases.push_back(harmless("flood: bus 0, lowest priority", flood("can0", 0x7FF, 0.2)));
  cases.push_back(harmless("flood: bus 1, lowest priority", flood("can1", 0x7FF, 0.2)));
  // What a bus that is off takes away is found, too.
  const std::uint32_t cut_off = fault::kBusOff | fault::kSyncLost | fault::kDriveLost;
  MatrixCase foot = always("bus_off: foot", spec(K::kBusOff, "foot", 0.1), cut_off, kSilence_s);
  foot.idle.bits = fault::kBusOff;
  cases.push_back(because(std::move(foot), "told at once; the drives let go after their 20 ms"));
  cases.push_back(
      stops("bus_off: SYNC master", spec(K::kBusOff, "sync", 0.1), fault::kSyncLost, kSilence_s));
  cases.push_back(
      stops("bus_off: knee", spec(K::kBusOff, "knee", 0.1), fault::kDriveLost, kSilence_s));
}

void add_node_cases(std::vector<MatrixCase>& cases) {
  using K = FaultKind;
  using hal::ResetCause;
  cases.push_back(
      stops("node_silent: foot", spec(K::kNodeSilent, "foot", 0.1), fault::kDriveLost, kSilence_s));
  cases.push_back(
      stops("node_silent: toe", spec(K::kNodeSilent, "toe", 0.1), fault::kDriveLost, kSilence_s));
  cases.push_back(
      stops("node_silent: hip", spec(K::kNodeSilent, "hip", 0.1), fault::kDriveLost, kSilence_s));
  cases.push_back(stops("node_silent: SYNC master", spec(K::kNodeSilent, "sync", 0.1),
                        fault::kSyncLost, kSilence_s));
  cases.push_back({"node_restart: foot, power on",
                   restart("foot", ResetCause::kPowerOn),
                   {0, kSilence_s},
                   {},
                   {},
                   {},
                   "no fault: it wakes up in mode off, and the drives have let go by then"});
  cases.push_back(always("node_restart: foot, watchdog", restart("foot", ResetCause::kWatchdog),
                         fault::kUnexpectedReset, kSilence_s));
  cases.push_back(stops("node_restart: toe", restart("toe", ResetCause::kPowerOn),
                        fault::kDriveLost, kSilence_s));
  cases.push_back(stops("node_restart: hip", restart("hip", ResetCause::kPowerOn),
                        fault::kDriveLost, kSilence_s));
  cases.push_back(
      because(except(stops("node_restart: toe, 5 ms", restart("toe", ResetCause::kPowerOn, 0.005),
                           fault::kImplausibleReply, 0.005 + kAtOnce_s),
                     {Mode::kHoming}, {}),
              "too short for silence: told by the count that is lost. In homing nothing is counted "
              "yet, and a "
              "drive that is off finds no stop, which is called after 5 s"));
}

FaultSpec amount(FaultKind kind, const std::string& joint, double value, double for_s) {
  return with(spec(kind, joint, for_s), &FaultSpec::amount, value);
}

/// What a drive's torque or encoder could change shows only where it is used.
MatrixCase at_work(const std::string& name, FaultSpec fault, std::uint32_t bits, double safe_s) {
  return {name, std::move(fault), {bits, safe_s, true}, {0, 0, true}, {0, 0, true}, {}, ""};
}

void add_encoder_cases(std::vector<MatrixCase>& cases) {
  using K = FaultKind;
  for (const char* joint : {"toe", "hip", "knee"}) {
    const std::string of = std::string(": ") + joint;
    const bool toe = of == ": toe";
    cases.push_back(surging(stops("encoder_jump" + of + ", 5 deg",
                                  amount(K::kEncoderJump, joint, -5 * kDegree_rad, 0.1),
                                  fault::kImplausibleReply, kAtOnce_s),
                            kJumpEchoes_s));
    cases.push_back(surging(stops("encoder_offset" + of + ", 3 deg",
                                  amount(K::kEncoderOffset, joint, 3 * kDegree_rad, 0.1),
                                  fault::kImplausibleReply, kAtOnce_s),
                            kAtOnce_s));
    cases.push_back(because(
        harmless("encoder_drift" + of + ", 5 deg/s",
                 amount(K::kEncoderDrift, joint, 5 * kDegree_rad, 0.2)),
        "not found: a reading that creeps together with its speed is motion to whoever has one "
        "encoder; the joint follows it gently"));
    const std::uint32_t jam = toe ? fault::kToeJammed | fault::kToeStalled : 0u;
    cases.push_back(
        because(surging(at_work("encoder_stuck" + of, spec(K::kEncoderStuck, joint, 0.6),
                                fault::kImplausibleReply | jam, kStuck_s),
                        kStuck_s),
                "at rest it changes nothing, and is not found until the torque changes"));
  }
  cases.push_back(surging(harmless("encoder_jump: hip, 0.2 deg",
                                   amount(K::kEncoderJump, "hip", 0.2 * kDegree_rad, 0.1)),
                          kJumpEchoes_s));
  cases.push_back(harmless("encoder_noise: hip, 0.002 deg",
                           amount(K::kEncoderNoise, "hip", 0.002 * kDegree_rad, 0.3)));
  cases.push_back(because(
      surging(stops("encoder_noise: hip, 1 deg", amount(K::kEncoderNoise, "hip", kDegree_rad, 0.3),
                    fault::kImplausibleReply, kSilence_s),
              0.3),
      "the damping of the stop acts on the drive's own noisy speed: it shakes the rotor, with a "
      "mean "
      "of nothing, until the noise ends, or the stop after 2 s"));
}

void add_torque_cases(std::vector<MatrixCase>& cases) {
  using K = FaultKind;
  for (const char* joint : {"toe", "hip", "knee"}) {
    const std::string of = std::string(": ") + joint;
    const bool toe = of == ": toe";
    const std::uint32_t jam = toe ? fault::kToeJammed | fault::kToeStalled : 0u;
    cases.push_back(because(surging(at_work("stall" + of, amount(K::kStall, joint, 2000, 0.6),
                                            fault::kImplausibleReply | jam, kStuck_s),
                                    kStuck_s),
                            "at rest it changes nothing"));
    // In homing a toe without torque finds no stop, which is called after 5 s. A leg at rest is
    // held by friction.
    const std::vector<Mode> still = toe ? std::vector<Mode>{Mode::kHoming, Mode::kRunning}
                                        : std::vector<Mode>{Mode::kHoming, Mode::kReady};
    cases.push_back(
        because(except(at_work("torque_loss" + of, spec(K::kTorqueLoss, joint, 0.6),
                               fault::kNotFollowing | fault::kImplausibleReply, kFollowing_s),
                       still, {}),
                "harmless where so little is asked of the drive that friction holds the joint"));
  }
}

void add_board_cases(std::vector<MatrixCase>& cases) {
  using K = FaultKind;
  const auto pressed = [](const std::string& name, const std::string& target, double for_s) {
    return except(always(name, spec(K::kEstop, target, for_s), fault::kEmergencyStop, kAtOnce_s),
                  {Mode::kEmergencyOff}, {});
  };
  cases.push_back(
      always("brown_out: line low", spec(K::kBrownOut, "foot", 0.02), fault::kBrownOut, kAtOnce_s));
  cases.push_back(always("brown_out: 12 V",
                         with(spec(K::kBrownOut, "foot", 0.02), &FaultSpec::amount, 12),
                         fault::kBrownOut, kAtOnce_s));
  cases.push_back(because(harmless("brown_out: one tick", spec(K::kBrownOut, "foot", 0.001)),
                          "a spike of the supply's measurement: two ticks in a row count"));
  cases.push_back(pressed("estop: line", "line", 0.02));
  cases.push_back(pressed("estop: line for a tick", "line", 0.001));
  cases.push_back(pressed("estop: frame on bus 0", "can0", 0.02));
  cases.push_back(pressed("estop: frame on bus 1", "can1", 0.02));
}

}  // namespace

bool Expectation::goes_on(Mode mode) const {
  const bool moving = mode == Mode::kHoming || mode == Mode::kReady || mode == Mode::kRunning;
  return bits == 0 && moving && safe_s == 0;
}

const Expectation& MatrixCase::expected(Mode mode) const {
  for (const auto& [excepted, expectation] : except) {
    if (excepted == mode) return expectation;
  }
  if (mode == Mode::kHoming || mode == Mode::kReady || mode == Mode::kRunning) return moving;
  return mode == Mode::kDampedStop ? stopping : idle;
}

std::vector<MatrixCase> matrix_cases() {
  std::vector<MatrixCase> cases;
  add_frame_cases(cases);
  add_bus_cases(cases);
  add_node_cases(cases);
  add_encoder_cases(cases);
  add_torque_cases(cases);
  add_board_cases(cases);
  return cases;
}

}  // namespace hoof::tools
