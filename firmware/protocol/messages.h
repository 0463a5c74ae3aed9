// The messages as plain structs in physical units. `fields()` lists the members in the order of the
// message's signals; the codec pairs them with the dictionary, the CRC (always last) left out.
#pragma once

#include <cstdint>
#include <tuple>

#include "firmware/protocol/dictionary.h"

namespace hoof::firmware::protocol {

/// Names as kModeNames.
enum class Mode : std::uint8_t {
  kOff = 0,
  kHoming,
  kReady,
  kRunning,
  kDampedStop,
  kEmergencyOff,
  kFault,
};

/// Names as kOrderNames.
enum class Order : std::uint8_t {
  kStop = 0,  // let the leg down by damping, then off
  kReady,     // home if needed, open the toes to the angle, go to the start of the path; stops gait
  kRun,       // as ready, then follow the path at the frequency
  kReset,     // clear latched faults; mode becomes off
  kRelease,   // give up ownership
};

/// Names as kOrderResultNames.
enum class OrderResult : std::uint8_t {
  kAccepted = 0,
  kBadCrc,
  kBadCounter,
  kNotOwner,
  kUnknownOrder,
  kOutOfRange,
  kWrongMode,
  kNoLeg,
  kNotConnected,
  kOtherDictionary,
  kNotCalibrated,
  kNoSync,
};

/// Names as kServiceNames.
enum class Service : std::uint8_t {
  kReadParameter = 0,
  kStoreParameters,
  kDefaultParameters,
  kCalibrateZero,
  kReadStatus,
  kReadFaultLog,
  kEraseFaultLog,
  kWriteParameter,  // only in answers: the request is a message of its own
};

/// Names as kServiceResultNames.
enum class ServiceResult : std::uint8_t {
  kDone = 0,
  kBadCounter,
  kNotOwner,
  kUnknownService,
  kNoSuchIndex,
  kOutOfRange,
  kWrongMode,
  kFlashFailed,
  kBusy,
  kNothingThere,
  kNoStorage,
  kNotConnected,
};

/// Names as kStatusNames.
enum class Status : std::uint8_t {
  kParameterCount = 0,
  kParameterTableHash,
  kStoredSequence,
  kLoadResult,
  kLogState,
  kLogUsed,
  kLogCapacity,
  kLogLost,
  kResetCause,
  kWordsPerRecord,
  kImageSlot,  // from here on of a board that can be updated: 0 is slot A, 1 slot B
  kImageVersion,
  kImageOnTrial,
  kImageHealthy,
  kSpareVersion,  // all ones where there is no image
  kSpareRefusal,  // update::Problem
  kUpdateState,
  kUpdateNextWord,
  kUpdateChecksum,  // of the image that is being brought
  kUpdateVersion,
  kUpdateProblem,
};

/// `index` of a ParameterWrite that is no parameter but a part of a firmware update. What each
/// does: app::UpdateDesk.
enum class UpdateObject : std::uint8_t {
  kOpen = 0xE0,
  kWord,
  kErase,
  kFinish,
  kRestart,
  kConfirm,
};

struct EmergencyStop {
  std::uint8_t source = 0;
  std::uint8_t counter = 0;

  static constexpr Message kMessage = Message::kEmergencyStop;
  static constexpr auto fields() {
    return std::tuple{&EmergencyStop::source, &EmergencyStop::counter};
  }
};

struct Sync {
  std::uint32_t tick = 0;

  static constexpr Message kMessage = Message::kSync;
  static constexpr auto fields() { return std::tuple{&Sync::tick}; }
};

/// Drive law: torque = kp (position - p) + kd (velocity - v) + torque_Nm, clipped by the drive.
struct DriveCommand {
  float position_rad = 0.0f;
  float velocity_rad_s = 0.0f;
  float kp_Nm_rad = 0.0f;
  float kd_Nm_s_rad = 0.0f;
  float torque_Nm = 0.0f;

