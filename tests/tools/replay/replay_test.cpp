// Runs recorded here, and recordings of old, let drive the firmware again.

#include "tools/replay/replay.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "hil_bridge/bus_log.h"
#include "hil_bridge/fault_targets.h"
#include "tests/hil_bridge/rigid_bench.h"
#include "tests/tools/run/scratch_folder.h"
#include "tools/log/decoded_frame.h"
#include "tools/run/output_file.h"

using hoof::test::rigid_bench;
using hoof::test::rigid_run;
using namespace hoof::tools;
namespace bridge = hoof::bridge;
namespace protocol = hoof::firmware::protocol;
namespace fs = std::filesystem;

namespace {

struct Recorded {
  BusRecording bus;
  bridge::RecordingFacts facts;
};

/// Homing, opening and some of the test itself, through a real bus.log.
Recorded record(const std::string& kind, int ticks, const std::vector<std::string>& set = {}) {
  const RunSettings run = rigid_run(kind, set);
  const hoof::tests::ScratchFolder scratch;
  {
    bridge::BusLogWriter log({(scratch.path() / "bus.log").string()});
    const auto wires = bridge::in_process_wires(
        [&](int bus, const hoof::hal::CanFrame& frame) { log.write(bus, frame); });
    const auto bench = rigid_bench(run);
    bridge::LockStep lock_step(*bench, run.parameters, *wires);
    lock_step.supervisor().order(protocol::Order::kReady, run.toe_rad());
    for (int i = 0; i < ticks; ++i) lock_step.tick();
    log.close();
  }
  return {read_bus_log(scratch.path()),
          bridge::parse_recording_facts(
              to_json(bridge::recording_facts(run.bus, run.coupling.exchange_s, run.parameters)),
              "recording.json")};
}

bool from_foot(const LoggedFrame& logged) {
  const MessageSpec* message = find_message(logged.frame);
  return message != nullptr && message->sender == protocol::Node::kFoot;
}

/// Index of the n-th frame of the foot with this identifier.
std::size_t nth(const BusRecording& recording, std::uint32_t id, int n) {
  for (std::size_t i = 0; i < recording.frames.size(); ++i) {
    if (recording.frames[i].frame.id == id && n-- == 0) return i;
  }
  FAIL("no such frame");
  return 0;
}

std::uint32_t id_of(protocol::Message message) {
  return protocol::spec(message).id;
}

}  // namespace

TEST_CASE("runs of both kinds replay to the same bytes, whatever the exchange interval") {
  for (const std::string kind : {"sinkage", "traction"}) {
    for (const std::string exchange : {"50", "100", "20"}) {
      CAPTURE(kind, exchange);
      const Recorded r = record(kind, 1500, {"coupling.exchange_us=" + exchange});
      const ReplayResult result = replay(r.bus, r.facts);
      if (result.difference) FAIL(result.difference->text(r.bus.interfaces));
      const auto answers = std::count_if(r.bus.frames.begin(), r.bus.frames.end(), from_foot);
      // Not more than the last ones, still on their way when the recording ended.
      CHECK(result.compared == std::uint64_t(answers));
      CHECK(result.compared > 1500);
      CHECK(result.fed == r.bus.frames.size() - result.compared);
      CHECK(result.last_tick == 1499);
    }
  }
}

TEST_CASE("a changed byte of any answer is found at its tick, by signal and with both values") {
  Recorded r = record("sinkage", 1200);
  const std::size_t place = nth(r.bus, id_of(protocol::Message::kToeCommand), 700);
  hoof::hal::CanFrame& frame = r.bus.frames[place].frame;
  const Signal& torque = protocol::command_spec(protocol::Drive::kToe).signals[4];
  const std::uint32_t was = raw_of(frame, torque);
  set_raw(frame, torque, was ^ 1);
  const ReplayResult result = replay(r.bus, r.facts);
  REQUIRE(result.difference);
  CHECK(result.difference->tick == 700);
  CHECK(result.difference->bus == 0);
  const std::string text = result.difference->text(r.bus.interfaces);
  CAPTURE(text);
  CHECK_THAT(text, Catch::StartsWith("tick 700, 0.700"));
  CHECK_THAT(text, Catch::Contains("can0, ToeCommand (0x021): torque_Nm recorded "));
  CHECK_THAT(text, Catch::Contains(value_text(torque, value_of(torque, frame)) + " Nm, now "));
  set_raw(frame, torque, was);
  CHECK_FALSE(replay(r.bus, r.facts).difference);
}

