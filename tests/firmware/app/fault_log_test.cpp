#include "firmware/app/fault_log.h"

#include <catch2/catch.hpp>
#include <vector>

#include "firmware/app/crc32.h"
#include "hal/in_process/ram_flash.h"

using namespace hoof::firmware::app;
using hoof::firmware::control::Mode;
namespace fault = hoof::firmware::control::fault;
using hoof::hal::CutOutcome;
using hoof::hal::FlashResult;
using hoof::hal::PowerCut;
using hoof::hal::RamFlash;

namespace {

constexpr std::size_t kSector = 1;
constexpr std::size_t kSectorWords = 4096;  // 16 KB
constexpr std::array kOutcomes{CutOutcome::kOld, CutOutcome::kNew, CutOutcome::kMixed,
                               CutOutcome::kUnstable};

/// Room for four records: small, so that a cut at every word stays quick.
constexpr std::size_t kSmallWords = 3 + 4 * kFaultRecordWords + 10;

RamFlash make_flash(std::size_t words = kSmallWords, std::uint32_t seed = 1) {
  return RamFlash({8, words}, seed);
}

/// Different in every field from tick to tick.
TraceSample sample_at(std::uint32_t tick) {
  TraceSample sample;
  sample.tick = tick;
  sample.faults = tick * 3 & 0xF'FFFF;
  sample.mode = static_cast<Mode>(tick % 7);
  sample.active_limits = static_cast<std::uint16_t>(tick * 5 & 0xFFF);
  for (std::size_t joint = 0; joint < 3; ++joint) {
    const float base = static_cast<float>(tick * 10 + joint);
    sample.position_rad[joint] = base + 0.25f;
    sample.velocity_rad_s[joint] = -base - 0.5f;
    sample.torque_Nm[joint] = base * 1e-3f;
  }
  return sample;
}

/// What is expected of a fault after the ticks [first, last].
FaultRecord record_at(std::uint32_t first, std::uint32_t last) {
  FaultRecord record{.time_ns = 0x1234'5678'9ABC + last,
                     .tick = last,
                     .faults = fault::kDriveLost | fault::kToeJammed,
                     .mode = Mode::kRunning};
  for (std::uint32_t tick = last + 1; tick-- > first && record.trace_count < TraceRing::kTicks;) {
    record.trace[record.trace_count++] = sample_at(tick);
  }
  return record;
}

AppendResult append(FaultLog& log, const FaultRecord& record) {
  return log.append(record.faults, record.mode, record.tick, record.time_ns);
}

/// Traces the ticks and appends the fault; the trace starts with this log.
AppendResult append_at(FaultLog& log, std::uint32_t first, std::uint32_t last) {
  for (std::uint32_t tick = first; tick <= last; ++tick) log.trace(sample_at(tick));
  return append(log, record_at(first, last));
}

void write_out(FaultLog& log) {
  while (log.writing()) log.step();
}

/// One start of the firmware with one fault, number `i`.
void live_through_fault(RamFlash& flash, std::uint32_t i) {
  FaultLog log(flash, kSector);
  REQUIRE(append_at(log, 100 * i, 100 * i + 40) == AppendResult::kAccepted);
  write_out(log);
}
FaultRecord expected_fault(std::uint32_t i) {
  return record_at(100 * i, 100 * i + 40);
}

void format(RamFlash& flash) {
  const EraseResult result = FaultLog(flash, kSector).erase(Mode::kOff);  // the power may be cut
  REQUIRE(result == EraseResult::kOk);
}

template <typename Action>
bool survives(Action&& action) {
  try {
    action();
  } catch (const PowerCut&) {
    return false;
  }
  return true;
}

}  // namespace

TEST_CASE("A log that was never erased takes nothing; it is erased in mode off only") {
  RamFlash flash = make_flash(kSectorWords);
  FaultLog log(flash, kSector);
  CHECK(log.state() == LogState::kUnformatted);
  CHECK(append_at(log, 1, 2) == AppendResult::kNotFormatted);
  CHECK(log.lost() == 1);
  for (const Mode mode : {Mode::kHoming, Mode::kReady, Mode::kRunning, Mode::kDampedStop,
                          Mode::kEmergencyOff, Mode::kFault}) {
    CHECK(log.erase(mode) == EraseResult::kWrongMode);
  }
  CHECK(flash.operations() == 0);
  CHECK(log.erase(Mode::kOff) == EraseResult::kOk);
  CHECK(log.state() == LogState::kReady);
  CHECK(log.capacity() == 13);
  CHECK(log.used() == 0);
  CHECK_FALSE(log.read(0).has_value());
  CHECK(FaultLog(flash, kSector).state() == LogState::kReady);
}

