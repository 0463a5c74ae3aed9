#include "firmware/app/parameter_store.h"

#include <bit>
#include <catch2/catch.hpp>
#include <random>
#include <set>
#include <vector>

#include "firmware/app/crc32.h"
#include "hal/in_process/ram_flash.h"

using namespace hoof::firmware::app;
using hoof::firmware::control::Mode;
using hoof::hal::CutOutcome;
using hoof::hal::FlashResult;
using hoof::hal::PowerCut;
using hoof::hal::RamFlash;
using Word = RamFlash::Word;
using Bits = std::vector<Word>;

namespace {

constexpr std::array<std::size_t, 2> kSectors{1, 2};
constexpr std::array kOutcomes{CutOutcome::kOld, CutOutcome::kNew, CutOutcome::kMixed,
                               CutOutcome::kUnstable};

/// 1 KB each: as small as today's table allows, so that whole sectors are quickly looked through.
RamFlash make_flash(std::uint32_t seed = 1) {
  return RamFlash({8, 256, 256}, seed);
}

/// All values, bit for bit.
Bits bits_of(Parameters parameters) {
  Bits bits;
  for (const ParameterEntry& entry : parameter_table()) {
    bits.push_back(std::bit_cast<Word>(entry.value(parameters)));
  }
  return bits;
}

/// Differs from every other seed's set, and from the defaults, in each parameter: no mixture of two
/// sets goes unseen.
Parameters random_set(std::uint32_t seed) {
  std::mt19937 random(seed);
  Parameters parameters;
  for (const ParameterEntry& entry : parameter_table()) {
    const float share = static_cast<float>(random() >> 8) / 16777216.0f;
    entry.value(parameters) = entry.minimum + (entry.maximum - entry.minimum) * share;
  }
  return parameters;
}

LoadReport boot(RamFlash& flash, Bits& bits) {
  Parameters parameters = random_set(0xDEAD);  // what was in the RAM must not show through
  const LoadReport report = ParameterStore(flash, kSectors).load(parameters);
  bits = bits_of(parameters);
  return report;
}

StoreResult store(RamFlash& flash, const Parameters& parameters) {
  return ParameterStore(flash, kSectors).store(parameters, Mode::kOff);
}

/// @return whether the power failed before the store was done
bool store_with_cut(RamFlash& flash, const Parameters& parameters, std::size_t operation,
                    CutOutcome outcome) {
  flash.cut_after(operation, outcome);
  StoreResult result = StoreResult::kFlashFailed;
  try {
    result = store(flash, parameters);
  } catch (const PowerCut&) {
    return true;
  }
  flash.cancel_cut();
  REQUIRE(result == StoreResult::kOk);
  return false;
}

std::size_t record_words() {
  return 4 + 2 * parameter_table().size() + 1;
}

/// Copies the first sector's record into the second, one word of its header changed, under a higher
/// sequence number and a CRC that is right.
void write_newer_record_with(RamFlash& flash, std::size_t word, Word value) {
  Bits words;
  for (std::size_t i = 0; i + 1 < record_words(); ++i) words.push_back(flash.read(kSectors[0], i));
  words[2] += 1;
  words[word] = value;
  words.push_back(Crc32().add(std::span<const Word>(words)).value());
  words.push_back(0);
  for (std::size_t i = 0; i < words.size(); ++i) {
    REQUIRE(flash.program(kSectors[1], i, words[i]) == FlashResult::kOk);
  }
}

}  // namespace

TEST_CASE("RamFlash is flash: erasing sets every bit, programming only clears") {
  RamFlash flash({4, 2});
  CHECK(flash.sector_count() == 2);
  CHECK(flash.sector_words(0) == 4);
  CHECK(flash.sector_words(2) == 0);
  CHECK(flash.read(0, 3) == RamFlash::kErased);
  CHECK(flash.program(0, 3, 0x0F0F) == FlashResult::kOk);
  CHECK(flash.program(0, 3, 0x0F1F) == FlashResult::kNeedsErase);
  CHECK(flash.read(0, 3) == 0x0F0F);
  CHECK(flash.program(0, 3, 0) == FlashResult::kOk);
  CHECK(flash.read(0, 3) == 0);
  CHECK(flash.program(0, 4, 0) == FlashResult::kOutOfRange);
  CHECK(flash.program(2, 0, 0) == FlashResult::kOutOfRange);
  CHECK(flash.erase(2) == FlashResult::kOutOfRange);
  CHECK(flash.read(1, 2) == RamFlash::kErased);
  CHECK(flash.programs() == 2);
  REQUIRE(flash.program(1, 0, 5) == FlashResult::kOk);
  CHECK(flash.erase(0) == FlashResult::kOk);
  CHECK(flash.read(0, 3) == RamFlash::kErased);
  CHECK(flash.read(1, 0) == 5);
  CHECK(flash.operations() == 4);
}