  static constexpr auto fields() {
    return std::tuple{&DriveCommand::position_rad, &DriveCommand::velocity_rad_s,
                      &DriveCommand::kp_Nm_rad, &DriveCommand::kd_Nm_s_rad,
                      &DriveCommand::torque_Nm};
  }
};

struct DriveReply {
  std::uint8_t drive_id = 0;
  float position_rad = 0.0f;
  float velocity_rad_s = 0.0f;
  float torque_Nm = 0.0f;
  float temperature_C = 0.0f;
  std::uint8_t error = 0;

  static constexpr auto fields() {
    return std::tuple{&DriveReply::drive_id,       &DriveReply::position_rad,
                      &DriveReply::velocity_rad_s, &DriveReply::torque_Nm,
                      &DriveReply::temperature_C,  &DriveReply::error};
  }
};

struct SupervisorOrder {
  std::uint8_t supervisor_id = 0;
  Order order = Order::kStop;
  float toe_angle_rad = 0.0f;
  float frequency_Hz = 0.0f;
  std::uint8_t counter = 0;

  static constexpr Message kMessage = Message::kSupervisorOrder;
  static constexpr auto fields() {
    return std::tuple{&SupervisorOrder::supervisor_id, &SupervisorOrder::order,
                      &SupervisorOrder::toe_angle_rad, &SupervisorOrder::frequency_Hz,
                      &SupervisorOrder::counter};
  }
};

struct OrderAcknowledge {
  std::uint8_t supervisor_id = 0;
  std::uint8_t counter = 0;
  OrderResult result = OrderResult::kAccepted;
  Mode mode = Mode::kOff;
  std::uint8_t expected_counter = 0;
  std::uint8_t owner_id = 0;
  std::uint8_t reserved = 0;

  static constexpr Message kMessage = Message::kOrderAcknowledge;
  static constexpr auto fields() {
    return std::tuple{&OrderAcknowledge::supervisor_id,    &OrderAcknowledge::counter,
                      &OrderAcknowledge::result,           &OrderAcknowledge::mode,
                      &OrderAcknowledge::expected_counter, &OrderAcknowledge::owner_id,
                      &OrderAcknowledge::reserved};
  }
};

struct SupervisorConnect {
  std::uint8_t supervisor_id = 0;
  std::uint32_t protocol_hash = 0;
  std::uint8_t counter = 0;
  std::uint8_t reserved = 0;

  static constexpr Message kMessage = Message::kSupervisorConnect;
  static constexpr auto fields() {
    return std::tuple{&SupervisorConnect::supervisor_id, &SupervisorConnect::protocol_hash,
                      &SupervisorConnect::counter, &SupervisorConnect::reserved};
  }
};

struct ParameterWrite {
  std::uint8_t supervisor_id = 0;
  std::uint8_t index = 0;
  std::uint32_t value = 0;  // bits of a binary32
  std::uint8_t counter = 0;

  static constexpr Message kMessage = Message::kParameterWrite;
  static constexpr auto fields() {
    return std::tuple{&ParameterWrite::supervisor_id, &ParameterWrite::index,
                      &ParameterWrite::value, &ParameterWrite::counter};
  }
};

struct ServiceRequest {
  std::uint8_t supervisor_id = 0;
  Service service = Service::kReadParameter;
  std::uint8_t index = 0;
  std::uint16_t offset = 0;
  std::uint8_t reserved = 0;
  std::uint8_t counter = 0;

  static constexpr Message kMessage = Message::kServiceRequest;
  static constexpr auto fields() {
    return std::tuple{&ServiceRequest::supervisor_id, &ServiceRequest::service,
                      &ServiceRequest::index,         &ServiceRequest::offset,
                      &ServiceRequest::reserved,      &ServiceRequest::counter};
  }
};

struct ServiceAnswer {
  Service service = Service::kReadParameter;
  ServiceResult result = ServiceResult::kDone;
  std::uint8_t index = 0;
  std::uint8_t counter = 0;
  std::uint32_t value = 0;

