#include "hal/slcan/line.h"

#include "hal/can_frame_check.h"

namespace hoof::hal::slcan {
namespace {

constexpr std::size_t kStandardDigits = 3, kExtendedDigits = 8;

void put_digits(Line& line, std::uint32_t value, std::size_t digits) {
  constexpr char kDigits[] = "0123456789ABCDEF";
  while (digits-- > 0) {
    line.text[line.length++] = static_cast<std::uint8_t>(kDigits[value >> (4 * digits) & 0xF]);
  }
}

/// @return false where a character is no hexadecimal digit
bool take_digits(std::span<const std::uint8_t> text, std::uint32_t& value) {
  value = 0;
  for (const std::uint8_t c : text) {
    std::uint32_t digit = 16;
    if (c >= '0' && c <= '9') digit = c - std::uint32_t{'0'};
    if (c >= 'A' && c <= 'F') digit = c - std::uint32_t{'A'} + 10;
    if (c >= 'a' && c <= 'f') digit = c - std::uint32_t{'a'} + 10;
    if (digit == 16) return false;
    value = value << 4 | digit;
  }
  return true;
}

}  // namespace

Line line_of(const CanFrame& frame) {
  Line line;
  if (!can_exist(frame) || frame.fd) return line;
  const char letter = frame.remote ? 'r' : 't';
  const int upper = frame.extended ? 'a' - 'A' : 0;
  line.text[line.length++] = static_cast<std::uint8_t>(letter - upper);
  put_digits(line, frame.id, frame.extended ? kExtendedDigits : kStandardDigits);
  put_digits(line, frame.length, 1);
  for (std::size_t i = 0; i < frame.length && !frame.remote; ++i)
    put_digits(line, frame.data[i], 2);
  line.text[line.length++] = kEnd;
  return line;
}

bool frame_of(std::span<const std::uint8_t> text, CanFrame& frame) {
  if (text.empty()) return false;
  const std::uint8_t letter = text[0];
  CanFrame read;
  read.extended = letter == 'T' || letter == 'R';
  read.remote = letter == 'r' || letter == 'R';
  if (!read.extended && !read.remote && letter != 't') return false;
  const std::size_t digits = read.extended ? kExtendedDigits : kStandardDigits;
  if (text.size() < 1 + digits + 1) return false;
  std::uint32_t length = 0;
  if (!take_digits(text.subspan(1, digits), read.id)) return false;
  if (!take_digits(text.subspan(1 + digits, 1), length)) return false;
  if (length > CanFrame::kMaxClassicLength) return false;
  const std::size_t bytes = read.remote ? 0 : length;
  const std::span<const std::uint8_t> data = text.subspan(1 + digits + 1);
  if (data.size() != 2 * bytes) return false;
  read.length = static_cast<std::uint8_t>(length);
  for (std::size_t i = 0; i < bytes; ++i) {
    std::uint32_t byte = 0;
    if (!take_digits(data.subspan(2 * i, 2), byte)) return false;
    read.data[i] = static_cast<std::uint8_t>(byte);
  }
  if (!can_exist(read)) return false;
  frame = read;
  return true;
}

}  // namespace hoof::hal::slcan