TEST_CASE("RamFlash fails in the operation it is told to, and leaves what it is told to") {
  const Word value = 0x1234'5678;
  std::set<Word> mixed;
  std::set<Word> unstable;
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    for (const CutOutcome outcome : kOutcomes) {
      CAPTURE(seed, static_cast<int>(outcome));
      RamFlash flash({4}, seed);
      flash.cut_after(1, outcome);
      REQUIRE(flash.program(0, 0, 7) == FlashResult::kOk);
      CHECK_THROWS_AS(flash.program(0, 1, value), PowerCut);
      CHECK(flash.read(0, 0) == 7);
      const Word left = flash.read(0, 1);
      CHECK((left & value) == value);  // bits that were not to change did not
      if (outcome == CutOutcome::kOld) CHECK(left == RamFlash::kErased);
      if (outcome == CutOutcome::kNew) CHECK(left == value);
      if (outcome == CutOutcome::kMixed) {
        CHECK(flash.read(0, 1) == left);
        mixed.insert(left);
      }
      if (outcome == CutOutcome::kUnstable) {
        for (int i = 0; i < 20; ++i) unstable.insert(flash.read(0, 1));
        CHECK(flash.program(0, 1, value) == FlashResult::kOk);  // once more makes it firm
        for (int i = 0; i < 20; ++i) CHECK(flash.read(0, 1) == value);
      }
      CHECK(flash.program(0, 2, 9) == FlashResult::kOk);  // the power is back
      flash.cut_after(0, outcome);
      CHECK_THROWS_AS(flash.erase(0), PowerCut);
      if (outcome == CutOutcome::kOld) CHECK(flash.read(0, 2) == 9);
      if (outcome == CutOutcome::kNew) CHECK(flash.read(0, 2) == RamFlash::kErased);
      CHECK(flash.erase(0) == FlashResult::kOk);
      for (std::size_t i = 0; i < 4; ++i) CHECK(flash.read(0, i) == RamFlash::kErased);
    }
  }
  CHECK(mixed.size() > 15);
  CHECK(unstable.size() > 50);
}

