#include "tools/log/decoded_frame.h"

#include <algorithm>
#include <cctype>
#include <charconv>

#include "sim/config/suggestion.h"
#include "tools/run/errors.h"

namespace hoof::tools {

namespace protocol = firmware::protocol;

const MessageSpec* find_message(const hal::CanFrame& frame) {
  if (frame.extended || frame.error) return nullptr;
  for (const MessageSpec& message : protocol::kMessages) {
    if (message.id == frame.id) return &message;
  }
  return nullptr;
}

std::string_view frame_fault(const MessageSpec& message, const hal::CanFrame& frame) {
  switch (check(message, frame)) {
    case protocol::DecodeResult::kOk:
      return "";
    case protocol::DecodeResult::kWrongIdentifier:
      return "wrong identifier";
    case protocol::DecodeResult::kWrongFormat:
      return "wrong format";
    case protocol::DecodeResult::kWrongLength:
      return "wrong length";
    case protocol::DecodeResult::kBadCrc:
      return "bad CRC";
  }
  return "";
}

std::string_view drive_switch(const MessageSpec& message, const hal::CanFrame& frame) {
  for (const protocol::Drive drive : protocol::kDrives) {
    if (&command_spec(drive) != &message) continue;
    protocol::DriveOrder order;
    if (decode_command(drive, frame, order) != protocol::DecodeResult::kOk) return "";
    if (!order.action) return "";
    switch (*order.action) {
      case protocol::DriveSwitch::kEnter:
        return "enter";
      case protocol::DriveSwitch::kExit:
        return "exit";
      case protocol::DriveSwitch::kSetZero:
        return "set_zero";
    }
  }
  return "";
}

bool is_whole(const Signal& signal) {
  return signal.scale == 1.0f && signal.offset == 0.0f && signal.unit.empty();
}

double value_of(const Signal& signal, const hal::CanFrame& frame) {
  const std::uint32_t raw = raw_of(frame, signal);
  return is_whole(signal) ? double(raw) : double(protocol::value_from_raw(signal, raw));
}

std::string value_text(const Signal& signal, double value) {
  char text[40];
  const auto end = is_whole(signal) ? std::to_chars(text, text + sizeof text, std::int64_t(value))
                                    : std::to_chars(text, text + sizeof text, float(value));
  return {text, end.ptr};
}

std::string described_value(const Signal& signal, double value) {
  std::string text = value_text(signal, value);
  for (const protocol::ValueName& named : signal.values) {
    if (double(named.value) == value) return text + " (" + std::string(named.name) + ")";
  }
  if (!signal.unit.empty()) text += " " + std::string(signal.unit);
  return text;
}

std::string payload_hex(const hal::CanFrame& frame) {
  static constexpr char kDigits[] = "0123456789ABCDEF";
  std::string line;
  for (int i = 0; i < frame.length && !frame.remote; ++i) {
    line += kDigits[frame.data[i] >> 4];
    line += kDigits[frame.data[i] & 0xF];
  }
  return line;
}

std::string id_text(const hal::CanFrame& frame) {
  char digits[9];
  const auto end = std::to_chars(digits, digits + sizeof digits, frame.id, 16).ptr;
  std::string text(digits, end);
  for (char& c : text) c = char(std::toupper(static_cast<unsigned char>(c)));
  const std::size_t width = frame.extended || frame.error ? 8 : 3;
  return text.size() < width ? std::string(width - text.size(), '0') + text : text;
}

std::string signal_name(const MessageSpec& message, const Signal& signal) {
  return std::string(message.name) + "." + std::string(signal.name);
}

bool matches_pattern(std::string_view pattern, std::string_view text) {
  if (pattern.empty()) return text.empty();
  if (pattern.front() != '*') {
    return !text.empty() && text.front() == pattern.front() &&
           matches_pattern(pattern.substr(1), text.substr(1));
  }
  for (std::size_t skip = 0; skip <= text.size(); ++skip) {
    if (matches_pattern(pattern.substr(1), text.substr(skip))) return true;
  }
  return false;
}

bool matches_any(const std::vector<std::string>& patterns, std::string_view text) {
  return std::any_of(patterns.begin(), patterns.end(),
                     [text](const std::string& p) { return matches_pattern(p, text); });
}

void require_known_signals(const std::vector<std::string>& patterns) {
  std::vector<std::string> names;
  for (const MessageSpec& message : protocol::kMessages) {
    for (const Signal& signal : message.signals) names.push_back(signal_name(message, signal));
  }
  for (const std::string& pattern : patterns) {
    const bool fits = std::any_of(names.begin(), names.end(), [&](const std::string& name) {
      return matches_pattern(pattern, name);
    });
    if (fits) continue;
    const std::string near = sim::suggest(pattern, names);
    throw UserError("no signal '" + pattern + "' in the dictionary" +
                    (near.empty() ? "; `hoof dbc` lists them as Message.signal"
                                  : "; did you mean " + near + "?"));
  }
}

}  // namespace hoof::tools
