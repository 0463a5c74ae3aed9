#include "tools/cli/order.h"

#include "firmware/protocol/codec.h"
#include "hil_bridge/supervisor.h"
#include "tools/run/errors.h"

namespace hoof::tools {
namespace {

using namespace firmware::protocol;

std::string mode_name(Mode mode) {
  for (const ValueName& n : kModeNames) {
    if (n.value == std::uint32_t(mode)) return std::string(n.name);
  }
  return std::to_string(int(mode));
}

std::string seconds(std::int64_t ns) {
  return std::to_string(ns / 1'000'000'000) + "." + std::to_string(ns / 100'000'000 % 10) + " s";
}

}  // namespace

std::string give_order(hal::CanBus& bus, const hal::Clock& clock, const OrderRequest& request,
                       const std::function<void()>& idle) {
  bridge::Supervisor supervisor(bus, request.id);
  supervisor.order(request.order, request.toe_rad, request.frequency_Hz);
  const std::int64_t give_up_ns = clock.now_ns() + request.timeout_ns;
  while (clock.now_ns() < give_up_ns) {
    supervisor.poll(clock.now_ns());
    if (!supervisor.refusal().empty()) throw CannotFinish(supervisor.refusal());
    if (supervisor.accepted()) return mode_name(*supervisor.mode());
    idle();
  }
  throw CannotFinish(supervisor.heartbeat()
                         ? "the foot is there (mode " + mode_name(supervisor.heartbeat()->mode) +
                               ") but did not answer within " + seconds(request.timeout_ns)
                         : "nobody answers: no heartbeat of a foot within " +
                               seconds(request.timeout_ns) + "; is the firmware running on it?");
}

std::string press_emergency_stop(hal::CanBus& bus, const hal::Clock& clock, std::int64_t timeout_ns,
                                 const std::function<void()>& idle) {
  constexpr std::int64_t kRepeat_ns = spec(Message::kEmergencyStop).shortest_ms * 1'000'000;
  bridge::Supervisor supervisor(bus);  // gives no order: it listens to the heartbeat
  const std::int64_t start_ns = clock.now_ns();
  std::int64_t due_ns = start_ns;
  bool sent = false;
  while (clock.now_ns() < start_ns + timeout_ns) {
    if (clock.now_ns() >= due_ns) {
      sent = bus.send(encode(EmergencyStop{})) == hal::SendResult::kQueued || sent;
      due_ns = clock.now_ns() + kRepeat_ns;
    }
    supervisor.poll(clock.now_ns());
    if (supervisor.mode() == Mode::kEmergencyOff) return mode_name(*supervisor.mode());
    idle();
  }
  throw CannotFinish(std::string(sent ? "the e-stop frame was sent" : "no e-stop could be sent") +
                     ", but no foot has told within " + seconds(timeout_ns) +
                     " that it has stopped");
}

}  // namespace hoof::tools
