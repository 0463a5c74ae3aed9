#include "tools/log/bus_recording.h"

#include <algorithm>
#include <string_view>

#include "hil_bridge/candump.h"
#include "hil_bridge/recording.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

namespace hoof::tools {
namespace {

constexpr std::int64_t kHour_ns = 3'600'000'000'000;

}  // namespace

std::int64_t origin_of(std::int64_t first_stamp_ns) {
  const std::int64_t since_ns = first_stamp_ns - bridge::kSimulatedEpoch_ns;
  return since_ns >= 0 && since_ns < kHour_ns ? bridge::kSimulatedEpoch_ns : first_stamp_ns;
}

int BusNames::bus_of(const std::string& interface) {
  const auto known = std::find(names_.begin(), names_.end(), interface);
  if (known != names_.end()) return int(known - names_.begin());
  std::size_t wanted = names_.size();
  if (interface.ends_with('0')) wanted = 0;
  if (interface.ends_with('1')) wanted = 1;
  if (wanted < names_.size() && !names_[wanted].empty()) wanted = names_.size();
  if (wanted >= names_.size()) names_.resize(wanted + 1);
  names_[wanted] = interface;
  return int(wanted);
}

std::filesystem::path find_bus_log(const std::filesystem::path& run_or_log) {
  if (!std::filesystem::is_directory(run_or_log)) return run_or_log;
  const std::filesystem::path log = run_or_log / "bus.log";
  if (!std::filesystem::exists(log)) {
    throw UserError(run_or_log.string() + ": no bus.log in this folder");
  }
  return log;
}

BusRecording read_bus_log(const std::filesystem::path& run_or_log) {
  BusRecording recording;
  recording.path = find_bus_log(run_or_log);
  const std::string text = read_file(recording.path);
  BusNames names;
  std::string_view rest = text;
  for (int number = 1; !rest.empty(); ++number) {
    const std::size_t end = rest.find('\n');
    const bool whole = end != std::string_view::npos;
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(whole ? end + 1 : rest.size());
    try {
      const auto record = bridge::parse_candump_line(line, number, recording.path.string());
      if (!record) continue;
      recording.frames.push_back(
          {record->stamp_ns, names.bus_of(record->interface), record->frame});
    } catch (const bridge::CandumpError& error) {
      if (whole) throw UserError(error.what());
      recording.notes.push_back(std::string("the last line is cut off and left out: ") +
                                error.what());
    }
  }
  recording.interfaces = names.names();
  const auto earlier = [](const LoggedFrame& a, const LoggedFrame& b) {
    return a.stamp_ns < b.stamp_ns;
  };
  if (!std::is_sorted(recording.frames.begin(), recording.frames.end(), earlier)) {
    recording.notes.emplace_back("the times of the log go back; its frames were sorted by time");
    std::stable_sort(recording.frames.begin(), recording.frames.end(), earlier);
  }
  if (!recording.frames.empty()) {
    recording.origin_ns = origin_of(recording.frames.front().stamp_ns);
  }
  return recording;
}

}  // namespace hoof::tools