TEST_CASE("random bits flipped in answers are all found, none elsewhere invented") {
  const auto seed = std::random_device()();
  CAPTURE(seed);
  std::mt19937 random(seed);
  const Recorded r = record("traction", 900);
  std::vector<std::size_t> answers;
  for (std::size_t i = 0; i < r.bus.frames.size(); ++i) {
    if (from_foot(r.bus.frames[i])) answers.push_back(i);
  }
  for (int round = 0; round < 30; ++round) {
    BusRecording changed = r.bus;
    const std::size_t place = answers[random() % answers.size()];
    auto& frame = changed.frames[place].frame;
    const unsigned bit = random() % (8u * frame.length);
    frame.data[bit / 8] ^= std::uint8_t(1u << (bit % 8));
    CAPTURE(place, bit);
    const ReplayResult result = replay(changed, r.facts);
    REQUIRE(result.difference);
    REQUIRE(result.difference->recorded);
    CHECK(*result.difference->recorded == frame);
    CHECK(*result.difference->replayed == r.bus.frames[place].frame);
    CHECK(result.compared ==
          std::uint64_t(std::count_if(answers.begin(), answers.end(),
                                      [place](std::size_t at) { return at < place; })));
  }
}

TEST_CASE("an answer too few and one too many are told apart") {
  const Recorded r = record("sinkage", 600);
  BusRecording fewer = r.bus;
  const std::size_t place = nth(fewer, id_of(protocol::Message::kToeCommand), 300);
  fewer.frames.erase(fewer.frames.begin() + std::ptrdiff_t(place));
  const ReplayResult extra = replay(fewer, r.facts);
  REQUIRE(extra.difference);
  CHECK_FALSE(extra.difference->recorded);
  CHECK(extra.difference->tick == 300);
  CHECK_THAT(extra.difference->text(fewer.interfaces),
             Catch::Contains("ToeCommand (0x021): not in the recording, now sent"));

  BusRecording more = r.bus;
  LoggedFrame again = more.frames[place];
  again.stamp_ns += 300'000;
  const auto behind = std::find_if(more.frames.begin(), more.frames.end(),
                                   [&](const auto& f) { return f.stamp_ns > again.stamp_ns; });
  more.frames.insert(behind, again);
  const ReplayResult missing = replay(more, r.facts);
  REQUIRE(missing.difference);
  CHECK_FALSE(missing.difference->replayed);
  CHECK_THAT(missing.difference->text(more.interfaces), Catch::Contains("now not sent"));
}

TEST_CASE("what the firmware hears counts: another order, a lost SYNC, another parameter") {
  Recorded r = record("sinkage", 900);
  SECTION("a reply of the toe drive with another position") {
    auto& frame = r.bus.frames[nth(r.bus, id_of(protocol::Message::kToeReply), 400)].frame;
    const Signal& position = protocol::reply_spec(protocol::Drive::kToe).signals[1];
    set_raw(frame, position, raw_of(frame, position) + 200);
  }
  SECTION("a lost SYNC") {
    const std::size_t place = nth(r.bus, id_of(protocol::Message::kSync), 2 * 500);
    r.bus.frames.erase(r.bus.frames.begin() + std::ptrdiff_t(place));
    if (r.bus.frames[place].frame.id == id_of(protocol::Message::kSync)) {
      r.bus.frames.erase(r.bus.frames.begin() + std::ptrdiff_t(place));
    }
  }
  SECTION("another stiffness of the toes") {
    r.facts.parameters.control.toe.kp_Nm_rad *= 1.01f;
  }
  CHECK(replay(r.bus, r.facts).difference);
}

TEST_CASE("a replay told to stop at a tick stops where the tick has run") {
  const Recorded r = record("sinkage", 400);
  ReplayOptions options;
  options.to_tick = 123;
  std::uint32_t before = 0, after = 0;
  options.at_tick = [&](const auto& loop) { before = loop.telemetry().tick; };
  options.after_tick = [&](const auto& loop) { after = loop.telemetry().tick; };
  const ReplayResult result = replay(r.bus, r.facts, options);
  CHECK(result.stopped);
  CHECK(before == 122);
  CHECK(after == 123);
  CHECK(result.last_tick == 123);
}

