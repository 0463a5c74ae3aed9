#include "tools/replay/replay.h"

#include <array>
#include <cstdio>
#include <stdexcept>

#include "firmware/protocol/codec.h"
#include "hal/can_arbitration.h"
#include "hal/can_frame_check.h"
#include "hal/can_timing.h"
#include "hal/in_process/soft_board.h"
#include "hal/stepped_clock.h"
#include "tools/log/decoded_frame.h"
#include "tools/replay/replay_bus.h"
#include "tools/run/sha256.h"

namespace hoof::tools {
namespace {

namespace protocol = firmware::protocol;

/// A frame waits for the wire no longer than this on a bus that is not overloaded.
constexpr std::int64_t kLongestWait_ns = 20'000'000;

bool from_foot(const hal::CanFrame& frame) {
  const MessageSpec* message = find_message(frame);
  return message != nullptr && message->sender == protocol::Node::kFoot;
}

/// From the start of the frame to the end of its EOF, where the recording stamps it.
std::int64_t duration_ns(const hal::CanFrame& frame) {
  return hal::frame_time_ns(frame) - hal::bit_time_ns({hal::kIntermissionBits, 0}, hal::BitRates{});
}

std::string shown(const hal::CanFrame& frame) {
  const std::string bytes = payload_hex(frame);
  return bytes.empty() ? "no data" : bytes;
}

std::string difference_of_signals(const MessageSpec& message, const hal::CanFrame& recorded,
                                  const hal::CanFrame& replayed) {
  const std::string_view before = drive_switch(message, recorded);
  const std::string_view now = drive_switch(message, replayed);
  if (before != now) {
    return std::string(": recorded ") + (before.empty() ? "a command" : std::string(before)) +
           ", now " + (now.empty() ? "a command" : std::string(now));
  }
  std::string text;
  for (const Signal& signal : message.signals) {
    const double was = value_of(signal, recorded), is = value_of(signal, replayed);
    if (raw_of(recorded, signal) == raw_of(replayed, signal)) continue;
    text += (text.empty() ? ": " : "\n  ") + std::string(signal.name) + " recorded " +
            described_value(signal, was) + ", now " + described_value(signal, is);
  }
  return text.empty() ? ": format or length" : text;
}

class Replay {
 public:
  Replay(const BusRecording& recording, const bridge::RecordingFacts& facts,
         const ReplayOptions& options)
      : recording_(recording),
        options_(options),
        exchange_ns_(facts.exchange_ns),
        buses_{ReplayBus(facts.mailboxes), ReplayBus(facts.mailboxes)},
        firmware_({&buses_[0], &buses_[1]}, clock_, board_, facts.parameters) {}

  ReplayResult run() {
    std::int64_t now_ns = 0;
    std::size_t next = 0;
    while (next < recording_.frames.size() && !over()) {
      for (; next < recording_.frames.size() && !over(); ++next) {
        if (time_ns(recording_.frames[next]) > now_ns) break;
        take(recording_.frames[next]);
      }
      if (over()) break;
      clock_.advance_to(now_ns);
      poll(now_ns);
      now_ns += exchange_ns_;
    }
    if (!over()) look_for_extra(now_ns, kLongestWait_ns);
    result_.answers_sha256 = sha256_hex(answers_);
    return result_;
  }

 private:
  bool over() const { return result_.difference.has_value() || result_.stopped; }

  std::int64_t time_ns(const LoggedFrame& logged) const {
    return logged.stamp_ns - recording_.origin_ns;
  }

  void take(const LoggedFrame& logged) {
    const std::int64_t end_ns = time_ns(logged);
    const bool exists = hal::can_exist(logged.frame);
    const std::int64_t start_ns = exists ? end_ns - duration_ns(logged.frame) : end_ns;
    ReplayBus& bus = buses_[std::size_t(logged.bus)];
    const ReplayBus::Waiting* first = bus.next(start_ns);
    if (from_foot(logged.frame)) {
      compare(logged, bus, first);
      return;
    }
    // What would have won the wire must have done so in the recording.
    if (exists && first != nullptr &&
        hal::arbitration_key(first->frame) < hal::arbitration_key(logged.frame)) {
      differ(first->sent_ns, logged.bus, {}, first->frame);
      return;
    }
    hal::CanFrame frame = logged.frame;
    frame.stamp_ns = end_ns;
    bus.arrive(frame);
    ++result_.fed;
    if (frame.id == protocol::spec(protocol::Message::kSync).id && logged.bus == 0)
      note_sync(frame);
  }

  void note_sync(const hal::CanFrame& frame) {
    protocol::Sync sync;
    if (decode(frame, sync) == protocol::DecodeResult::kOk) arrived_tick_ = sync.tick;
  }