  static constexpr Message kMessage = Message::kServiceAnswer;
  static constexpr auto fields() {
    return std::tuple{&ServiceAnswer::service, &ServiceAnswer::result, &ServiceAnswer::index,
                      &ServiceAnswer::counter, &ServiceAnswer::value};
  }
};

struct Heartbeat {
  Mode mode = Mode::kOff;
  std::uint8_t counter = 0;         // 4 bits
  std::uint32_t faults = 0;         // bits: kFaultBitNames
  std::uint32_t protocol_hash = 0;  // low 24 bits

  static constexpr Message kMessage = Message::kHeartbeat;
  static constexpr auto fields() {
    return std::tuple{&Heartbeat::mode, &Heartbeat::counter, &Heartbeat::faults,
                      &Heartbeat::protocol_hash};
  }
};

struct FootToe {
  float commanded_rad = 0.0f;
  float measured_rad = 0.0f;
  float torque_Nm = 0.0f;
  float temperature_C = 0.0f;
  bool moving = false;

  static constexpr Message kMessage = Message::kFootToe;
  static constexpr auto fields() {
    return std::tuple{&FootToe::commanded_rad, &FootToe::measured_rad, &FootToe::torque_Nm,
                      &FootToe::temperature_C, &FootToe::moving};
  }
};

struct FootLeg {
  float hip_rad = 0.0f;
  float knee_rad = 0.0f;
  float foot_x_m = 0.0f;
  float foot_z_m = 0.0f;

  static constexpr Message kMessage = Message::kFootLeg;
  static constexpr auto fields() {
    return std::tuple{&FootLeg::hip_rad, &FootLeg::knee_rad, &FootLeg::foot_x_m,
                      &FootLeg::foot_z_m};
  }
};

struct FootGround {
  float phase_cycles = 0.0f;
  float sinkage_m = 0.0f;
  float force_x_N = 0.0f;
  float force_z_N = 0.0f;
  bool contact = false;

  static constexpr Message kMessage = Message::kFootGround;
  static constexpr auto fields() {
    return std::tuple{&FootGround::phase_cycles, &FootGround::sinkage_m, &FootGround::force_x_N,
                      &FootGround::force_z_N, &FootGround::contact};
  }
};

struct FootGate {
  std::uint32_t interventions = 0;  // 28 bits
  std::uint16_t toe_limits = 0;     // bits: kLimitBitNames
  std::uint16_t hip_limits = 0;
  std::uint16_t knee_limits = 0;

  static constexpr Message kMessage = Message::kFootGate;
  static constexpr auto fields() {
    return std::tuple{&FootGate::interventions, &FootGate::toe_limits, &FootGate::hip_limits,
                      &FootGate::knee_limits};
  }
};

struct FootCounters {
  std::uint32_t ticks = 0;
  std::uint16_t missed_ticks = 0;
  std::uint16_t stale_syncs = 0;

  static constexpr Message kMessage = Message::kFootCounters;
  static constexpr auto fields() {
    return std::tuple{&FootCounters::ticks, &FootCounters::missed_ticks,
                      &FootCounters::stale_syncs};
  }
};

struct FootLoad {
  float toe_heat_ratio = 0.0f;
  float hip_heat_ratio = 0.0f;
  float knee_heat_ratio = 0.0f;
  float slip_m = 0.0f;
  float slip_ratio = 0.0f;
  float supply_V = 0.0f;
  std::uint8_t overruns = 0;

  static constexpr Message kMessage = Message::kFootLoad;
  static constexpr auto fields() {
    return std::tuple{&FootLoad::toe_heat_ratio,  &FootLoad::hip_heat_ratio,
                      &FootLoad::knee_heat_ratio, &FootLoad::slip_m,
                      &FootLoad::slip_ratio,      &FootLoad::supply_V,
                      &FootLoad::overruns};
  }
};

struct FootFrames {
  std::uint16_t unknown = 0;
  std::uint16_t malformed = 0;
  std::uint16_t bad_crc = 0;
  std::uint16_t refused = 0;

  static constexpr Message kMessage = Message::kFootFrames;
  static constexpr auto fields() {
    return std::tuple{&FootFrames::unknown, &FootFrames::malformed, &FootFrames::bad_crc,
                      &FootFrames::refused};
  }
};

}  // namespace hoof::firmware::protocol
