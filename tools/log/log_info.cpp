#include "tools/log/log_info.h"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <ostream>

#include "firmware/protocol/messages.h"
#include "hal/can_frame_check.h"
#include "hal/can_timing.h"
#include "hal/in_process/load_meter.h"
#include "tools/log/decoded_frame.h"

namespace hoof::tools {
namespace {

namespace protocol = firmware::protocol;

/// A cyclic message that is away for so many of its periods is missing, not late.
constexpr double kGapPeriods = 3;
/// More findings of a kind than this are counted only.
constexpr int kMostFindings = 10;

template <typename... Args>
std::string format(const char* pattern, Args... args) {
  char text[240];
  std::snprintf(text, sizeof text, pattern, args...);
  return text;
}

std::uint64_t key_of(const LoggedFrame& logged) {
  const hal::CanFrame& f = logged.frame;
  return std::uint64_t(logged.bus) << 40 | std::uint64_t(f.error) << 33 |
         std::uint64_t(f.extended) << 32 | f.id;
}

/// Walks over a recording once.
class Measurement {
 public:
  explicit Measurement(const BusRecording& recording) : recording_(recording) {}

  LogStatistics run() {
    out_.buses.resize(recording_.interfaces.size());
    meters_.resize(recording_.interfaces.size());
    busy_until_ns_.assign(recording_.interfaces.size(), 0);
    for (const LoggedFrame& logged : recording_.frames) take(logged);
    for (auto& [key, id] : ids_) {
      find_gaps(id);
      out_.ids.push_back(std::move(id));
    }
    const std::int64_t span_ns = recording_.last_ns() - recording_.first_ns();
    for (std::size_t b = 0; b < out_.buses.size(); ++b) {
      out_.buses[b].mean_load_ratio = meters_[b].mean_ratio(span_ns);
      out_.buses[b].worst_10ms_ratio = meters_[b].worst_10ms_ratio();
    }
    if (unsaid_ > 0) out_.findings.push_back(format("... and %d more", unsaid_));
    return std::move(out_);
  }

 private:
  void find(const LoggedFrame& at, const std::string& what) {
    find_at(recording_.time_s(at), what);
  }
  void find_at(double time_s, const std::string& what) {
    if (int(out_.findings.size()) >= kMostFindings) {
      ++unsaid_;
      return;
    }
    out_.findings.push_back(format("%.6f s: ", time_s) + what);
  }

  void take(const LoggedFrame& logged) {
    BusStatistics& bus = out_.buses[std::size_t(logged.bus)];
    ++bus.frames;
    if (logged.frame.error && bus.error_frames++ == 0) {
      find(logged, "the first error frame on this bus");
    }
    occupy(logged);
    IdStatistics& id = ids_[key_of(logged)];
    if (id.count == 0) {
      id.bus = logged.bus;
      id.example = logged.frame;
      id.first_ns = logged.stamp_ns;
    } else {
      const std::int64_t gap_ns = logged.stamp_ns - id.last_ns;
      id.shortest_ns = std::min(id.shortest_ns, gap_ns);
      if (gap_ns > id.longest_ns) {
        id.longest_ns = gap_ns;
        id.longest_from_ns = id.last_ns;
      }
    }
    id.last_ns = logged.stamp_ns;
    ++id.count;
    examine(logged, id);
  }

  /// Frames end at their stamp; what overlaps by the stamps' rounding is pushed on.
  void occupy(const LoggedFrame& logged) {
    if (!hal::can_exist(logged.frame)) return;
    const auto b = std::size_t(logged.bus);
    const std::int64_t length_ns = hal::frame_time_ns(logged.frame);  // with intermission
    const std::int64_t free_ns = logged.stamp_ns - recording_.first_ns() +
                                 hal::bit_time_ns({hal::kIntermissionBits, 0}, hal::BitRates{});
    const std::int64_t start_ns =
        std::max({free_ns - length_ns, busy_until_ns_[b], std::int64_t(0)});
    meters_[b].add(start_ns, start_ns + length_ns);
    busy_until_ns_[b] = start_ns + length_ns;
  }

  void examine(const LoggedFrame& logged, IdStatistics& id) {
    const MessageSpec* message = find_message(logged.frame);
    if (message == nullptr) return;
    std::string fault(frame_fault(*message, logged.frame));
    if (fault.empty() && (message->buses & (1u << logged.bus)) == 0 &&
        recording_.interfaces.size() > 1) {
      fault = "on the wrong bus";
    }
    if (!fault.empty()) {
      if (id.faults[fault]++ == 0) find(logged, std::string(message->name) + ": " + fault);
      return;
    }
    if (logged.bus == 0) follow_sync(logged);
    follow_heartbeat(logged);
  }