  void compare(const LoggedFrame& logged, ReplayBus& bus, const ReplayBus::Waiting* first) {
    if (first != nullptr && first->frame == logged.frame) {
      answers_ +=
          char('0' + logged.bus) + id_text(logged.frame) + '#' + payload_hex(logged.frame) + '\n';
      ++result_.compared;
      bus.remove(*first);
      return;
    }
    const ReplayBus::Waiting* same = bus.find(logged.frame.id);
    if (same != nullptr && !(same->frame == logged.frame)) {
      differ(same->sent_ns, logged.bus, logged.frame, same->frame);
    } else if (same != nullptr && first != nullptr) {
      differ(first->sent_ns, logged.bus, {}, first->frame);  // its turn came before
    } else {
      differ(time_ns(logged), logged.bus, logged.frame, {});
    }
  }

  void poll(std::int64_t now_ns) {
    for (ReplayBus& bus : buses_) bus.set_time(now_ns);
    const bool due = arrived_tick_ && (!run_tick_ || *arrived_tick_ != *run_tick_);
    const bool stop = due && options_.to_tick && *arrived_tick_ >= *options_.to_tick;
    if (stop && options_.at_tick) options_.at_tick(firmware_);
    firmware_.poll();
    if (due) run_tick_ = result_.last_tick = *arrived_tick_;
    look_for_extra(now_ns, kLongestWait_ns);
    if (!stop) return;
    result_.stopped = true;
    if (options_.after_tick) options_.after_tick(firmware_);
  }

  void look_for_extra(std::int64_t now_ns, std::int64_t longest_ns) {
    for (std::size_t b = 0; b < buses_.size() && !over(); ++b) {
      for (const ReplayBus::Waiting& w : buses_[b].waiting()) {
        if (now_ns - w.sent_ns <= longest_ns) continue;
        differ(w.sent_ns, int(b), {}, w.frame);
        return;
      }
    }
  }

  void differ(std::int64_t at_ns, int bus, std::optional<hal::CanFrame> recorded,
              std::optional<hal::CanFrame> replayed) {
    ReplayDifference d;
    d.tick = result_.last_tick;
    d.time_s = double(at_ns) * 1e-9;
    d.bus = bus;
    d.id = recorded ? recorded->id : replayed->id;
    d.recorded = std::move(recorded);
    d.replayed = std::move(replayed);
    result_.difference = std::move(d);
  }

  const BusRecording& recording_;
  const ReplayOptions& options_;
  std::int64_t exchange_ns_;
  hal::SteppedClock clock_;
  hal::SoftBoard board_;
  std::array<ReplayBus, 2> buses_;
  firmware::app::ControlLoop firmware_;
  std::optional<std::uint32_t> arrived_tick_, run_tick_;
  std::string answers_;
  ReplayResult result_;
};

}  // namespace

std::string ReplayDifference::text(const std::vector<std::string>& interfaces) const {
  const hal::CanFrame& any = recorded ? *recorded : *replayed;
  const MessageSpec* message = find_message(any);
  char where[120];
  std::snprintf(where, sizeof where, "tick %u, %.6f s, %s, ", tick, time_s,
                std::size_t(bus) < interfaces.size() ? interfaces[std::size_t(bus)].c_str() : "?");
  std::string text =
      where + std::string(message ? message->name : "frame") + " (0x" + id_text(any) + ")";
  if (!recorded) return text + ": not in the recording, now sent with " + shown(*replayed);
  if (!replayed) return text + ": recorded with " + shown(*recorded) + ", now not sent";
  if (message != nullptr) text += difference_of_signals(*message, *recorded, *replayed);
  return text + "\n  bytes recorded " + shown(*recorded) + ", now " + shown(*replayed);
}

ReplayResult replay(const BusRecording& recording, const bridge::RecordingFacts& facts,
                    const ReplayOptions& options) {
  if (facts.wires != "in_process") {
    throw std::invalid_argument(
        recording.path.string() + ": recorded over '" + facts.wires +
        "': its times are those of the recorder, not of the firmware's polls; only a lock-step run "
        "on the in-process bus can be replayed exactly");
  }
  if (facts.exchange_ns % 1000 != 0) {
    throw std::invalid_argument(
        recording.path.string() + ": exchange_ns = " + std::to_string(facts.exchange_ns) +
        ": polls between whole microseconds, which is how finely the log's times are written");
  }
  for (const LoggedFrame& logged : recording.frames) {
    if (logged.bus < 2) continue;
    throw std::invalid_argument(recording.path.string() + ": more than two buses: " +
                                recording.interfaces[std::size_t(logged.bus)]);
  }
  return Replay(recording, facts, options).run();
}

}  // namespace hoof::tools
