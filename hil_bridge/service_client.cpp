#include "hil_bridge/service_client.h"

#include <algorithm>
#include <bit>
#include <string>
#include <utility>

#include "firmware/app/parameters.h"
#include "firmware/protocol/codec.h"
#include "firmware/protocol/protocol_hash.h"

namespace hoof::bridge {

using namespace firmware::protocol;

namespace {

constexpr std::int64_t kRepeat_ns = 50'000'000;  // an unanswered word is sent again after this
/// Storing may keep the foot silent for half a second.
constexpr std::int64_t kRepeatChange_ns = 1'000'000'000;

std::string name_of(std::span<const ValueName> names, std::uint32_t value) {
  for (const ValueName& n : names) {
    if (n.value == value) return std::string(n.name);
  }
  return std::to_string(value);
}

[[noreturn]] void refuse(const ServiceAnswer& answer) {
  throw ServiceError(
      "the foot refused '" + name_of(kServiceNames, static_cast<std::uint32_t>(answer.service)) +
      "': " + name_of(kServiceResultNames, static_cast<std::uint32_t>(answer.result)));
}

}  // namespace

ServiceClient::ServiceClient(hal::CanBus& bus, const hal::Clock& clock, std::function<void()> idle,
                             std::uint8_t id, std::int64_t timeout_ns)
    : bus_(bus), clock_(clock), idle_(std::move(idle)), id_(id), timeout_ns_(timeout_ns) {}

void ServiceClient::connect() {
  say_hello();
  const std::uint32_t theirs = status(Status::kParameterTableHash);
  if (theirs != firmware::app::parameter_table_hash()) {
    throw ServiceError("the foot's firmware has another table of parameters than this program");
  }
}

float ServiceClient::read_parameter(std::uint8_t index) {
  return std::bit_cast<float>(request(Service::kReadParameter, index).value);
}

void ServiceClient::write_parameter(std::uint8_t index, float value) {
  change(Service::kWriteParameter, index, std::bit_cast<std::uint32_t>(value));
}

std::uint32_t ServiceClient::store_parameters() {
  return change(Service::kStoreParameters).value;
}

void ServiceClient::default_parameters() {
  change(Service::kDefaultParameters);
}

float ServiceClient::calibrate_zero(std::uint8_t joint) {
  return std::bit_cast<float>(change(Service::kCalibrateZero, joint).value);
}

ServiceResult ServiceClient::write_update(UpdateObject object, std::uint32_t value,
                                          std::int64_t repeat_ns) {
  const auto index = static_cast<std::uint8_t>(object);
  const std::uint8_t counter = counter_;
  const Answer answer = exchange(frame(Service::kWriteParameter, index, 0, value, counter),
                                 Service::kWriteParameter, index, counter, repeat_ns);
  switch (answer.result) {
    case ServiceResult::kBadCounter:
      counter_ = static_cast<std::uint8_t>(answer.value);
      break;
    case ServiceResult::kNotConnected:
      say_hello();
      break;
    case ServiceResult::kNotOwner:
      break;  // was not counted
    default:
      counter_ = static_cast<std::uint8_t>(counter + 1);
  }
  return answer.result;
}

void ServiceClient::wait_until(std::int64_t time_ns) {
  while (clock_.now_ns() < time_ns) idle_();
}

std::uint32_t ServiceClient::status(Status what) {
  const Answer answer = request(Service::kReadStatus, static_cast<std::uint8_t>(what));
  if (answer.result != ServiceResult::kDone) refuse(answer);
  return answer.value;
}

std::optional<std::uint32_t> ServiceClient::stored_status(Status what) {
  const Answer answer = request(Service::kReadStatus, static_cast<std::uint8_t>(what));
  if (answer.result == ServiceResult::kNoStorage) return std::nullopt;
  if (answer.result != ServiceResult::kDone) refuse(answer);
  return answer.value;
}

std::optional<firmware::app::FaultRecord> ServiceClient::read_fault(std::uint8_t slot) {
  firmware::app::FaultRecordWords words{};
  for (std::size_t i = 0; i < words.size(); ++i) {
    const Answer answer = request(Service::kReadFaultLog, slot, static_cast<std::uint16_t>(i));
    if (answer.result != ServiceResult::kDone) refuse(answer);
    words[i] = answer.value;
  }
  return firmware::app::decode(words);
}

void ServiceClient::erase_fault_log() {
  change(Service::kEraseFaultLog);
}

/// Asks for something that changes nothing; a refusal is the caller's to judge, but for a
/// connection that has lapsed.
ServiceClient::Answer ServiceClient::request(Service service, std::uint8_t index,
                                             std::uint16_t offset) {
  for (int attempt = 0;; ++attempt) {
    const std::uint8_t tag = ++tag_;
    const Answer answer =
        exchange(frame(service, index, offset, 0, tag), service, index, tag, kRepeat_ns);
    if (answer.result != ServiceResult::kNotConnected || attempt > 0) {
      if (service == Service::kReadParameter && answer.result != ServiceResult::kDone) {
        refuse(answer);
      }
      return answer;
    }
    say_hello();
  }
}

/// Asks for a change. A counter that is not the expected one is learnt from, once; an answer lost
/// on the way shows as such a counter, too, and the change is then asked for again: each of them
/// may be done twice.
ServiceClient::Answer ServiceClient::change(Service service, std::uint8_t index,
                                            std::uint32_t value) {
  for (int attempt = 0;; ++attempt) {
    const std::uint8_t counter = counter_;
    const Answer answer = exchange(frame(service, index, 0, value, counter), service, index,
                                   counter, kRepeatChange_ns);
    if (answer.result == ServiceResult::kDone) {
      counter_ = static_cast<std::uint8_t>(counter + 1);
      return answer;
    }
    if (attempt >= 3) refuse(answer);
    if (answer.result == ServiceResult::kBadCounter) {
      counter_ = static_cast<std::uint8_t>(answer.value);
    } else if (answer.result == ServiceResult::kNotConnected) {
      say_hello();
    } else {
      refuse(answer);
    }
  }
}

hal::CanFrame ServiceClient::frame(Service service, std::uint8_t index, std::uint16_t offset,
                                   std::uint32_t value, std::uint8_t counter) const {
  if (service == Service::kWriteParameter) {
    return encode(ParameterWrite{id_, index, value, counter});
  }
  return encode(ServiceRequest{id_, service, index, offset, 0, counter});
}

ServiceClient::Answer ServiceClient::exchange(const hal::CanFrame& frame, Service service,
                                              std::uint8_t index, std::uint8_t counter,
                                              std::int64_t repeat_ns) {
  Answer answer;
  const auto matches = [&](const hal::CanFrame& received) {
    return decode(received, answer) == DecodeResult::kOk && answer.service == service &&
           answer.index == index && answer.counter == counter;
  };
  const std::int64_t give_up_ns = clock_.now_ns() + timeout_ns_;
  while (clock_.now_ns() < give_up_ns) {
    send(frame);
    if (listen(std::min(give_up_ns, clock_.now_ns() + repeat_ns), matches)) return answer;
  }
  throw ServiceError("the foot did not answer '" +
                     name_of(kServiceNames, static_cast<std::uint32_t>(service)) + "' within " +
                     std::to_string(timeout_ns_ / 1'000'000) + " ms");
}

void ServiceClient::say_hello() {
  OrderAcknowledge answer;
  const std::uint8_t tag = ++tag_;
  const auto matches = [&](const hal::CanFrame& received) {
    return decode(received, answer) == DecodeResult::kOk && answer.supervisor_id == id_ &&
           answer.counter == tag;
  };
  const std::int64_t give_up_ns = clock_.now_ns() + timeout_ns_;
  while (clock_.now_ns() < give_up_ns) {
    send(encode(SupervisorConnect{id_, kProtocolHash, tag}));
    if (!listen(std::min(give_up_ns, clock_.now_ns() + kRepeat_ns), matches)) continue;
    counter_ = answer.expected_counter;
    if (answer.result == OrderResult::kAccepted) return;
    throw ServiceError("the foot refuses this program: " +
                       name_of(kOrderResultNames, static_cast<std::uint32_t>(answer.result)));
  }
  throw ServiceError("nobody answers within " + std::to_string(timeout_ns_ / 1'000'000) +
                     " ms; is the firmware running on that bus?");
}

template <typename Match>
bool ServiceClient::listen(std::int64_t until_ns, const Match& match) {
  while (clock_.now_ns() < until_ns) {
    hal::CanFrame frame;
    while (bus_.receive(frame)) {
      if (match(frame)) return true;
    }
    idle_();
  }
  return false;
}

void ServiceClient::send(const hal::CanFrame& frame) {
  const std::int64_t give_up_ns = clock_.now_ns() + kRepeat_ns;
  while (bus_.send(frame) != hal::SendResult::kQueued && clock_.now_ns() < give_up_ns) idle_();
}

}  // namespace hoof::bridge