  void follow_sync(const LoggedFrame& logged) {
    protocol::Sync sync;
    if (decode(logged.frame, sync) != protocol::DecodeResult::kOk) return;
    if (out_.last_tick && sync.tick != *out_.last_tick + 1) {
      find(logged, format("SYNC goes from tick %u to %u", *out_.last_tick, sync.tick));
    }
    if (!out_.first_tick) out_.first_tick = sync.tick;
    out_.last_tick = sync.tick;
  }

  void follow_heartbeat(const LoggedFrame& logged) {
    protocol::Heartbeat heartbeat;
    if (decode(logged.frame, heartbeat) != protocol::DecodeResult::kOk) return;
    for (const protocol::ValueName& bit : protocol::kFaultBitNames) {
      const std::uint32_t mask = 1u << bit.value;
      if ((heartbeat.faults & mask) != 0 && (faults_ & mask) == 0) {
        find(logged, "the foot reports the fault " + std::string(bit.name));
      }
    }
    faults_ = heartbeat.faults;
  }

  void find_gaps(const IdStatistics& id) {
    const MessageSpec* message = find_message(id.example);
    if (message == nullptr || message->cycle_ms == 0 || id.count < 2) return;
    if (double(id.longest_ns) <= kGapPeriods * 1e6 * message->cycle_ms) return;
    find_at(double(id.longest_from_ns - recording_.origin_ns) * 1e-9,
            format("%s pauses for %.1f ms, its period is %d ms", message->name.data(),
                   double(id.longest_ns) * 1e-6, int{message->cycle_ms}));
  }

  const BusRecording& recording_;
  LogStatistics out_;
  std::map<std::uint64_t, IdStatistics> ids_;
  std::vector<hal::LoadMeter> meters_;
  std::vector<std::int64_t> busy_until_ns_;
  std::uint32_t faults_ = 0;
  int unsaid_ = 0;
};

std::string calendar(std::int64_t stamp_ns) {
  const std::time_t seconds = stamp_ns / 1'000'000'000;
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", &utc);
  return text + format(".%06d UTC", int(stamp_ns % 1'000'000'000 / 1000));
}

void print_ids(const BusRecording& recording, const LogStatistics& s, std::ostream& out) {
  out << format("\n%-8s %-8s %-18s %9s %9s %10s %10s %10s  %s\n", "bus", "id", "message", "frames",
                "rate Hz", "min ms", "mean ms", "max ms", "max from s");
  for (const IdStatistics& id : s.ids) {
    const MessageSpec* message = find_message(id.example);
    const std::string name = message            ? std::string(message->name)
                             : id.example.error ? "(error frame)"
                                                : "(unknown)";
    out << format("%-8s %-8s %-18s %9llu", recording.interfaces[std::size_t(id.bus)].c_str(),
                  id_text(id.example).c_str(), name.c_str(),
                  static_cast<unsigned long long>(id.count));
    if (id.count > 1) {
      out << format(" %9.1f %10.3f %10.3f %10.3f  %.6f", id.rate_Hz(),
                    double(id.shortest_ns) * 1e-6, 1e3 / std::max(id.rate_Hz(), 1e-9),
                    double(id.longest_ns) * 1e-6,
                    double(id.longest_from_ns - recording.origin_ns) * 1e-9);
    }
    out << '\n';
  }
}

}  // namespace

LogStatistics measure(const BusRecording& recording) {
  return Measurement(recording).run();
}

void print_info(const BusRecording& recording, std::ostream& out) {
  const LogStatistics s = measure(recording);
  out << recording.path.string() << ": " << recording.frames.size() << " frames";
  if (recording.frames.empty()) {
    out << "\n";
    return;
  }
  out << format(" in %.6f s", double(recording.last_ns() - recording.first_ns()) * 1e-9) << "\n"
      << "first " << calendar(recording.first_ns()) << ", last " << calendar(recording.last_ns())
      << "\n"
      << format("times below count from %s\n", calendar(recording.origin_ns).c_str());
  if (s.first_tick) out << format("SYNC from tick %u to %u\n", *s.first_tick, *s.last_tick);
  out << format("\n%-8s %10s %12s %12s %13s\n", "bus", "frames", "mean load", "worst 10 ms",
                "error frames");
  for (std::size_t b = 0; b < s.buses.size(); ++b) {
    if (recording.interfaces[b].empty()) continue;
    out << format("%-8s %10llu %10.1f %% %10.1f %% %13llu\n", recording.interfaces[b].c_str(),
                  static_cast<unsigned long long>(s.buses[b].frames),
                  100 * s.buses[b].mean_load_ratio, 100 * s.buses[b].worst_10ms_ratio,
                  static_cast<unsigned long long>(s.buses[b].error_frames));
  }
  print_ids(recording, s, out);
  if (s.findings.empty() && recording.notes.empty()) {
    out << "\nnothing found: no gaps, no faults, all frames read\n";
    return;
  }
  out << "\nfound:\n";
  for (const std::string& note : recording.notes) out << "  " << note << "\n";
  for (const std::string& finding : s.findings) out << "  " << finding << "\n";
}

}  // namespace hoof::tools
