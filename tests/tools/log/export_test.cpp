#include "tools/log/export.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "hil_bridge/recording.h"
#include "tools/log/decoded_frame.h"
#include "tools/log/signal_series.h"
#include "tools/run/errors.h"

using namespace hoof::tools;
namespace protocol = hoof::firmware::protocol;

namespace {

LoggedFrame logged(int bus, const hoof::hal::CanFrame& frame, std::int64_t time_us) {
  return {hoof::bridge::kSimulatedEpoch_ns + time_us * 1000, bus, frame};
}

/// A command, a switch, a reply and a frame that nobody knows.
BusRecording small_recording() {
  BusRecording r;
  r.path = "small.log";
  r.interfaces = {"can0", "can1"};
  r.origin_ns = hoof::bridge::kSimulatedEpoch_ns;
  r.frames.push_back(logged(0, encode(protocol::Sync{0xFFFFFFFFu}), 95));
  r.frames.push_back(
      logged(0, encode_switch(protocol::Drive::kToe, protocol::DriveSwitch::kEnter), 300));
  protocol::DriveCommand command;
  command.position_rad = 0.5f;
  r.frames.push_back(logged(0, encode_command(protocol::Drive::kToe, command), 1300));
  protocol::DriveReply reply;
  reply.position_rad = -0.25f;
  reply.temperature_C = 40;
  r.frames.push_back(logged(1, encode_reply(protocol::Drive::kHip, reply), 1400));
  hoof::hal::CanFrame unknown;
  unknown.id = 0x7AB;
  unknown.length = 2;
  unknown.data[0] = 0xAB;
  r.frames.push_back(logged(0, unknown, 1500));
  return r;
}

}  // namespace

TEST_CASE("values are the codec's own, whole numbers exact") {
  protocol::DriveReply reply;
  reply.position_rad = 0.7f;
  reply.torque_Nm = -1.5f;
  const auto frame = encode_reply(protocol::Drive::kToe, reply);
  protocol::DriveReply read;
  REQUIRE(decode_reply(protocol::Drive::kToe, frame, read) == protocol::DecodeResult::kOk);
  const MessageSpec* message = find_message(frame);
  REQUIRE(message == &protocol::reply_spec(protocol::Drive::kToe));
  for (const Signal& signal : message->signals) {
    if (signal.name == "position_rad") CHECK(value_of(signal, frame) == double(read.position_rad));
    if (signal.name == "torque_Nm") CHECK(value_of(signal, frame) == double(read.torque_Nm));
    if (signal.name == "drive_id") CHECK(value_of(signal, frame) == 1);
  }
  const auto sync = encode(protocol::Sync{0xFFFFFFFFu});
  const Signal& tick = find_message(sync)->signals[0];
  CHECK(value_text(tick, value_of(tick, sync)) == "4294967295");  // a float would say ...296
}

TEST_CASE("JSON lines hold bytes always, signals where the bytes are values") {
  std::ostringstream out;
  export_json(small_recording(), out);
  std::istringstream in(out.str());
  std::vector<nlohmann::json> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(nlohmann::json::parse(line));
  REQUIRE(lines.size() == 5);
  CHECK(lines[0]["signals"]["tick"] == 0xFFFFFFFFu);
  CHECK(lines[0]["time_s"] == 0.000095);
  CHECK(lines[1]["switch"] == "enter");
  CHECK_FALSE(lines[1].contains("signals"));
  CHECK(lines[2]["signals"]["position_rad"].get<double>() == Approx(0.5).margin(4e-4));
  CHECK(lines[3]["name"] == "HipReply");
  CHECK(lines[3]["bus"] == 1);
  CHECK(lines[4]["data"] == "AB00");
  CHECK_FALSE(lines[4].contains("name"));
}

TEST_CASE("CSV has a column for each wanted signal, empty where a frame has none") {
  std::ostringstream out;
  export_csv(small_recording(), {"ToeCommand.position_rad", "*Reply.temperature_C"}, out);
  std::istringstream in(out.str());
  std::string head, command, reply, more;
  std::getline(in, head), std::getline(in, command), std::getline(in, reply);
  CHECK(head == "time_s,ToeCommand.position_rad,HipReply.temperature_C");
  // The code next to 0.5 rad.
  CHECK_THAT(command, Catch::StartsWith("0.001300,0.4999") && Catch::EndsWith(","));
  CHECK(reply == "0.001400,,40");
  CHECK_FALSE(std::getline(in, more));  // the switch is no value
}

TEST_CASE("patterns, and a suggestion for a signal that is not there") {
  CHECK(matches_pattern("*", ""));
  CHECK(matches_pattern("*.torque_Nm", "ToeReply.torque_Nm"));
  CHECK(matches_pattern("Toe*.*_rad", "ToeReply.position_rad"));
  CHECK_FALSE(matches_pattern("Toe", "ToeReply"));
  CHECK_FALSE(matches_pattern("*x", "ToeReply"));
  CHECK_NOTHROW(require_known_signals({"ToeReply.*"}));
  CHECK_THROWS_WITH(require_known_signals({"ToeReply.positon_rad"}),
                    Catch::Contains("did you mean ToeReply.position_rad?"));
}

TEST_CASE("series leave out switches and what does not read") {
  BusRecording r = small_recording();
  r.frames.push_back(logged(0, encode(protocol::Heartbeat{}), 2000));
  r.frames.back().frame.data[1] ^= 1;  // the CRC is wrong now
  const auto series = series_of(r, {"ToeCommand.position_rad", "Heartbeat.*"});
  REQUIRE(series.size() == 1);
  CHECK(series[0].values.size() == 1);
  CHECK(series[0].time_s[0] == Approx(0.0013));
}
