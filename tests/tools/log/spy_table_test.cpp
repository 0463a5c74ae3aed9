#include "tools/log/spy_table.h"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace hoof::tools;
namespace protocol = hoof::firmware::protocol;

namespace {

constexpr std::int64_t kMs = 1'000'000;

int lines_in(const std::string& text) {
  return int(std::count(text.begin(), text.end(), '\n'));
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