TEST_CASE("recordings that cannot be replayed exactly are refused, with the reason") {
  Recorded r = record("sinkage", 10);
  SECTION("over SocketCAN") {
    r.facts.wires = "vcan0";
    CHECK_THROWS_WITH(replay(r.bus, r.facts), Catch::Contains("recorded over 'vcan0'"));
  }
  SECTION("polls between microseconds") {
    r.facts.exchange_ns = 62'500;
    CHECK_THROWS_WITH(replay(r.bus, r.facts), Catch::Contains("exchange_ns = 62500"));
  }
}

TEST_CASE("recording.json keeps every parameter to the bit and names what it does not know") {
  const auto facts = bridge::recording_facts("in_process", 5e-5, {});
  bridge::RecordingFacts odd = facts;
  odd.parameters.control.toe.kp_Nm_rad = 249.99998f;
  const auto read = bridge::parse_recording_facts(to_json(odd), "r.json");
  CHECK(read.parameters.control.toe.kp_Nm_rad == 249.99998f);
  CHECK(read.exchange_ns == 50'000);
  CHECK(read.protocol_hash == facts.protocol_hash);
  CHECK(read.notes.empty());
  CHECK(read.unseen_faults.empty());
  CHECK(to_json(read) == to_json(odd));
  odd.unseen_faults = {"fault.0 (estop line)"};
  CHECK(bridge::parse_recording_facts(to_json(odd), "r.json").unseen_faults == odd.unseen_faults);

  std::string renamed = to_json(facts);
  const std::string name(hoof::firmware::app::parameter_table()[0].name);
  renamed.replace(renamed.find(name), name.size(), "of_old");
  const auto old = bridge::parse_recording_facts(renamed, "r.json");
  REQUIRE(old.notes.size() == 2);
  CHECK_THAT(old.notes[0], Catch::Contains("no parameter of_old"));
  CHECK_THAT(old.notes[1], Catch::Contains("the recording has no parameter " + name));

  const auto refused = [](const char* text) { bridge::parse_recording_facts(text, "r.json"); };
  CHECK_THROWS_WITH(refused("{"), Catch::StartsWith("r.json: "));
  CHECK_THROWS_WITH(refused("{\"format\": 2}"), Catch::Contains("reads 1 to 1"));
  CHECK_THROWS_WITH(refused("{\"format\": 1}"), Catch::Contains("no 'wires'"));
}

TEST_CASE("faults that reach the firmware by ways that the bus does not show are known as such") {
  using bridge::FaultKind;
  const auto unseen = [](FaultKind kind, const char* target) {
    bridge::FaultSpec fault;
    fault.kind = kind;
    fault.target = target;
    return bridge::unseen_by_bus(fault, bridge::find_target(fault, {true, true, true}));
  };
  CHECK(unseen(FaultKind::kBrownOut, "foot"));
  CHECK(unseen(FaultKind::kEstop, "line"));
  CHECK(unseen(FaultKind::kNodeRestart, "foot"));
  CHECK(unseen(FaultKind::kBusOff, "foot"));
  CHECK(unseen(FaultKind::kCorrupt, "HipCommand"));
  CHECK(unseen(FaultKind::kDelay, "can1"));
  CHECK_FALSE(unseen(FaultKind::kEstop, "can0"));
  CHECK_FALSE(unseen(FaultKind::kNodeRestart, "hip"));
  CHECK_FALSE(unseen(FaultKind::kDrop, "HipReply"));
  CHECK_FALSE(unseen(FaultKind::kNodeSilent, "sync"));
  CHECK_FALSE(unseen(FaultKind::kEncoderJump, "knee"));
  CHECK_FALSE(unseen(FaultKind::kFlood, "can0"));
}

TEST_CASE("old recordings still replay, to the hash that is kept with them") {
  const fs::path folder = fs::path(HOOF_TEST_DATA_DIR) / "replay";
  int seen = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (!entry.is_directory()) continue;
    CAPTURE(entry.path().filename());
    const BusRecording bus = read_bus_log(entry.path());
    const auto facts = bridge::parse_recording_facts(
        read_file(entry.path() / bridge::kRecordingFactsFile), entry.path().string());
    const ReplayResult result = replay(bus, facts);
    if (result.difference) FAIL(result.difference->text(bus.interfaces));
    CHECK(result.answers_sha256 + "\n" == read_file(entry.path() / "answers.sha256"));
    CHECK(result.compared > 500);
    ++seen;
  }
  CHECK(seen >= 2);
}