TEST_CASE("A fault and the ticks before it come back, in this life and the next") {
  RamFlash flash = make_flash();
  format(flash);
  FaultLog log(flash, kSector);
  CHECK(append(log, FaultRecord{}) == AppendResult::kAccepted);  // before the first tick
  write_out(log);
  CHECK(append_at(log, 1, 5) == AppendResult::kAccepted);
  // What is traced and found while the record is written is not in it.
  log.trace(sample_at(6));
  CHECK(append(log, record_at(1, 6)) == AppendResult::kBusy);
  CHECK(log.erase(Mode::kOff) == EraseResult::kBusy);
  CHECK(log.used() == 1);
  write_out(log);
  for (std::uint32_t tick = 7; tick <= 100; ++tick) log.trace(sample_at(tick));
  CHECK(append(log, record_at(1, 100)) == AppendResult::kAccepted);
  write_out(log);
  CHECK(log.lost() == 1);
  const FaultLog later(flash, kSector);
  for (const FaultLog* reader : std::initializer_list<const FaultLog*>{&log, &later}) {
    CHECK(reader->used() == 3);
    CHECK(reader->read(0) == FaultRecord{});
    CHECK(reader->read(1) == record_at(1, 5));
    CHECK(reader->read(1)->trace_count == 5);
    CHECK(reader->read(2) == record_at(1, 100));
    CHECK(reader->read(2)->trace_count == TraceRing::kTicks);
    CHECK(reader->read(2)->trace[0] == sample_at(100));
    CHECK_FALSE(reader->read(3).has_value());
  }
}

TEST_CASE("While running nothing is erased and few words are written a tick; a full log says so") {
  RamFlash flash = make_flash();
  format(flash);
  const std::size_t erases = flash.erases();
  FaultLog log(flash, kSector);
  REQUIRE(log.capacity() == 4);
  for (std::uint32_t i = 0; i < 4; ++i) {
    CHECK(log.state() == LogState::kReady);
    std::size_t before = flash.operations();
    REQUIRE(append_at(log, 100 * i, 100 * i + 40) == AppendResult::kAccepted);
    CHECK(flash.operations() == before);
    std::size_t steps = 0;
    for (; log.writing(); ++steps) {
      before = flash.operations();
      log.step();
      CHECK(flash.operations() - before <= FaultLog::kWordsPerStep);
    }
    CHECK(steps == 148);
  }
  CHECK(log.state() == LogState::kFull);
  const std::size_t before = flash.operations();
  CHECK(append_at(log, 900, 940) == AppendResult::kFull);
  for (int i = 0; i < 200; ++i) log.step();
  CHECK(log.lost() == 1);
  CHECK(flash.operations() == before);
  CHECK(flash.erases() == erases);
  FaultLog later(flash, kSector);
  CHECK(later.state() == LogState::kFull);
  for (std::uint32_t i = 0; i < 4; ++i) CHECK(later.read(i) == expected_fault(i));
  CHECK(later.erase(Mode::kOff) == EraseResult::kOk);
  CHECK(later.used() == 0);
  live_through_fault(flash, 7);
  CHECK(FaultLog(flash, kSector).read(0) == expected_fault(7));
}

TEST_CASE("Power cut at every word of a record: the others stay, the torn one is skipped") {
  for (const CutOutcome outcome : kOutcomes) {
    for (std::size_t word = 0; word < kFaultRecordWords; ++word) {
      CAPTURE(static_cast<int>(outcome), word);
      RamFlash flash = make_flash(kSmallWords, static_cast<std::uint32_t>(word + 1));
      format(flash);
      live_through_fault(flash, 0);
      flash.cut_after(word, outcome);
      REQUIRE_FALSE(survives([&] { live_through_fault(flash, 1); }));
      const FaultLog log(flash, kSector);
      REQUIRE(log.state() == LogState::kReady);
      REQUIRE(log.used() <= 2);
      REQUIRE(log.read(0) == expected_fault(0));
      const bool may_be_whole = word + 1 == kFaultRecordWords && outcome != CutOutcome::kOld;
      if (const auto torn = log.read(1)) {
        REQUIRE(may_be_whole);
        REQUIRE(torn == expected_fault(1));
      }
      live_through_fault(flash, 2);
      const FaultLog later(flash, kSector);
      REQUIRE(later.read(0) == expected_fault(0));
      REQUIRE(later.read(later.used() - 1) == expected_fault(2));
      // Only where the cut left no trace at all is the slot used again.
      if (later.used() == 2) REQUIRE(word == 0);
    }
  }
}