TEST_CASE("CRC-32 has its published check value, and words are four bytes, lowest first") {
  CHECK(Crc32().add("123456789").value() == 0xCBF4'3926);
  CHECK(Crc32().value() == 0);
  const std::array<Word, 2> words{0x3433'3231, 0x3837'3635};
  CHECK(Crc32().add(words).add("9").value() == 0xCBF4'3926);
}

TEST_CASE("Names are told apart by their hash, and the table fits a record") {
  std::set<std::uint32_t> hashes;
  for (const ParameterEntry& entry : parameter_table()) {
    CHECK(hashes.insert(Crc32().add(entry.name).value()).second);
  }
  CHECK(parameter_table().size() <= ParameterStore::kMaxEntries);
}

TEST_CASE("Before anything is stored there are defaults; then every value comes back bit for bit") {
  RamFlash flash = make_flash();
  Bits bits;
  CHECK(boot(flash, bits).result == LoadResult::kEmpty);
  CHECK(bits == bits_of({}));
  for (std::uint32_t i = 1; i <= 5; ++i) {
    REQUIRE(store(flash, random_set(i)) == StoreResult::kOk);
    const LoadReport report = boot(flash, bits);
    CHECK(report.complete());
    CHECK(report.sequence == i);
    CHECK(bits == bits_of(random_set(i)));
  }
  CHECK(flash.erases() == 5);
  CHECK(flash.programs() == 5 * (record_words() + 1));
}

TEST_CASE("Nothing is erased or written in a mode other than off") {
  RamFlash flash = make_flash();
  for (const Mode mode : {Mode::kHoming, Mode::kReady, Mode::kRunning, Mode::kDampedStop,
                          Mode::kEmergencyOff, Mode::kFault}) {
    CHECK(ParameterStore(flash, kSectors).store({}, mode) == StoreResult::kWrongMode);
  }
  CHECK(flash.operations() == 0);
}

TEST_CASE("What could not be loaded is not stored") {
  RamFlash flash = make_flash();
  for (const ParameterEntry& entry : parameter_table()) {
    INFO(entry.name);
    for (const float value : {entry.maximum + 1.0f, entry.minimum - 1.0f, __builtin_nanf("")}) {
      Parameters parameters;
      entry.value(parameters) = value;
      CHECK(store(flash, parameters) == StoreResult::kOutOfRange);
    }
  }
  RamFlash small({8, record_words(), record_words()});  // no room for the mark
  CHECK(store(small, {}) == StoreResult::kTooLarge);
  const std::vector<ParameterEntry> many(ParameterStore::kMaxEntries + 1, parameter_table()[0]);
  RamFlash large({8, 512, 512});
  CHECK(ParameterStore(large, kSectors, many).store({}, Mode::kOff) == StoreResult::kTooLarge);
  CHECK(flash.operations() + small.operations() + large.operations() == 0);
}

TEST_CASE("Power cut at every operation of a store: the old set or the new one, and it stays") {
  // Stores before: one (the other sector still blank), two and three (either sector the older one).
  for (std::uint32_t before = 1; before <= 3; ++before) {
    for (const CutOutcome outcome : kOutcomes) {
      std::size_t kept_old = 0;
      std::size_t took_new = 0;
      bool cut = true;
      for (std::size_t operation = 0; cut; ++operation) {
        for (std::uint32_t seed = 1; seed <= 5; ++seed) {
          CAPTURE(before, static_cast<int>(outcome), operation, seed);
          RamFlash flash = make_flash(seed);
          for (std::uint32_t i = 1; i <= before; ++i) store(flash, random_set(i));
          cut = store_with_cut(flash, random_set(99), operation, outcome);
          Bits bits;
          const LoadReport report = boot(flash, bits);
          REQUIRE(report.complete());
          const bool is_new = bits == bits_of(random_set(99));
          const bool is_old = bits == bits_of(random_set(before));
          REQUIRE((is_new || is_old));
          REQUIRE((is_new || cut));
          ++(is_new ? took_new : kept_old);
          for (int i = 0; i < 10; ++i) {
            Bits again;
            boot(flash, again);
            REQUIRE(again == bits);
          }
          REQUIRE(store(flash, random_set(100)) == StoreResult::kOk);
          boot(flash, bits);
          REQUIRE(bits == bits_of(random_set(100)));
        }
      }
      // Erase, record and mark were all cut, and only the last cut or none lets the new set in.
      CHECK(kept_old + took_new == 5 * (record_words() + 3));
      CHECK(took_new >= 5);
      CHECK(took_new <= 10);
    }
  }
}

TEST_CASE("Power cut at every operation of the first store: defaults or the new set, no mixture") {
  for (const CutOutcome outcome : kOutcomes) {
    bool cut = true;
    for (std::size_t operation = 0; cut; ++operation) {
      CAPTURE(static_cast<int>(outcome), operation);
      RamFlash flash = make_flash(7);
      cut = store_with_cut(flash, random_set(1), operation, outcome);
      Bits bits;
      const LoadReport report = boot(flash, bits);
      if (report.result == LoadResult::kOk) {
        CHECK(report.complete());
        CHECK(bits == bits_of(random_set(1)));
      } else {
        CHECK(cut);
        CHECK(bits == bits_of({}));
      }
      REQUIRE(store(flash, random_set(2)) == StoreResult::kOk);
      boot(flash, bits);
      CHECK(bits == bits_of(random_set(2)));
    }
  }
}

TEST_CASE("Cut upon cut, in stores and in loads: never anything but the old or the new set") {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    RamFlash flash = make_flash(seed);
    std::uint32_t present = 1;
    REQUIRE(store(flash, random_set(present)) == StoreResult::kOk);
    for (std::uint32_t attempt = 2; attempt < 100; ++attempt) {
      CAPTURE(seed, attempt, present);
      // Half of the cuts at the end, where they matter.
      const std::size_t words = record_words();
      const std::size_t operation =
          random() % 2 == 0 ? random() % (words + 3) : words + random() % 3;
      const bool cut =
          store_with_cut(flash, random_set(attempt), operation, kOutcomes[random() % 4]);
      flash.cut_after(random() % 2, kOutcomes[random() % 4]);
      Bits bits;
      try {
        boot(flash, bits);
      } catch (const PowerCut&) {
      }
      flash.cancel_cut();
      REQUIRE(boot(flash, bits).complete());
      const bool is_new = bits == bits_of(random_set(attempt));
      REQUIRE((is_new || (cut && bits == bits_of(random_set(present)))));
      if (is_new) present = attempt;
    }
  }
}

TEST_CASE("A record with any bit lost is refused: the older set comes back, then defaults") {
  const std::size_t words = record_words();
  for (std::size_t word = 0; word < words; ++word) {
    for (int bit = 0; bit < 32; ++bit) {
      RamFlash flash = make_flash();
      store(flash, random_set(1));
      store(flash, random_set(2));  // in the second of the two sectors
      const Word value = flash.read(kSectors[1], word);
      const Word damaged = value & ~(Word{1} << bit);
      if (damaged == value) continue;
      CAPTURE(word, bit);
      REQUIRE(flash.program(kSectors[1], word, damaged) == FlashResult::kOk);
      Bits bits;
      REQUIRE(boot(flash, bits).sequence == 1);
      REQUIRE(bits == bits_of(random_set(1)));
      REQUIRE(flash.program(kSectors[0], words - 1, 0) == FlashResult::kOk);  // the other's CRC
      REQUIRE(boot(flash, bits).result == LoadResult::kDamaged);
      REQUIRE(bits == bits_of({}));
    }
  }
}

TEST_CASE("A word that does not hold is noticed, and the former set stays") {
  for (std::size_t word = 0; word <= record_words(); ++word) {
    CAPTURE(word);
    RamFlash flash = make_flash();
    store(flash, random_set(1));
    flash.wear_out(kSectors[1], word);
    CHECK(store(flash, random_set(2)) == StoreResult::kFlashFailed);
    Bits bits;
    CHECK(boot(flash, bits).sequence == 1);
    CHECK(bits == bits_of(random_set(1)));
  }
}

TEST_CASE("Other firmware's parameters are known by name, the rest is counted") {
  const std::span<const ParameterEntry> table = parameter_table();
  const std::span<const ParameterEntry> older = table.first(table.size() - 3);
  const std::span<const ParameterEntry> other = table.subspan(5);
  RamFlash flash = make_flash();
  REQUIRE(ParameterStore(flash, kSectors, older).store(random_set(1), Mode::kOff) ==
          StoreResult::kOk);

  Bits bits;
  LoadReport report = boot(flash, bits);
  CHECK(report.result == LoadResult::kOk);
  CHECK_FALSE(report.complete());
  CHECK(report.missing == 3);
  CHECK(report.unknown == 0);
  for (std::size_t i = 0; i < table.size(); ++i) {
    CHECK(bits[i] == bits_of(i < older.size() ? random_set(1) : Parameters{})[i]);
  }

  Parameters parameters;
  report = ParameterStore(flash, kSectors, other).load(parameters);
  CHECK(report.missing == 3);
  CHECK(report.unknown == 5);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const bool common = i >= 5 && i < older.size();
    CHECK(bits_of(parameters)[i] == bits_of(common ? random_set(1) : Parameters{})[i]);
  }

  // Renamed: not taken for what it was. Narrower range: not taken where it does not fit.
  std::vector<ParameterEntry> changed(older.begin(), older.end());
  changed[0].name = "toe_stiffness_Nm_rad";
  changed[1].maximum = changed[1].minimum;
  report = ParameterStore(flash, kSectors, changed).load(parameters);
  CHECK(report.result == LoadResult::kOk);
  CHECK(report.unknown == 1);
  CHECK(report.missing == 1);
  CHECK(report.out_of_range == 1);
  CHECK(bits_of(parameters)[0] == bits_of({})[0]);
  CHECK(bits_of(parameters)[1] == bits_of({})[1]);
  CHECK(bits_of(parameters)[2] == bits_of(random_set(1))[2]);
}

TEST_CASE("Only what has the magic of a parameter record is one") {
  RamFlash flash = make_flash();
  REQUIRE(store(flash, random_set(1)) == StoreResult::kOk);
  write_newer_record_with(flash, 0, 0x1234'5678);
  Bits bits;
  CHECK(boot(flash, bits).sequence == 1);
  CHECK(bits == bits_of(random_set(1)));
}

TEST_CASE("A record of another layout is refused, named, and succeeded") {
  RamFlash flash = make_flash();
  REQUIRE(store(flash, random_set(1)) == StoreResult::kOk);
  write_newer_record_with(flash, 1, 7);
  Bits bits;
  const LoadReport report = boot(flash, bits);
  CHECK(report.result == LoadResult::kOtherLayout);
  CHECK(report.layout == 7);
  CHECK(report.sequence == 2);
  CHECK(bits == bits_of({}));

  REQUIRE(store(flash, random_set(3)) == StoreResult::kOk);
  CHECK(boot(flash, bits).sequence == 3);
  CHECK(bits == bits_of(random_set(3)));
}
