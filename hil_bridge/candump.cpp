#include "hil_bridge/candump.h"

#include <array>
#include <charconv>

#include "hal/can_frame_check.h"

namespace hoof::bridge {
namespace {

using hal::CanFrame;

constexpr std::int64_t kNsPerSecond = 1'000'000'000;
constexpr std::int64_t kNsPerMicrosecond = 1'000;

// SocketCAN's bit for error frames (CAN_ERR_FLAG) and the flags of canfd_frame.
constexpr std::uint32_t kErrorFlag = 0x2000'0000;
constexpr unsigned kFlagBrs = 1;
constexpr unsigned kFlagEsi = 2;
constexpr unsigned kFlagFdf = 4;

constexpr char kHex[] = "0123456789ABCDEF";

void append_hex(std::string& out, std::uint32_t value, int digits) {
  for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4) out += kHex[(value >> shift) & 0xF];
}

void append_decimal(std::string& out, std::int64_t value, std::size_t min_digits) {
  std::array<char, 20> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  const auto count = static_cast<std::size_t>(end - digits.data());
  if (count < min_digits) out.append(min_digits - count, '0');
  out.append(digits.data(), count);
}

void append_payload(std::string& out, const CanFrame& frame) {
  for (int i = 0; i < frame.length; ++i) append_hex(out, frame.data[i], 2);
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

/// Cuts the word up to the next blank off the front of `text`.
std::string_view take_word(std::string_view& text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  std::size_t length = 0;
  while (length < text.size() && !is_blank(text[length])) ++length;
  const std::string_view word = text.substr(0, length);
  text.remove_prefix(length);
  return word;
}

/// One line; every reader throws with the place.
class LineParser {
 public:
  LineParser(int line_number, const std::string& source)
      : line_number_(line_number), source_(source) {}

  [[noreturn]] void fail(const std::string& cause) const {
    throw CandumpError(source_, line_number_, cause);
  }

  /// "(sec.frac)"
  std::int64_t stamp_ns(std::string_view word) const {
    if (word.size() < 3 || word.front() != '(' || word.back() != ')') {
      fail("expected a time such as (1767225600.000000), found '" + std::string(word) + "'");
    }
    word = word.substr(1, word.size() - 2);
    const std::size_t point = word.find('.');
    if (point == std::string_view::npos) fail("the time has no decimal point");
    const std::string_view fraction = word.substr(point + 1);
    if (fraction.empty() || fraction.size() > 9) fail("the time needs 1 to 9 decimals");
    std::int64_t ns = decimal(fraction);
    for (std::size_t i = fraction.size(); i < 9; ++i) ns *= 10;
    const std::int64_t seconds = decimal(word.substr(0, point));
    if (seconds > 9'000'000'000) fail("the time is beyond the year 2255");
    return seconds * kNsPerSecond + ns;
  }

  CanFrame frame(std::string_view word) const {
    const std::size_t hash = word.find('#');
    if (hash == std::string_view::npos) fail("no '#' in '" + std::string(word) + "'");
    CanFrame out;
    identifier(word.substr(0, hash), out);
    std::string_view rest = word.substr(hash + 1);
    if (!rest.empty() && rest.front() == '#') {
      fd_flags(rest.substr(1), out);
      rest.remove_prefix(2);
    }
    if (!out.fd && !rest.empty() && (rest.front() == 'R' || rest.front() == 'r')) {
      remote(rest.substr(1), out);
    } else {
      payload(rest, out);
    }
    return out;
  }

 private:
  std::int64_t decimal(std::string_view digits) const {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc{} || end != digits.data() + digits.size() || digits.front() == '-') {
      fail("'" + std::string(digits) + "' in the time is not a whole number");
    }
    return value;
  }

  void identifier(std::string_view digits, CanFrame& out) const {
    if (digits.size() != 3 && digits.size() != 8) {
      fail("the identifier '" + std::string(digits) +
           "' needs 3 digits (standard) or 8 (extended)");
    }
    std::uint32_t value = 0;
    for (const char c : digits) {
      const int digit = hex_digit(c);
      if (digit < 0) fail("the identifier '" + std::string(digits) + "' is not hexadecimal");
      value = (value << 4) | static_cast<std::uint32_t>(digit);
    }
    out.error = digits.size() == 8 && (value & kErrorFlag) != 0;
    if (out.error) value &= ~kErrorFlag;
    out.extended = digits.size() == 8 && !out.error;
    out.id = value;
    if (value > (digits.size() == 8 ? hal::kMaxExtendedId : hal::kMaxStandardId)) {
      fail("the identifier " + std::string(digits) + " is above " +
           (digits.size() == 8 ? "1FFFFFFF" : "7FF"));
    }
  }

  void fd_flags(std::string_view rest, CanFrame& out) const {
    const int flags = rest.empty() ? -1 : hex_digit(rest.front());
    if (flags < 0) fail("'##' must be followed by one hexadecimal digit of flags");
    if ((static_cast<unsigned>(flags) & ~(kFlagBrs | kFlagEsi | kFlagFdf)) != 0) {
      fail(std::string("unknown FD flags '") + rest.front() + "'");
    }
    out.fd = true;
    out.bit_rate_switch = (static_cast<unsigned>(flags) & kFlagBrs) != 0;
    out.error_state_indicator = (static_cast<unsigned>(flags) & kFlagEsi) != 0;
  }

  void remote(std::string_view length, CanFrame& out) const {
    if (out.error) fail("an error frame cannot be a remote request");
    out.remote = true;
    if (length.empty()) return;
    if (length.size() != 1 || length[0] < '0' || length[0] > '8') {
      fail("a remote request has a length of 0 to 8, not '" + std::string(length) + "'");
    }
    out.length = static_cast<std::uint8_t>(length[0] - '0');
  }

  void payload(std::string_view digits, CanFrame& out) const {
    if (digits.size() % 2 != 0) fail("half a byte: an odd number of data digits");
    const std::size_t bytes = digits.size() / 2;
    const std::size_t room = out.fd ? CanFrame::kMaxFdLength : CanFrame::kMaxClassicLength;
    if (bytes > room) {
      fail(std::to_string(bytes) + " data bytes; at most " + std::to_string(room) + " fit");
    }
    out.length = static_cast<std::uint8_t>(bytes);
    if (out.fd && !hal::is_fd_length(out.length)) {
      fail("no CAN FD frame has " + std::to_string(bytes) + " data bytes");
    }
    for (std::size_t i = 0; i < bytes; ++i) {
      const int high = hex_digit(digits[2 * i]);
      const int low = hex_digit(digits[2 * i + 1]);
      if (high < 0 || low < 0) {
        fail("'" + std::string(digits.substr(2 * i, 2)) + "' in the data is not hexadecimal");
      }
      out.data[i] = static_cast<std::uint8_t>(high * 16 + low);
    }
  }

  int line_number_;
  const std::string& source_;
};

}  // namespace

void append_candump_line(std::string& out, std::int64_t stamp_ns, std::string_view interface,
                         const CanFrame& frame) {
  const std::int64_t stamp_us = (stamp_ns + kNsPerMicrosecond / 2) / kNsPerMicrosecond;
  out += '(';
  append_decimal(out, stamp_us / 1'000'000, 10);
  out += '.';
  append_decimal(out, stamp_us % 1'000'000, 6);
  out += ") ";
  out += interface;
  out += ' ';
  if (frame.error) {
    append_hex(out, frame.id | kErrorFlag, 8);
  } else {
    append_hex(out, frame.id, frame.extended ? 8 : 3);
  }
  out += '#';
  if (frame.fd) {
    out += '#';
    out += kHex[(frame.bit_rate_switch ? kFlagBrs : 0U) |
                (frame.error_state_indicator ? kFlagEsi : 0U)];
  }
  if (frame.remote) {
    out += 'R';
    if (frame.length > 0) out += kHex[frame.length & 0xF];
  } else {
    append_payload(out, frame);
  }
  out += '\n';
}

std::optional<CandumpRecord> parse_candump_line(std::string_view line, int line_number,
                                                const std::string& source) {
  const LineParser parser(line_number, source);
  const std::string_view stamp = take_word(line);
  if (stamp.empty() || stamp.front() == '#') return std::nullopt;
  CandumpRecord record;
  record.stamp_ns = parser.stamp_ns(stamp);
  record.interface = take_word(line);
  const std::string_view frame = take_word(line);
  if (frame.empty()) parser.fail("expected: (time) interface identifier#data");
  record.frame = parser.frame(frame);
  const std::string_view direction = take_word(line);
  if (!direction.empty() && direction != "R" && direction != "T") {
    parser.fail("unexpected '" + std::string(direction) + "' behind the frame");
  }
  if (const std::string_view more = take_word(line); !more.empty()) {
    parser.fail("unexpected '" + std::string(more) + "' at the end of the line");
  }
  return record;
}

std::optional<CandumpRecord> CandumpReader::next() {
  while (std::getline(input_, line_)) {
    ++line_number_;
    // The kernel may end a write of a killed program between two pages, within a line. What is left
    // of that may still look like a frame, with fewer bytes than it had.
    if (input_.eof()) {
      cut_ = true;
      return std::nullopt;
    }
    if (auto record = parse_candump_line(line_, line_number_, source_)) return record;
  }
  return std::nullopt;
}

}  // namespace hoof::bridge
