#include "firmware/protocol/dbc.h"

#include <catch2/catch.hpp>
#include <map>
#include <regex>
#include <sstream>

#include "firmware/protocol/codec.h"

using namespace hoof::firmware::protocol;

namespace {

struct ParsedSignal {
  int start = 0;
  int length = 0;
  double scale = 0.0;
  double offset = 0.0;
};

std::string text() {
  std::ostringstream out;
  write_dbc(out);
  return out.str();
}

/// A reader of its own: message id -> signal name -> numbers.
std::map<int, std::map<std::string, ParsedSignal>> parse(const std::string& dbc) {
  std::map<int, std::map<std::string, ParsedSignal>> messages;
  const std::regex message(R"(^BO_ (\d+) (\w+): (\d+) (\w+)$)");
  const std::regex signal(
      R"(^ SG_ (\w+) : (\d+)\|(\d+)@0\+ \(([^,]+),([^)]+)\) \[[^\]]+\] "[^"]*" \w+$)");
  std::istringstream lines(dbc);
  int id = -1;
  for (std::string line; std::getline(lines, line);) {
    std::smatch m;
    if (std::regex_match(line, m, message)) id = std::stoi(m[1]);
    if (std::regex_match(line, m, signal)) {
      messages[id][m[1]] = {std::stoi(m[2]), std::stoi(m[3]), std::stod(m[4]), std::stod(m[5])};
    }
  }
  return messages;
}

/// Motorola order as a DBC reader walks it: down the byte from the start bit, then into the next.
std::uint32_t raw_by_dbc(const hoof::hal::CanFrame& frame, const ParsedSignal& signal) {
  std::uint32_t raw = 0;
  int byte = signal.start / 8;
  int bit = signal.start % 8;
  for (int i = 0; i < signal.length; ++i) {
    raw = raw << 1 | (frame.data[byte] >> bit & 1u);
    if (--bit < 0) {
      bit = 7;
      ++byte;
    }
  }
  return raw;
}

}  // namespace

TEST_CASE("The DBC is the same at every writing and names every message and signal") {
  CHECK(text() == text());
  const auto messages = parse(text());
  CHECK(messages.size() == kMessages.size());
  for (const MessageSpec& message : kMessages) {
    INFO(message.name);
    CHECK(messages.at(static_cast<int>(message.id)).size() == message.signals.size());
  }
}

TEST_CASE("Reading a frame by the DBC gives the values that were packed") {
  const auto messages = parse(text());
  const DriveCommand command{0.3f, -2.5f, 7000.0f, 33.0f, -123.0f};
  const auto frame = encode_command(Drive::kHip, command);
  const auto& signals = messages.at(0x022);
  const auto value = [&](const char* name) {
    const ParsedSignal& s = signals.at(name);
    return s.offset + s.scale * raw_by_dbc(frame, s);
  };
  // Half a code each.
  CHECK(value("position_rad") == Approx(0.3).margin(0.5e-4));
  CHECK(value("velocity_rad_s") == Approx(-2.5).margin(0.005));
  CHECK(value("kp_Nm_rad") == Approx(7000.0).margin(2.5));
  CHECK(value("kd_Nm_s_rad") == Approx(33.0).margin(0.062));
  CHECK(value("torque_Nm") == Approx(-123.0).margin(0.1));
}

TEST_CASE("Value tables, cycle times and comments are in the DBC") {
  const std::string dbc = text();
  CHECK(dbc.find("VAL_ 64 order 0 \"stop\" 1 \"ready\" 2 \"run\" 3 \"reset\" 4 \"release\" ;") !=
        std::string::npos);
  CHECK(dbc.find("BA_ \"GenMsgCycleTime\" BO_ 16 1;") != std::string::npos);
  CHECK(dbc.find("CM_ SG_ 33 kp_Nm_rad \"Stiffness\";") != std::string::npos);
  CHECK(dbc.find("[0|4294967295]") != std::string::npos);
}

TEST_CASE("Numbers in the DBC have no exponent, and each reads back as the same float") {
  const std::regex exponent(R"([0-9]e[-+]?[0-9])");
  std::istringstream lines(text());
  for (std::string line; std::getline(lines, line);) {
    INFO(line);
    CHECK_FALSE((line.starts_with(" SG_ ") && std::regex_search(line, exponent)));
  }
  const auto messages = parse(text());
  for (const MessageSpec& message : kMessages) {
    for (const Signal& signal : message.signals) {
      INFO(message.name << '.' << signal.name);
      const ParsedSignal& parsed =
          messages.at(static_cast<int>(message.id)).at(std::string(signal.name));
      CHECK(static_cast<float>(parsed.scale) == signal.scale);
      CHECK(static_cast<float>(parsed.offset) == signal.offset);
    }
  }
}
