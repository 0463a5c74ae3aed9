#include "hil_bridge/remote_foot.h"

#include <chrono>
#include <limits>
#include <stdexcept>
#include <thread>

#include "firmware/protocol/dictionary.h"
#include "hal/monotonic_clock.h"

namespace hoof::bridge {

namespace lock_step = hal::lock_step;
using firmware::protocol::kMessages;
using firmware::protocol::MessageSpec;
using firmware::protocol::Node;

namespace {

constexpr std::int64_t kLook_ns = 20'000'000;
constexpr auto kFullSleep = std::chrono::microseconds(100);
constexpr std::int64_t kNever_ns = std::numeric_limits<std::int64_t>::max();
/// Visitors' frames that may be on their way over the simulated wires at once.
constexpr std::size_t kMostVisitors = 1024;

const MessageSpec* message_of(const hal::CanFrame& frame) {
  if (frame.extended) return nullptr;
  for (const MessageSpec& message : kMessages) {
    if (message.id == frame.id) return &message;
  }
  return nullptr;
}

/// A drive's reply changes what the firmware knows and nothing that it sends before the next SYNC.
bool is_reply(const hal::CanFrame& frame) {
  const MessageSpec* message = message_of(frame);
  return message != nullptr &&
         (message->sender == Node::kToeDrive || message->sender == Node::kHipDrive ||
          message->sender == Node::kKneeDrive);
}

bool is_command(const MessageSpec& message) {
  return message.receiver == Node::kToeDrive || message.receiver == Node::kHipDrive ||
         message.receiver == Node::kKneeDrive;
}

}  // namespace

RemoteFoot::RemoteFoot(FootLine& line, std::array<hal::CanBus*, kBusCount> buses,
                       std::array<hal::CanBus*, kBusCount> visitors, const hal::Clock& clock,
                       std::int64_t patience_ns)
    : line_(line), buses_(buses), visitors_(visitors), clock_(clock), patience_ns_(patience_ns) {
  // What was said before the run is none of its frames.
  hal::CanFrame stale;
  for (int bus = 0; bus < kBusCount; ++bus) {
    while (line_.bus(bus).receive(stale)) {
    }
  }
  send(0, lock_step::begin());
  if (!await_done(0)) {
    throw std::runtime_error(line_.foot() + " does not go in lock-step; " + line_.advice());
  }
  for (auto& frames : waiting_) frames.clear();
}

RemoteFoot::~RemoteFoot() {
  line_.bus(0).send(lock_step::end());
  line_.flush();
}

void RemoteFoot::poll(std::uint32_t tick) {
  flush();
  const bool asks = forward_arrivals();
  if (!lost_.empty()) return;
  const std::int64_t now_ns = clock_.now_ns();
  const bool answer = asks || now_ns >= due_ns_;
  if (!answer) return;
  go(true);
  if (await_done(now_ns)) {
    flush();
    return;
  }
  const std::string sync = "SYNC " + std::to_string(tick);
  const std::string why = line_.gone();
  lost_ = line_.foot();
  if (left_ || !why.empty()) {
    lost_ += " ended before it answered " + sync + (why.empty() ? "" : ": " + why);
  } else {
    lost_ +=
        " did not answer " + sync + " within " + std::to_string(patience_ns_ / 1'000'000) + " ms";
  }
}

/// @return true where the firmware may have something to say to what came
bool RemoteFoot::forward_arrivals() {
  bool any = false, asks = false;
  hal::CanFrame frame;
  // As the loop itself does: bus 1 first, so that its replies are there when SYNC comes.
  for (int bus = kBusCount - 1; bus >= 0; --bus) {
    while (buses_[bus]->receive(frame)) {
      telemetry_.take(frame, clock_.now_ns());
      if (is_visitor_s(frame)) continue;
      any = true;
      asks = asks || !is_reply(frame);
      const MessageSpec* message = message_of(frame);
      const bool also_on_bus0 =
          message != nullptr && (message->buses & firmware::protocol::kBus0) != 0;
      // On one interface the firmware could not tell it from that of bus 0; it does not act on it.
      if (bus == 1 && also_on_bus0 && line_.one_interface()) continue;
      if (lost_.empty()) send(bus, frame);
    }
  }
  if (!any || asks || clock_.now_ns() >= due_ns_ || !lost_.empty()) return asks;
  // Two interfaces keep no order among each other: each moment must be over before the next one.
  if (!line_.one_interface()) return true;
  go(false);  // on its way with the next one that is waited for
  return false;
}

bool RemoteFoot::is_visitor_s(const hal::CanFrame& frame) {
  for (auto it = visitors_frames_.begin(); it != visitors_frames_.end(); ++it) {
    if (!(*it == frame)) continue;
    visitors_frames_.erase(it);
    return true;
  }
  return false;
}

void RemoteFoot::send(int bus, const hal::CanFrame& frame) {
  while (line_.bus(bus).send(frame) != hal::SendResult::kQueued) flush_line();
}

void RemoteFoot::flush_line() {
  if (line_.flush()) return;
  const hal::MonotonicClock wall;
  const std::int64_t give_up_ns = wall.now_ns() + patience_ns_;
  while (!line_.flush()) {
    if (wall.now_ns() >= give_up_ns) {
      throw std::runtime_error(line_.foot() + ": the interface takes no more frames");
    }
    std::this_thread::sleep_for(kFullSleep);
  }
}

void RemoteFoot::go(bool answer) {
  lock_step::Go go;
  go.time_ns = clock_.now_ns();
  go.answer = answer;
  for (int bus = 0; bus < kBusCount; ++bus) {
    go.bus_off[bus] = buses_[bus]->status().bus_off;
    go.free[bus] = free_mailboxes(bus);
  }
  send(0, encode(go));
}

/// @return false where no answer came in time, or none will
bool RemoteFoot::await_done(std::int64_t time_ns) {
  flush_line();
  const hal::MonotonicClock wall;
  std::int64_t give_up_ns = kNever_ns;
  hal::CanFrame frame;
  do {
    line_.wait(kLook_ns);
    if (!line_.one_interface()) {
      while (line_.bus(1).receive(frame)) take(1, frame, time_ns);
    }
    while (line_.bus(0).receive(frame)) {
      if (!take(0, frame, time_ns)) continue;
      // Sent before Done, and on another interface.
      while (!line_.one_interface() && line_.bus(1).receive(frame)) take(1, frame, time_ns);
      return true;
    }
    // An answer that comes with the first look, as nearly all do, needs no clock.
    if (give_up_ns == kNever_ns) give_up_ns = wall.now_ns() + patience_ns_;
  } while (!left_ && line_.gone().empty() && wall.now_ns() < give_up_ns);
  return false;
}

/// @return true for the Done that is waited for
bool RemoteFoot::take(int interface, const hal::CanFrame& frame, std::int64_t time_ns) {
  if (const auto done = lock_step::decode_done(frame)) {
    if (done->time_us != lock_step::microseconds(time_ns)) return false;  // of another life
    due_ns_ = done->due_in_us == lock_step::Done::kNever_us
                  ? kNever_ns
                  : time_ns + std::int64_t{done->due_in_us} * 1000;
    return true;
  }
  if (lock_step::is_any(frame)) {
    left_ = left_ || lock_step::is_end(frame);
    return false;
  }
  const MessageSpec* message = message_of(frame);
  const bool on_bus0 = message == nullptr || (message->buses & firmware::protocol::kBus0) != 0;
  const int bus = line_.one_interface() ? (on_bus0 ? 0 : 1) : interface;
  if (message != nullptr && message->sender == Node::kFoot) {
    telemetry_.take(frame, clock_.now_ns());
    // As the firmware does where it can: a socket cannot call back what it was given.
    if (is_command(*message)) buses_[bus]->withdraw(frame.id);
    put_on_wire(bus, frame);
  } else if (visitors_frames_.size() < kMostVisitors) {
    if (visitors_[bus]->send(frame) == hal::SendResult::kQueued) visitors_frames_.push_back(frame);
  }
  return false;
}

void RemoteFoot::put_on_wire(int bus, const hal::CanFrame& frame) {
  if (!waiting_[bus].empty() || buses_[bus]->send(frame) != hal::SendResult::kQueued) {
    waiting_[bus].push_back(frame);
  }
}

int RemoteFoot::free_mailboxes(int bus) const {
  return std::max(0, int(buses_[bus]->status().free) - int(waiting_[bus].size()));
}

/// Only where the wires' connection does not tell how many it takes can anything wait here.
void RemoteFoot::flush() {
  for (int bus = 0; bus < kBusCount; ++bus) {
    auto& frames = waiting_[bus];
    while (!frames.empty() && buses_[bus]->send(frames.front()) == hal::SendResult::kQueued) {
      frames.pop_front();
    }
  }
}

}  // namespace hoof::bridge
