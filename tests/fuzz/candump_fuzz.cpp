// Any line into the candump reader: refused with a cause, or read as a frame that can be written
// and read again.
#include <cstdint>
#include <string>
#include <string_view>

#include "hil_bridge/candump.h"
#include "tests/fuzz/require.h"

using namespace hoof::bridge;
using hoof::tests::fuzz::require;

namespace {

constexpr std::int64_t kMicrosecond_ns = 1000;

std::optional<CandumpRecord> read(std::string_view line) {
  try {
    return parse_candump_line(line, 1);
  } catch (const CandumpError&) {
    return std::nullopt;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view line(reinterpret_cast<const char*>(data), size);
  const std::optional<CandumpRecord> record = read(line);
  if (!record) return 0;
  require(record->stamp_ns >= 0, "time is not negative");
  std::string written;
  append_candump_line(written, record->stamp_ns, record->interface, record->frame);
  const std::optional<CandumpRecord> again = read(written);
  require(again.has_value(), "what is written can be read");
  require(again->frame == record->frame, "the frame is the same");
  require(again->interface == record->interface, "the interface is the same");
  // Half a microsecond by rounding: not beyond.
  const std::int64_t shift_ns = again->stamp_ns - record->stamp_ns;
  require(2 * shift_ns <= kMicrosecond_ns && 2 * shift_ns >= -kMicrosecond_ns,
          "the time is the same to the microsecond");
  return 0;
}
