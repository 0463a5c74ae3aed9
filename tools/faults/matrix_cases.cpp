#include "tools/faults/matrix_cases.h"

#include <stdexcept>

namespace hoof::tools {
namespace {

using bridge::FaultKind;
using bridge::FaultSpec;
using firmware::control::Mode;
namespace fault = firmware::control::fault;

constexpr double kDegree_rad = 0.017453292519943295;

/// Firmware and drives call a silence after 20 ms; a tick to see it begin, one to act, and what is
/// on the wires then.
constexpr double kSilence_s = 0.024;
/// A tick to see it, one to act, one on the way.
constexpr double kAtOnce_s = 0.003;
/// Some flipped SYNC numbers run ahead and are ticks, until one runs so far that all are old.
constexpr double kRunsAhead_s = 0.06;
/// Until the drive's speed filter has forgotten a jump, damping acts on a speed that is none.
constexpr double kJump_s = 0.01;
/// 100 ticks of not following, and what it takes to go astray.
constexpr double kFollowing_s = 0.3;
/// Until the torque has changed by what tells a stuck reading, or the toe's jam time is over.
constexpr double kStuck_s = 0.35;

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
  cases.push_back(stops("drop: replies of the hip", spec(K::kDrop, "HipReply", 0.1),
                        fault::kDriveLost, kSilence_s));
  cases.push_back(stops("drop: commands of the knee", spec(K::kDrop, "KneeCommand", 0.1),
                        fault::kDriveLost, kSilence_s));
  cases.push_back(stops("drop: SYNC", spec(K::kDrop, "Sync", 0.1), fault::kSyncLost, kSilence_s));
  cases.push_back(harmless("drop: SYNC for 10 ms", spec(K::kDrop, "Sync", 0.01)));
  cases.push_back(harmless("drop: a tenth of bus 1",
                           with(spec(K::kDrop, "can1", 0.3), &FaultSpec::probability, 0.1)));
  cases.push_back(harmless("drop: heartbeat", spec(K::kDrop, "Heartbeat", 0.3)));
  cases.push_back(harmless("delay: replies of the hip by 3 ms",
                           with(spec(K::kDelay, "HipReply", 0.2), &FaultSpec::delay_s, 0.003)));
  cases.push_back(stops("delay: replies of the knee by 50 ms",
                        with(spec(K::kDelay, "KneeReply", 0.1), &FaultSpec::delay_s, 0.05),
                        fault::kDriveLost, kSilence_s));
  cases.push_back(harmless("delay: SYNC by 5 ms",
                           with(spec(K::kDelay, "Sync", 0.2), &FaultSpec::delay_s, 0.005)));
  cases.push_back(harmless("reorder: replies of the hip", spec(K::kReorder, "HipReply", 0.2)));
  cases.push_back(harmless("reorder: SYNC", spec(K::kReorder, "Sync", 0.2)));
  cases.push_back(harmless("duplicate: bus 0", spec(K::kDuplicate, "can0", 0.2)));
  cases.push_back(harmless("duplicate: bus 1", spec(K::kDuplicate, "can1", 0.2)));
  cases.push_back(stops("corrupt: replies of the hip", spec(K::kCorrupt, "HipReply", 0.2),
                        fault::kImplausibleReply | fault::kDriveError | fault::kOverTemperature |
                            fault::kOutsideTravel | fault::kNotFollowing,
                        kSilence_s));
  cases.push_back(
      stops("corrupt: SYNC", spec(K::kCorrupt, "Sync", 0.1), fault::kSyncLost, kRunsAhead_s));
  cases.push_back(harmless("corrupt: heartbeat", spec(K::kCorrupt, "Heartbeat", 0.3)));
  cases.push_back(harmless("sync_jitter: up to 0.8 ms",
                           with(spec(K::kSyncJitter, "Sync", 0.3), &FaultSpec::delay_s, 0.0008)));
}

void add_node_cases(std::vector<MatrixCase>& cases) {
  using K = FaultKind;
  cases.push_back(stops("flood: bus 0, highest priority", flood("can0", 0, 0.1),
                        fault::kSyncLost | fault::kDriveLost, kSilence_s));
  MatrixCase late = stops("flood: bus 1, highest priority", flood("can1", 0, 0.1),
                          fault::kDriveLost, 0.1 + kAtOnce_s);
  late.why =
      "the last commands before the flood wait in the mailboxes and go out behind it, for a tick";
  cases.push_back(std::move(late));
  cases.push_back(harmless("flood: bus 0, lowest priority", flood("can0", 0x7FF, 0.2)));
  cases.push_back(harmless("flood: bus 1, lowest priority", flood("can1", 0x7FF, 0.2)));
  // What a bus that is off takes away is found, too.
  const std::uint32_t cut_off = fault::kBusOff | fault::kSyncLost | fault::kDriveLost;
  cases.push_back({"bus_off: foot",
                   spec(K::kBusOff, "foot", 0.1),
                   {cut_off, kSilence_s},
                   {cut_off, 0},
                   {fault::kBusOff, 0},
                   {},
                   ""});
  cases.push_back(
      stops("bus_off: SYNC master", spec(K::kBusOff, "sync", 0.1), fault::kSyncLost, kSilence_s));
  cases.push_back(
      stops("bus_off: knee", spec(K::kBusOff, "knee", 0.1), fault::kDriveLost, kSilence_s));
  cases.push_back(
      stops("node_silent: foot", spec(K::kNodeSilent, "foot", 0.1), fault::kDriveLost, kSilence_s));
  cases.push_back(
      stops("node_silent: toe", spec(K::kNodeSilent, "toe", 0.1), fault::kDriveLost, kSilence_s));
  cases.push_back(stops("node_silent: SYNC master", spec(K::kNodeSilent, "sync", 0.1),
                        fault::kSyncLost, kSilence_s));
  cases.push_back({"node_restart: foot, power on",
                   restart("foot", hal::ResetCause::kPowerOn),
                   {0, kSilence_s},
                   {},
                   {},
                   {},
                   "no fault: it wakes up in mode off"});
  cases.push_back(always("node_restart: foot, watchdog",
                         restart("foot", hal::ResetCause::kWatchdog), fault::kUnexpectedReset,
                         kSilence_s));
  cases.push_back(stops("node_restart: toe", restart("toe", hal::ResetCause::kPowerOn),
                        fault::kDriveLost, kSilence_s));
  cases.push_back(stops("node_restart: hip", restart("hip", hal::ResetCause::kPowerOn),
                        fault::kDriveLost, kSilence_s));
}

void add_drive_cases(std::vector<MatrixCase>& cases) {
  using K = FaultKind;
  const auto amount = [](K kind, const std::string& joint, double value, double for_s) {
    return with(spec(kind, joint, for_s), &FaultSpec::amount, value);
  };
  // What a drive's torque or encoder could change shows only where it is used.
  const auto at_work = [](const std::string& name, FaultSpec f, std::uint32_t bits, double safe_s) {
    return MatrixCase{name, std::move(f), {bits, safe_s, true}, {0, 0, true}, {0, 0, true}, {}, ""};
  };
  const std::vector<Mode> still = {Mode::kHoming, Mode::kReady};
  for (const char* joint : {"toe", "hip", "knee"}) {
    const std::string of = std::string(": ") + joint;
    const bool toe = of == ": toe";
    cases.push_back(stops("encoder_jump" + of + ", 5 deg",
                          amount(K::kEncoderJump, joint, -5 * kDegree_rad, 0.1),
                          fault::kImplausibleReply, kJump_s));
    cases.push_back(stops("encoder_offset" + of + ", 3 deg",
                          amount(K::kEncoderOffset, joint, 3 * kDegree_rad, 0.1),
                          fault::kImplausibleReply, kAtOnce_s));
    cases.push_back(harmless("encoder_drift" + of + ", 5 deg/s",
                             amount(K::kEncoderDrift, joint, 5 * kDegree_rad, 0.2)));
    const std::uint32_t jam = toe ? fault::kToeJammed | fault::kToeStalled : 0u;
    cases.push_back(at_work("encoder_stuck" + of, spec(K::kEncoderStuck, joint, 0.6),
                            fault::kImplausibleReply | jam, kStuck_s));
    cases.push_back(at_work("stall" + of, amount(K::kStall, joint, 2000, 0.6),
                            fault::kImplausibleReply | jam, kStuck_s));
    // At rest the joint is held by friction, and what is asked stays within what counts as
    // followed.
    MatrixCase loss = at_work("torque_loss" + of, spec(K::kTorqueLoss, joint, 0.6),
                              fault::kNotFollowing | fault::kImplausibleReply, kFollowing_s);
    loss =
        except(std::move(loss), toe ? std::vector<Mode>{Mode::kHoming, Mode::kRunning} : still, {});
    loss.why = "harmless where nothing but friction is asked of the drive";
    cases.push_back(std::move(loss));
  }
  cases.push_back(harmless("encoder_jump: hip, 0.2 deg",
                           amount(K::kEncoderJump, "hip", 0.2 * kDegree_rad, 0.1)));
  cases.push_back(harmless("encoder_noise: hip, 0.002 deg",
                           amount(K::kEncoderNoise, "hip", 0.002 * kDegree_rad, 0.3)));
  cases.push_back(stops("encoder_noise: hip, 1 deg",
                        amount(K::kEncoderNoise, "hip", 1 * kDegree_rad, 0.3),
                        fault::kImplausibleReply | fault::kNotFollowing, kSilence_s));
}

void add_board_cases(std::vector<MatrixCase>& cases) {
  using K = FaultKind;
  cases.push_back(
      always("brown_out: line low", spec(K::kBrownOut, "foot", 0.02), fault::kBrownOut, kAtOnce_s));
  cases.push_back(always("brown_out: 12 V",
                         with(spec(K::kBrownOut, "foot", 0.02), &FaultSpec::amount, 12),
                         fault::kBrownOut, kAtOnce_s));
  cases.push_back(harmless("brown_out: one tick", spec(K::kBrownOut, "foot", 0.001)));
  cases.push_back(
      except(always("estop: line", spec(K::kEstop, "line", 0.02), fault::kEmergencyStop, kAtOnce_s),
             {Mode::kEmergencyOff}, {}));
  cases.push_back(except(always("estop: frame on bus 0", spec(K::kEstop, "can0", 0.02),
                                fault::kEmergencyStop, kAtOnce_s),
                         {Mode::kEmergencyOff}, {}));
  cases.push_back(except(always("estop: frame on bus 1", spec(K::kEstop, "can1", 0.02),
                                fault::kEmergencyStop, kAtOnce_s),
                         {Mode::kEmergencyOff}, {}));
}

}  // namespace

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
  add_node_cases(cases);
  add_drive_cases(cases);
  add_board_cases(cases);
  return cases;
}

}  // namespace hoof::tools
