#include "tools/cli/faults.h"

#include <iomanip>
#include <ostream>
#include <span>
#include <string>

#include "firmware/protocol/dictionary.h"
#include "tools/run/errors.h"

namespace hoof::tools {
namespace {

using namespace firmware::protocol;
using firmware::app::FaultRecord;
using firmware::app::TraceSample;

std::string bit_names(std::span<const ValueName> names, std::uint32_t bits) {
  std::string text;
  for (const ValueName& n : names) {
    if ((bits >> n.value & 1u) != 0) text += (text.empty() ? "" : ",") + std::string(n.name);
  }
  return text.empty() ? "-" : text;
}

std::string mode_name(firmware::control::Mode mode) {
  for (const ValueName& n : kModeNames) {
    if (n.value == static_cast<std::uint32_t>(mode)) return std::string(n.name);
  }
  return std::to_string(static_cast<int>(mode));
}

constexpr const char* kResetCauses[] = {"power on", "reset pin", "software", "watchdog",
                                        "brown-out"};
constexpr const char* kLogStates[] = {"ready", "full", "never erased, or an erase was cut",
                                      "of another firmware's layout"};

template <std::size_t kCount>
std::string word_of(const char* const (&words)[kCount], std::uint32_t value) {
  return value < kCount ? words[value] : std::to_string(value);
}

void print_trace(const FaultRecord& record, std::ostream& out) {
  out << "      tick  mode         position, rad            velocity, rad/s          torque, Nm"
         "               limits\n";
  for (std::size_t age = record.trace_count; age-- > 0;) {
    const TraceSample& sample = record.trace[age];
    out << std::right << std::setw(10) << sample.tick << "  " << std::left << std::setw(11)
        << mode_name(sample.mode) << std::right << std::fixed << std::setprecision(3);
    for (const auto& values : {sample.position_rad, sample.velocity_rad_s, sample.torque_Nm}) {
      for (const float value : values) out << std::setw(8) << value;
      out << ' ';
    }
    out << ' ' << bit_names(kLimitBitNames, sample.active_limits) << '\n';
  }
  out << std::defaultfloat;
}

}  // namespace

void print_fault(const FaultRecord& record, bool with_trace, std::ostream& out) {
  out << bit_names(kFaultBitNames, record.faults) << " in mode " << mode_name(record.mode)
      << ", tick " << record.tick << ", " << static_cast<double>(record.time_ns) * 1e-9
      << " s after the start\n";
  if (with_trace) print_trace(record, out);
}

void print_fault_log(bridge::ServiceClient& client, bool with_trace, std::ostream& out) {
  out << "last start: " << word_of(kResetCauses, client.status(Status::kResetCause)) << '\n';
  const auto state = client.stored_status(Status::kLogState);
  if (!state) throw CannotFinish("this foot has no storage, so it keeps no faults");
  const std::uint32_t used = client.status(Status::kLogUsed);
  out << "log: " << word_of(kLogStates, *state) << ", " << used << " of "
      << client.status(Status::kLogCapacity) << " places used, " << client.status(Status::kLogLost)
      << " faults lost since the start\n";
  for (std::uint32_t slot = 0; slot < used; ++slot) {
    out << std::setw(4) << std::right << slot << "  ";
    if (const auto record = client.read_fault(static_cast<std::uint8_t>(slot))) {
      print_fault(*record, with_trace, out);
    } else {
      out << "cut by a power failure, or damaged\n";
    }
  }
}

}  // namespace hoof::tools