TEST_CASE("Power cut at every operation of an erase: the old log, an empty one, or none") {
  for (const CutOutcome outcome : kOutcomes) {
    bool cut = true;
    for (std::size_t operation = 0; cut; ++operation) {
      for (std::uint32_t seed = 1; seed <= 50; ++seed) {
        CAPTURE(static_cast<int>(outcome), operation, seed);
        RamFlash flash = make_flash(kSmallWords, seed);
        format(flash);
        for (std::uint32_t i = 0; i < 3; ++i) live_through_fault(flash, i);
        flash.cut_after(operation, outcome);
        cut = !survives([&] { format(flash); });
        flash.cancel_cut();
        FaultLog log(flash, kSector);
        if (log.state() == LogState::kReady && log.used() > 0) {
          REQUIRE(operation == 0);
          REQUIRE(log.used() == 3);
          for (std::uint32_t i = 0; i < 3; ++i) REQUIRE(log.read(i) == expected_fault(i));
        } else if (log.state() == LogState::kReady) {
          REQUIRE_FALSE(log.read(0).has_value());
        } else {
          REQUIRE(cut);
          REQUIRE(log.state() == LogState::kUnformatted);
          for (std::uint32_t i = 0; i < 4; ++i) {
            const auto record = log.read(i);
            if (record.has_value()) REQUIRE(record == expected_fault(i));
          }
        }
        REQUIRE(log.erase(Mode::kOff) == EraseResult::kOk);
        live_through_fault(flash, 5);
        REQUIRE(FaultLog(flash, kSector).read(0) == expected_fault(5));
      }
    }
  }
}

TEST_CASE("Without its header a log takes nothing, and can still be read") {
  RamFlash flash = make_flash();
  format(flash);
  live_through_fault(flash, 0);
  REQUIRE(flash.program(kSector, 0, 0) == FlashResult::kOk);
  FaultLog log(flash, kSector);
  CHECK(log.state() == LogState::kUnformatted);
  CHECK(log.read(0) == expected_fault(0));
  CHECK(append_at(log, 1, 2) == AppendResult::kNotFormatted);
}

TEST_CASE("A record with any bit changed is not read") {
  FaultRecordWords words;
  encode(expected_fault(3), words);
  REQUIRE(decode(words) == expected_fault(3));
  for (std::size_t word = 0; word < words.size(); ++word) {
    for (int bit = 0; bit < 32; ++bit) {
      FaultRecordWords damaged = words;
      damaged[word] ^= 1u << bit;
      if (decode(damaged).has_value()) FAIL("word " << word << ", bit " << bit);
    }
  }
  // Under a CRC that is right: a trace longer than there is room for.
  const auto with = [words](std::size_t word, std::uint32_t value) {
    FaultRecordWords other = words;
    other[word] = value;
    const std::span<const std::uint32_t> all(other);
    other.back() = Crc32().add(all.first(other.size() - 1)).value();
    return other;
  };
  CHECK(decode(with(0, words[0])).has_value());
  CHECK_FALSE(decode(with(5, (words[5] & ~0xFFu) | (TraceRing::kTicks + 1))).has_value());
  CHECK_FALSE(decode(with(0, words[0] + 1)).has_value());  // a record of another kind
}

TEST_CASE("A word that does not hold costs a slot, not the record") {
  for (const std::size_t word : {std::size_t{0}, std::size_t{100}, kFaultRecordWords - 1}) {
    CAPTURE(word);
    RamFlash flash = make_flash();
    format(flash);
    flash.wear_out(kSector, 3 + word);
    live_through_fault(flash, 1);
    const FaultLog log(flash, kSector);
    CHECK(log.used() == 2);
    CHECK_FALSE(log.read(0).has_value());
    CHECK(log.read(1) == expected_fault(1));
  }
  RamFlash flash = make_flash();
  format(flash);
  for (std::size_t slot = 0; slot < 4; ++slot)
    flash.wear_out(kSector, 3 + slot * kFaultRecordWords);
  FaultLog log(flash, kSector);
  REQUIRE(append_at(log, 1, 40) == AppendResult::kAccepted);
  write_out(log);
  CHECK(log.state() == LogState::kFull);
  CHECK(log.lost() == 1);
}

TEST_CASE("A log of another layout is left alone until it is erased") {
  RamFlash flash = make_flash();
  const std::array<std::uint32_t, 2> head{0x4846'4C47, 9};
  flash.program(kSector, 0, head[0]);
  flash.program(kSector, 1, head[1]);
  flash.program(kSector, 2, Crc32().add(head).value());
  FaultRecordWords words;
  encode(expected_fault(1), words);
  for (std::size_t i = 0; i < words.size(); ++i) flash.program(kSector, 3 + i, words[i]);
  const std::size_t before = flash.operations();
  FaultLog log(flash, kSector);
  CHECK(log.state() == LogState::kOtherLayout);
  CHECK_FALSE(log.read(0).has_value());  // its words may mean anything
  CHECK(append_at(log, 1, 2) == AppendResult::kNotFormatted);
  for (int i = 0; i < 200; ++i) log.step();
  CHECK(flash.operations() == before);
  CHECK(log.erase(Mode::kOff) == EraseResult::kOk);
  CHECK(log.state() == LogState::kReady);
}

TEST_CASE("A sector that is too small, or not there, is no log") {
  for (const std::size_t words : {std::size_t{0}, std::size_t{2}, kFaultRecordWords}) {
    RamFlash flash = make_flash(words);
    FaultLog log(flash, kSector);
    CHECK(log.capacity() == 0);
    CHECK(log.erase(Mode::kOff) == EraseResult::kFlashFailed);
    CHECK(append_at(log, 1, 2) != AppendResult::kAccepted);
  }
}
