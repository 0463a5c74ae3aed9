#include "hil_bridge/remote_line.h"

#include <optional>
#include <stdexcept>

#include "firmware/protocol/codec.h"
#include "firmware/protocol/protocol_hash.h"
#include "hal/monotonic_clock.h"

namespace hoof::bridge {
namespace {

/// That of the run's own supervisor: two would have to ask each other for the foot.
constexpr std::uint8_t kSupervisorId = 1;
constexpr std::int64_t kLook_ns = 1'000'000;
/// Of one foot, at 10 Hz; of two feet at least four come.
constexpr std::int64_t kTwoHeartbeats_ns = 220'000'000;

std::unique_ptr<hal::SocketCanBus> open(const std::string& interface) {
  hal::SocketCanSettings settings;
  settings.interface = interface;
  settings.batched = true;  // lock-step spends more time in calls of the kernel than in thinking
  return std::make_unique<hal::SocketCanBus>(settings);
}

std::string seconds(std::int64_t t_ns) {
  const std::string text = std::to_string(double(t_ns) * 1e-9);
  return text.substr(0, text.find('.') + 2) + " s";
}

}  // namespace

RemoteLine::RemoteLine(const std::string& interfaces) : name_(interfaces) {
  const std::size_t comma = interfaces.find(',');
  bus0_ = open(interfaces.substr(0, comma));
  if (comma == std::string::npos) return;
  const std::string second = interfaces.substr(comma + 1);
  if (second != interfaces.substr(0, comma)) bus1_ = open(second);
}

std::string RemoteLine::advice() const {
  return "start it with `hoof-firmware --clock lock-step`, or go with --clock real-time (a board "
         "can only do that)";
}

bool RemoteLine::flush() {
  const bool all1 = !bus1_ || bus1_->flush() == hal::SendResult::kQueued;
  return all1 && bus0_->flush() == hal::SendResult::kQueued;
}

std::uint64_t RemoteLine::dropped() const {
  return bus0_->status().dropped + (bus1_ ? bus1_->status().dropped : 0);
}

void RemoteLine::await_heartbeat(std::int64_t timeout_ns, const std::function<bool()>& stopped) {
  const hal::MonotonicClock clock;
  std::int64_t give_up_ns = clock.now_ns() + timeout_ns;
  std::optional<std::uint8_t> counter;
  hal::CanFrame frame;
  while (clock.now_ns() < give_up_ns) {
    if (stopped && stopped())
      throw std::runtime_error(name_ + ": stopped while waiting for a foot");
    bus0_->wait(kLook_ns);
    while (bus0_->receive(frame)) {
      firmware::protocol::Heartbeat heartbeat;
      if (decode(frame, heartbeat) != firmware::protocol::DecodeResult::kOk) continue;
      if (heartbeat.protocol_hash != firmware::protocol::kHeartbeatHash) {
        throw std::runtime_error(name_ +
                                 ": the firmware speaks another dictionary: its protocol hash is " +
                                 std::to_string(heartbeat.protocol_hash) + ", ours " +
                                 std::to_string(firmware::protocol::kHeartbeatHash));
      }
      // Two feet would answer every SYNC twice, and whose answer counts would be chance.
      if (counter && heartbeat.counter != ((*counter + 1) & 0xF)) {
        throw std::runtime_error(name_ +
                                 ": more than one foot is on this bus (their heartbeats do not "
                                 "count on from each other); stop all but one hoof-firmware");
      }
      if (!counter) give_up_ns = clock.now_ns() + kTwoHeartbeats_ns;
      counter = heartbeat.counter;
    }
  }
  if (counter) return;
  throw std::runtime_error(name_ + ": no heartbeat of a foot within " + seconds(timeout_ns) +
                           "; is hoof-firmware (or the board) running on that bus?");
}

bool RemoteLine::hears_foot(std::int64_t longest_ns) {
  const hal::MonotonicClock clock;
  const std::int64_t give_up_ns = clock.now_ns() + longest_ns;
  hal::CanFrame frame;
  while (clock.now_ns() < give_up_ns) {
    bus0_->wait(kLook_ns);
    while (bus0_->receive(frame)) {
      firmware::protocol::Heartbeat heartbeat;
      if (decode(frame, heartbeat) == firmware::protocol::DecodeResult::kOk) return true;
    }
  }
  return false;
}

std::vector<std::string> RemoteLine::pass_parameters(const firmware::app::Parameters& parameters,
                                                     std::int64_t timeout_ns) {
  const hal::MonotonicClock clock;
  ServiceClient client(
      *bus0_, clock, [this] { bus0_->wait(kLook_ns); }, kSupervisorId, timeout_ns);
  try {
    return pass_parameters(client, parameters);
  } catch (const ServiceError& error) {
    throw std::runtime_error(name_ + ": " + error.what() +
                             "; parameters are set in mode off only, which a foot leaves by an "
                             "e-stop or a fault until `hoof command reset --bus " +
                             name_ + "`");
  }
}

std::vector<std::string> RemoteLine::pass_parameters(
    ServiceClient& client, const firmware::app::Parameters& parameters) const {
  client.connect();
  firmware::app::Parameters wanted = parameters;
  std::vector<std::string> changed;
  std::uint8_t index = 0;
  for (const firmware::app::ParameterEntry& entry : firmware::app::parameter_table()) {
    const float value = entry.value(wanted);
    if (client.read_parameter(index) != value) {
      client.write_parameter(index, value);
      if (client.read_parameter(index) != value) {
        throw std::runtime_error(name_ + ": the foot did not take the parameter " +
                                 std::string(entry.name));
      }
      changed.emplace_back(entry.name);
    }
    ++index;
  }
  return changed;
}

}  // namespace hoof::bridge
