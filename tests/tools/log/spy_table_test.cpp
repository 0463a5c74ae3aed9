#include "tools/log/spy_table.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <hoof/sample_t.hpp>

using namespace hoof::tools;
namespace protocol = hoof::firmware::protocol;

namespace {

constexpr std::int64_t kMs = 1'000'000;

int lines_in(const std::string& text) {
  return int(std::count(text.begin(), text.end(), '\n'));
}

hoof::bridge::LcmEvent sample(std::int64_t stamp_ns) {
  hoof::sample_t message{};
  message.tick = 712;
  message.depth_m = 0.0125;
  message.foot_force_N[2] = -392.4;
  hoof::bridge::LcmEvent event{"HOOF_SAMPLE", stamp_ns, {}};
  event.data.resize(std::size_t(message.getEncodedSize()));
  message.encode(event.data.data(), 0, int(event.data.size()));
  return event;
}

}  // namespace

TEST_CASE("rates are those of the last second: a message that slows down shows it") {
  SpyTable table;
  for (int i = 0; i <= 2000; ++i) table.add("can0", encode(protocol::Sync{}), i * kMs);
  CHECK_THAT(table.render("x", 0, 0, 0), Catch::Contains("2001    1000.0"));
  for (int i = 1; i <= 30; ++i) table.add("can0", encode(protocol::Sync{}), (2000 + 100 * i) * kMs);
  CHECK_THAT(table.render("x", 0, 0, 0), Catch::Contains("2031      10.0"));
}

TEST_CASE("a message that stopped has no rate once others went on for a second") {
  SpyTable table;
  for (int i = 0; i <= 100; ++i) table.add("can0", encode(protocol::Sync{}), i * kMs);
  table.add("can1", encode(protocol::Sync{}), 5000 * kMs);
  CHECK_THAT(table.render("x", 0, 0, 0), Catch::Contains("Sync                   101       0.0"));
}

TEST_CASE("the chosen message shows its values, by name and unit; nothing is wider or longer") {
  SpyTable table;
  protocol::Heartbeat heartbeat;
  heartbeat.mode = protocol::Mode::kRunning;
  table.add("can0", encode(heartbeat), 0);
  protocol::DriveReply reply;
  reply.temperature_C = 40;
  table.add("can0", encode_reply(protocol::Drive::kToe, reply), 0);
  for (std::uint32_t id = 0x700; id < 0x730; ++id) {
    hoof::hal::CanFrame frame;
    frame.id = id;
    table.add("can0", frame, 0);
  }
  // By identifier: ToeReply 0x031 first, Heartbeat 0x050 second.
  CHECK_THAT(table.render("x", 0, 80, 24), Catch::Contains("temperature_C        40 "));
  CHECK_THAT(table.render("x", 1, 80, 24), Catch::Contains("mode                 3 (running)"));
  for (const int height : {3, 5, 12, 24, 60}) {
    const std::string view = table.render("x", 30, 40, height);
    CHECK(lines_in(view) <= height);
    CHECK_THAT(view, Catch::Contains("71C"));  // the 30th is in sight
  }
}

TEST_CASE("an empty table is drawn, too") {
  CHECK(lines_in(SpyTable().render("nothing yet", 0, 80, 24)) >= 1);
}

TEST_CASE("an LCM channel is a row: its type, its rate, and the fields of the last event") {
  SpyTable table;
  for (int i = 0; i <= 100; ++i) table.add(sample(i * 10 * kMs));
  const std::string all = table.render("x", 0, 0, 0);
  CHECK_THAT(all, Catch::Contains("HOOF_SAMPLE") && Catch::Contains("101     100.0"));
  CHECK_THAT(all, Catch::Contains("hoof.sample_t"));
  CHECK_THAT(all, Catch::Contains("tick                     712"));
  CHECK_THAT(all, Catch::Contains("depth_m                  0.0125"));
  CHECK_THAT(all, Catch::Contains("foot_force_N             0  0  -392.4"));
  CHECK(lines_in(table.render("x", 0, 60, 24)) <= 24);
}

TEST_CASE("an event that is cut off, or of another type, is shown as not known") {
  hoof::bridge::LcmEvent event = sample(0);
  const auto whole = event.data;
  SECTION("cut off") {
    event.data.pop_back();
  }
  SECTION("another fingerprint") {
    event.data[0] ^= 1;
  }
  SECTION("empty") {
    event.data.clear();
  }
  SpyTable table;
  table.add(event);
  CHECK_THAT(table.render("x", 0, 0, 0), Catch::Contains("unknown type"));
  event.data = whole;
  table.add(event);
  CHECK_THAT(table.render("x", 0, 0, 0), Catch::Contains("hoof.sample_t"));
}
