#include "firmware/app/service_desk.h"

#include <bit>

#include "firmware/control/math.h"
#include "firmware/safety/limits.h"

namespace hoof::firmware::app {

using control::Mode;
using protocol::Service;
using protocol::ServiceResult;
using protocol::Status;

namespace {

ServiceResult result_of(StoreResult result) {
  switch (result) {
    case StoreResult::kOk:
      return ServiceResult::kDone;
    case StoreResult::kWrongMode:
      return ServiceResult::kWrongMode;
    case StoreResult::kOutOfRange:
      return ServiceResult::kOutOfRange;
    case StoreResult::kTooLarge:
    case StoreResult::kFlashFailed:
      return ServiceResult::kFlashFailed;
  }
  return ServiceResult::kFlashFailed;
}

ServiceResult result_of(EraseResult result) {
  switch (result) {
    case EraseResult::kOk:
      return ServiceResult::kDone;
    case EraseResult::kWrongMode:
      return ServiceResult::kWrongMode;
    case EraseResult::kBusy:
      return ServiceResult::kBusy;
    case EraseResult::kFlashFailed:
      return ServiceResult::kFlashFailed;
  }
  return ServiceResult::kFlashFailed;
}

}  // namespace

protocol::ServiceAnswer ServiceDesk::handle(const protocol::ServiceRequest& request, Mode mode,
                                            std::int64_t now_ns) {
  const Outcome outcome = serve(request, mode, now_ns);
  return {request.service, outcome.result, request.index, request.counter, outcome.value};
}

protocol::ServiceAnswer ServiceDesk::handle(const protocol::ParameterWrite& write, Mode mode,
                                            std::int64_t now_ns) {
  Outcome outcome = admit(write.supervisor_id, write.counter, mode, now_ns);
  if (outcome.result == ServiceResult::kDone) {
    outcome = UpdateDesk::owns(write.index) ? write_update(write.index, write.value)
                                            : write_parameter(write.index, write.value);
  }
  return {Service::kWriteParameter, outcome.result, write.index, write.counter, outcome.value};
}

bool ServiceDesk::take_changed() {
  const bool changed = changed_;
  changed_ = false;
  return changed;
}

/// May this word change something? A granted one counts, carried out or not.
ServiceDesk::Outcome ServiceDesk::admit(std::uint8_t supervisor_id, std::uint8_t counter, Mode mode,
                                        std::int64_t now_ns) {
  ownership_.hear(supervisor_id, now_ns);
  switch (ownership_.judge(supervisor_id, counter, mode, now_ns)) {
    case Ownership::Standing::kNotConnected:
      return {ServiceResult::kNotConnected};
    case Ownership::Standing::kNotOwner:
      return {ServiceResult::kNotOwner};
    case Ownership::Standing::kBadCounter:
      return {ServiceResult::kBadCounter, ownership_.expected_counter()};
    case Ownership::Standing::kGranted:
      break;
  }
  ownership_.count();
  if (mode != Mode::kOff) return {ServiceResult::kWrongMode};
  ownership_.own(supervisor_id, now_ns);
  return {ServiceResult::kDone};
}

ServiceDesk::Outcome ServiceDesk::serve(const protocol::ServiceRequest& request, Mode mode,
                                        std::int64_t now_ns) {
  if (!ownership_.connected(request.supervisor_id, now_ns)) return {ServiceResult::kNotConnected};
  ownership_.hear(request.supervisor_id, now_ns);
  switch (request.service) {
    case Service::kReadParameter:
      return read_parameter(request.index);
    case Service::kReadStatus:
      return read_status(request.index);
    case Service::kReadFaultLog:
      return read_fault_log(request.index, request.offset);
    case Service::kStoreParameters:
    case Service::kDefaultParameters:
    case Service::kCalibrateZero:
    case Service::kEraseFaultLog:
      return change(request, mode, now_ns);
    case Service::kWriteParameter:
      break;  // has a message of its own
  }
  return {ServiceResult::kUnknownService};
}

ServiceDesk::Outcome ServiceDesk::change(const protocol::ServiceRequest& request, Mode mode,
                                         std::int64_t now_ns) {
  const Outcome admitted = admit(request.supervisor_id, request.counter, mode, now_ns);
  if (admitted.result != ServiceResult::kDone) return admitted;
  switch (request.service) {
    case Service::kStoreParameters:
      return store(mode);
    case Service::kDefaultParameters:
      parameters_ = {};
      changed_ = true;
      return {ServiceResult::kDone};
    case Service::kCalibrateZero:
      return calibrate(request.index, now_ns);
    default:
      return erase_fault_log(mode);
  }
}

ServiceDesk::Outcome ServiceDesk::read_parameter(std::uint8_t index) {
  const auto table = parameter_table();
  if (index >= table.size()) return {ServiceResult::kNoSuchIndex};
  return {ServiceResult::kDone, std::bit_cast<std::uint32_t>(table[index].value(parameters_))};
}

ServiceDesk::Outcome ServiceDesk::write_parameter(std::uint8_t index, std::uint32_t bits) {
  const auto table = parameter_table();
  if (index >= table.size()) return {ServiceResult::kNoSuchIndex};
  const ParameterEntry& entry = table[index];
  const float value = std::bit_cast<float>(bits);
  if (set(parameters_, entry, value) != SetResult::kOk) return {ServiceResult::kOutOfRange};
  changed_ = true;
  return {ServiceResult::kDone, bits};
}

ServiceDesk::Outcome ServiceDesk::write_update(std::uint8_t index, std::uint32_t value) {
  if (update_ == nullptr) return {ServiceResult::kNoStorage};
  return {update_->write(index, value), value};
}

ServiceDesk::Outcome ServiceDesk::store(Mode mode) {
  if (storage_ == nullptr) return {ServiceResult::kNoStorage};
  const ServiceResult result = result_of(storage_->store(parameters_, mode));
  return {result, storage_->report().sequence};
}

/// The joint stands at its mark: what the drive reads there, less the mark's angle, is its zero.
ServiceDesk::Outcome ServiceDesk::calibrate(std::uint8_t joint, std::int64_t now_ns) {
  if (joint >= control::kJointCount || !parameters_.presence().has(joint)) {
    return {ServiceResult::kNoSuchIndex};
  }
  const bool homes =
      joint == index(control::Joint::kToe) && parameters_.control.homing.absolute_encoder == 0.0f;
  if (homes) return {ServiceResult::kNoSuchIndex};  // a relative count has no zero to keep
  const control::JointState& state = inbox_.joints()[joint];
  if (!state.received || now_ns - state.received_ns > safety::kFreshness_ns) {
    return {ServiceResult::kNothingThere};
  }
  constexpr float kStandstill_rad_s = 0.06f;  // three codes of the reply's velocity
  if (control::absolute(state.velocity_rad_s) > kStandstill_rad_s) return {ServiceResult::kBusy};
  JointCalibration& calibration = parameters_.calibration[joint];
  const float zero_rad = state.reading_rad - calibration.mark_rad;
  // A turn more or less is the same place to an encoder, but not to the drive's own count.
  if (!(control::absolute(zero_rad) <= kLargestZero_rad)) return {ServiceResult::kOutOfRange};
  calibration.zero_rad = zero_rad;
  calibration.done = 1.0f;
  changed_ = true;
  return {ServiceResult::kDone, std::bit_cast<std::uint32_t>(zero_rad)};
}

ServiceDesk::Outcome ServiceDesk::read_status(std::uint8_t index) const {
  const auto answer = [](std::size_t value) {
    return Outcome{ServiceResult::kDone, static_cast<std::uint32_t>(value)};
  };
  switch (static_cast<Status>(index)) {
    case Status::kParameterCount:
      return answer(parameter_table().size());
    case Status::kParameterTableHash:
      return answer(parameter_table_hash());
    case Status::kResetCause:
      return answer(static_cast<std::size_t>(reset_cause_));
    case Status::kWordsPerRecord:
      return answer(kFaultRecordWords);
    default:
      break;
  }
  if (index > static_cast<std::uint8_t>(Status::kUpdateProblem)) {
    return {ServiceResult::kNoSuchIndex};
  }
  if (index >= static_cast<std::uint8_t>(Status::kImageSlot)) {
    const auto value =
        update_ == nullptr ? std::nullopt : update_->status(static_cast<Status>(index));
    return value ? answer(*value) : Outcome{ServiceResult::kNoStorage};
  }
  if (storage_ == nullptr) return {ServiceResult::kNoStorage};
  const FaultLog& log = storage_->fault_log();
  switch (static_cast<Status>(index)) {
    case Status::kStoredSequence:
      return answer(storage_->report().sequence);
    case Status::kLoadResult:
      return answer(static_cast<std::size_t>(storage_->report().result));
    case Status::kLogState:
      return answer(static_cast<std::size_t>(log.state()));
    case Status::kLogUsed:
      return answer(log.used());
    case Status::kLogCapacity:
      return answer(log.capacity());
    default:
      return answer(log.lost());
  }
}

ServiceDesk::Outcome ServiceDesk::read_fault_log(std::uint8_t slot, std::uint16_t word) const {
  if (storage_ == nullptr) return {ServiceResult::kNoStorage};
  const FaultLog& log = storage_->fault_log();
  if (slot >= log.used() || log.state() == LogState::kOtherLayout) {
    return {ServiceResult::kNothingThere};
  }
  if (word >= kFaultRecordWords) return {ServiceResult::kNoSuchIndex};
  return {ServiceResult::kDone, log.word(slot, word)};
}

ServiceDesk::Outcome ServiceDesk::erase_fault_log(Mode mode) {
  if (storage_ == nullptr) return {ServiceResult::kNoStorage};
  return {result_of(storage_->fault_log().erase(mode))};
}

}  // namespace hoof::firmware::app
