#include "hil_bridge/candump.h"

#include <catch2/catch.hpp>
#include <random>
#include <sstream>

#include "hal/can_frame_check.h"

namespace hoof::bridge {
namespace {

using hal::CanFrame;

CanFrame frame_of(std::uint32_t id, std::vector<std::uint8_t> data = {}, bool extended = false) {
  CanFrame frame;
  frame.id = id;
  frame.extended = extended;
  frame.length = static_cast<std::uint8_t>(data.size());
  for (std::size_t i = 0; i < data.size(); ++i) frame.data[i] = data[i];
  return frame;
}

std::string line_of(std::int64_t stamp_ns, const CanFrame& frame) {
  std::string out;
  append_candump_line(out, stamp_ns, "can0", frame);
  return out;
}

CandumpRecord parse(const std::string& line) {
  const auto record = parse_candump_line(line, 1);
  REQUIRE(record);
  return *record;
}

/// The cause alone, without the place.
std::string refusal(const std::string& line) {
  try {
    parse_candump_line(line, 12, "x.log");
  } catch (const CandumpError& error) {
    CHECK(error.line_number() == 12);
    const std::string text = error.what();
    REQUIRE(text.rfind("x.log:12: ", 0) == 0);
    return text.substr(10);
  }
  return "";
}

template <typename Generator>
CanFrame any_frame(Generator& random) {
  constexpr std::uint8_t kFdLengths[] = {0, 1, 7, 8, 12, 16, 20, 24, 32, 48, 64};
  CanFrame frame;
  frame.fd = random() % 3 == 0;
  frame.extended = random() % 2 == 0;
  frame.error = !frame.fd && random() % 10 == 0;
  if (frame.error) frame.extended = false;
  frame.remote = !frame.fd && !frame.error && random() % 5 == 0;
  frame.id = static_cast<std::uint32_t>(random()) &
             (frame.error || frame.extended ? hal::kMaxExtendedId : hal::kMaxStandardId);
  frame.length = static_cast<std::uint8_t>(frame.fd ? kFdLengths[random() % 11] : random() % 9);
  frame.bit_rate_switch = frame.fd && random() % 2 == 0;
  frame.error_state_indicator = frame.fd && random() % 2 == 0;
  for (int i = 0; !frame.remote && i < frame.length; ++i) {
    frame.data[i] = static_cast<std::uint8_t>(random());
  }
  return frame;
}

}  // namespace

TEST_CASE("a last line without its newline was cut: it is no record, however it looks") {
  for (const char* rest : {"(1.000002) can0 010#0A0", "(1.000002) can0 010#0A", "(1.0", "x"}) {
    std::istringstream input("(1.000001) can0 010#0A000000\n" + std::string(rest));
    bridge::CandumpReader reader(input, "killed");
    REQUIRE(reader.next());
    CHECK_FALSE(reader.cut());
    CHECK_FALSE(reader.next());
    CHECK(reader.cut());
  }
}

TEST_CASE("lines are written as candump -L writes them", "[candump]") {
  CHECK(line_of(1'767'225'600'001'000'000, frame_of(0x123, {0xDE, 0xAD, 0xBE, 0xEF})) ==
        "(1767225600.001000) can0 123#DEADBEEF\n");
  CHECK(line_of(0, frame_of(0x7)) == "(0000000000.000000) can0 007#\n");
  CHECK(line_of(0, frame_of(0x7, {0}, true)) == "(0000000000.000000) can0 00000007#00\n");
  CanFrame frame = frame_of(0x123);
  frame.remote = true;
  CHECK(line_of(0, frame) == "(0000000000.000000) can0 123#R\n");
  frame.length = 4;
  CHECK(line_of(0, frame) == "(0000000000.000000) can0 123#R4\n");
  frame = frame_of(0x123, {0xAA, 0xBB});
  frame.fd = true;
  CHECK(line_of(0, frame) == "(0000000000.000000) can0 123##0AABB\n");
  frame.bit_rate_switch = true;
  frame.error_state_indicator = true;
  CHECK(line_of(0, frame) == "(0000000000.000000) can0 123##3AABB\n");
  frame = frame_of(0x40, std::vector<std::uint8_t>(8, 0));
  frame.error = true;
  CHECK(line_of(0, frame) == "(0000000000.000000) can0 20000040#0000000000000000\n");
}

TEST_CASE("stamps are rounded to the nearest microsecond", "[candump]") {
  const CanFrame frame = frame_of(0);
  CHECK(line_of(1'499, frame).substr(0, 19) == "(0000000000.000001)");
  CHECK(line_of(1'500, frame).substr(0, 19) == "(0000000000.000002)");
  CHECK(line_of(999'999'500, frame).substr(0, 19) == "(0000000001.000000)");
  CHECK(line_of(1'234'567'890'100'000'000, frame).substr(0, 19) == "(1234567890.100000)");
}

TEST_CASE("lines of the tools are read", "[candump]") {
  CandumpRecord record = parse("(1436509052.249713) vcan0 044#2A366C2BBA\n");
  CHECK(record.stamp_ns == 1'436'509'052'249'713'000);
  CHECK(record.interface == "vcan0");
  CHECK(record.frame == frame_of(0x44, {0x2A, 0x36, 0x6C, 0x2B, 0xBA}));
  // Direction behind the frame, line ends of Windows, lower case, blanks.
  CHECK(parse("(0.5) can1 123#ab R").frame == frame_of(0x123, {0xAB}));
  CHECK(parse("(0.5) can1 123#ab T\r\n").frame == frame_of(0x123, {0xAB}));
  CHECK(parse("  (0.5)\tcan1  1abcdef0#  \r\n").frame == frame_of(0x1ABCDEF0, {}, true));
  CHECK(parse("(0.5) can1 123#").stamp_ns == 500'000'000);
  CHECK(parse("(7.000000001) can1 123#").stamp_ns == 7'000'000'001);
  // Eight digits are extended even where the value is small.
  CHECK(parse("(0.0) c 00000123#").frame.extended);
  CHECK_FALSE(parse("(0.0) c 123#").frame.extended);
  record = parse("(0.0) c 123#R8");
  CHECK((record.frame.remote && record.frame.length == 8));
  // Newer can-utils set the FDF flag.
  record = parse("(0.0) c 123##5AABB");
  CHECK((record.frame.fd && record.frame.bit_rate_switch && record.frame.length == 2));
  record = parse("(0.0) c 20000004#0004000000000000");
  CHECK((record.frame.error && record.frame.id == 4 && !record.frame.extended));
}

TEST_CASE("empty lines and comments carry nothing", "[candump]") {
  for (const char* line : {"", "\n", "   \r\n", "# a comment", "  # (0.0) can0 123#"}) {
    CHECK_FALSE(parse_candump_line(line, 1));
  }
}

TEST_CASE("what is wrong with a line is said", "[candump]") {
  CHECK(refusal("hello").find("expected a time") == 0);
  CHECK(refusal("(12) can0 123#") == "the time has no decimal point");
  CHECK(refusal("(12.1234567890) can0 123#") == "the time needs 1 to 9 decimals");
  CHECK(refusal("(1x.000000) can0 123#") == "'1x' in the time is not a whole number");
  CHECK(refusal("(-1.000000) can0 123#") == "'-1' in the time is not a whole number");
  CHECK(refusal("(.000000) can0 123#") == "'' in the time is not a whole number");
  CHECK(refusal("(99999999999.0) can0 123#") == "the time is beyond the year 2255");
  CHECK(refusal("(0.0) can0") == "expected: (time) interface identifier#data");
  CHECK(refusal("(0.0) can0 123") == "no '#' in '123'");
  CHECK(refusal("(0.0) can0 12#") ==
        "the identifier '12' needs 3 digits (standard) or 8 (extended)");
  CHECK(refusal("(0.0) can0 1G3#") == "the identifier '1G3' is not hexadecimal");
  CHECK(refusal("(0.0) can0 800#") == "the identifier 800 is above 7FF");
  CHECK(refusal("(0.0) can0 40000000#") == "the identifier 40000000 is above 1FFFFFFF");
  CHECK(refusal("(0.0) can0 123#0") == "half a byte: an odd number of data digits");
  CHECK(refusal("(0.0) can0 123#0x") == "'0x' in the data is not hexadecimal");
  CHECK(refusal("(0.0) can0 123#001122334455667788") == "9 data bytes; at most 8 fit");
  CHECK(refusal("(0.0) can0 123##") == "'##' must be followed by one hexadecimal digit of flags");
  CHECK(refusal("(0.0) can0 123##8") == "unknown FD flags '8'");
  CHECK(refusal("(0.0) can0 123##0001122334455667788") == "no CAN FD frame has 9 data bytes");
  CHECK(refusal("(0.0) can0 123#R9") == "a remote request has a length of 0 to 8, not '9'");
  CHECK(refusal("(0.0) can0 20000001#R") == "an error frame cannot be a remote request");
  CHECK(refusal("(0.0) can0 123# X") == "unexpected 'X' behind the frame");
  CHECK(refusal("(0.0) can0 123# R R") == "unexpected 'R' at the end of the line");
}

TEST_CASE("every frame survives writing and reading", "[candump]") {
  const unsigned seed = 91;
  INFO("seed " << seed);
  std::mt19937_64 random(seed);
  for (int i = 0; i < 20'000; ++i) {
    const CanFrame frame = any_frame(random);
    const std::int64_t stamp_ns =
        static_cast<std::int64_t>(random() % 4'000'000'000'000'000) * 1000;
    const std::string line = line_of(stamp_ns, frame);
    const auto record = parse_candump_line(line, i);
    if (!record || !(record->frame == frame) || record->stamp_ns != stamp_ns ||
        record->interface != "can0" ||
        record->frame.error_state_indicator != frame.error_state_indicator) {
      FAIL("not read back: " << line);
    }
  }
}

TEST_CASE("noise and mutilated lines are refused or read, never more", "[candump]") {
  const unsigned seed = 17;
  INFO("seed " << seed);
  std::mt19937_64 random(seed);
  int refused = 0;
  int read = 0;
  for (int i = 0; i < 50'000; ++i) {
    std::string line;
    if (i % 2 == 0) {
      for (std::uint64_t n = random() % 60; n > 0; --n) line += static_cast<char>(random());
    } else {
      line = line_of(static_cast<std::int64_t>(random() % 1'000'000'000'000), any_frame(random));
      for (std::uint64_t n = random() % 4; n > 0; --n) {
        line[random() % line.size()] = "#()R 0AFg.\t\0~"[random() % 13];
      }
      if (random() % 4 == 0) line.resize(random() % line.size());
    }
    try {
      const auto record = parse_candump_line(line, i);
      if (!record) continue;
      ++read;
      // Whatever is accepted can be written, and that line means the same.
      const auto again = parse_candump_line(line_of(record->stamp_ns, record->frame), i);
      REQUIRE(again);
      REQUIRE(again->frame == record->frame);
    } catch (const CandumpError&) {
      ++refused;
    }
  }
  CHECK(refused > 25'000);
  CHECK(read > 5'000);
}

TEST_CASE("a reader goes through a log and names the line that is wrong", "[candump]") {
  std::istringstream log(
      "# a log\n(1.000000) can0 001#01\n\n(2.000000) can1 002#02 T\n(3.0) can0 zzz#\n");
  CandumpReader reader(log, "run/bus.log");
  CHECK(reader.next()->frame == frame_of(1, {1}));
  CHECK(reader.line_number() == 2);
  CHECK(reader.next()->interface == "can1");
  CHECK_THROWS_WITH(reader.next(), "run/bus.log:5: the identifier 'zzz' is not hexadecimal");
  CHECK_FALSE(reader.next());
}

}  // namespace hoof::bridge
