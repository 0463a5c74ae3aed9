// candump log lines, the text format of `candump -L`, read by canplayer, log2asc, python-can,
// SavvyCAN:
//
//   (1767225600.001000) can0 123#DEADBEEF        standard identifier: 3 digits
//   (1767225600.001120) can0 12345678#00         extended: 8 digits
//   (1767225600.001200) can1 123#R               remote request, #R4 with a DLC of 4
//   (1767225600.001300) can1 123##1AABB          CAN FD, one digit of flags: 1 BRS, 2 ESI
//   (1767225600.001400) can1 20000040#0000...    error frame: bit 29 set in 8 digits (SocketCAN)
//
// The one formatter and the one parser of that format in this project.
#pragma once

#include <cstdint>
#include <istream>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "hal/can_frame.h"

namespace hoof::bridge {

struct CandumpRecord {
  std::int64_t stamp_ns = 0;  // Unix time
  std::string interface;
  hal::CanFrame frame;  // frame.stamp_ns stays 0
};

class CandumpError : public std::runtime_error {
 public:
  /// what() is "<source>:<line>: <cause>".
  CandumpError(const std::string& source, int line_number, const std::string& cause)
      : std::runtime_error(source + ":" + std::to_string(line_number) + ": " + cause),
        line_number_(line_number) {}
  int line_number() const { return line_number_; }

 private:
  int line_number_;
};

/// Appends one line with its newline. Stamps are rounded to the nearest microsecond, halves up.
/// @param stamp_ns Unix time, not negative
/// @pre `frame` can exist or is an error frame; `interface` has no blanks
void append_candump_line(std::string& out, std::int64_t stamp_ns, std::string_view interface,
                         const hal::CanFrame& frame);

/// Reads one line, with or without newline. Accepted beside what append_candump_line writes:
/// leading and trailing blanks, CR, 1 to 9 digits of a second, lower case, a trailing ` R` or ` T`
/// (direction, written by newer tools), the flag digit 4 (FDF) of newer can-utils.
/// @return nothing for empty lines and comments (first character '#')
/// @throws CandumpError naming source, line number and cause
std::optional<CandumpRecord> parse_candump_line(std::string_view line, int line_number,
                                                const std::string& source = "candump");

/// Reads a log line by line. A last line without its newline is no record: a program that was
/// killed while it wrote has left it.
class CandumpReader {
 public:
  /// @param source name used in errors, such as the file's path
  CandumpReader(std::istream& input, std::string source)
      : input_(input), source_(std::move(source)) {}

  /// @return the next record, nothing at the end
  /// @throws CandumpError
  std::optional<CandumpRecord> next();

  int line_number() const { return line_number_; }
  /// True once such a last line was left out.
  bool cut() const { return cut_; }

 private:
  std::istream& input_;
  std::string source_;
  std::string line_;
  int line_number_ = 0;
  bool cut_ = false;
};

}  // namespace hoof::bridge
