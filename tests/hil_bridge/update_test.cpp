// A firmware update over the bus, with all that can go wrong on the way, on a foot whose images are
// small, so that the supply can fail at every single write.
#include <catch2/catch.hpp>
#include <deque>

#include "tests/hil_bridge/update_bench.h"

using namespace hoof;
using namespace hoof::test;
using bridge::ServiceError;
using Catch::Contains;
using firmware::update::Problem;

namespace {

constexpr std::uint32_t kOld = 7, kNew = 8;

bridge::UpdateImage new_image(const SigningKey& key, std::uint32_t version = kNew,
                              std::size_t slot = 1) {
  return update_image({.version = version, .slot = slot, .words = kBenchImageWords}, key);
}

/// The whole of it, as the command does.
void update(UpdateBench& bench, const bridge::UpdateImage& image) {
  bench.client.greet();
  bench.updates.send(image, {});
  bench.updates.start_and_confirm(image);
}

std::uint32_t running_version(UpdateBench& bench) {
  bench.client.greet();
  return bench.updates.read_status()->version;
}

/// What was running stays, and a good image can still be brought.
void check_unharmed(Part& part, UpdateBench& bench) {
  CHECK(running_version(bench) == kOld);
  CHECK(part.boot() == 0u);
  update(bench, new_image(part.key));
  CHECK(running_version(bench) == kNew);
}

}  // namespace

TEST_CASE("update: from slot A to B and back, each newer than the one before") {
  Part part;
  UpdateBench bench(part);
  std::size_t slot = 1;
  for (std::uint32_t version = kNew; version < kNew + 4; ++version, slot = 1 - slot) {
    std::size_t told = 0;
    const auto image = new_image(part.key, version, slot);
    bench.client.greet();
    bench.updates.send(image, [&](std::size_t done, std::size_t all) {
      CHECK(done == told + (told == 0 ? 33 : 1));
      told = done;
      CHECK(all == 32 + kBenchImageWords);
    });
    CHECK(told == 32 + kBenchImageWords);
    CHECK(bench.running() != slot);
    bench.updates.start_and_confirm(image);
    const auto status = bench.updates.read_status();
    CHECK(status->slot == slot);
    CHECK(status->version == version);
    CHECK_FALSE(status->on_trial);
    CHECK(status->spare_version == version - 1);
    CHECK(part.slot(slot).confirmed());
    bench.power_on();
    CHECK(bench.running() == slot);
  }
}

TEST_CASE(
    "update: cut at every write and erase, the foot starts a sound image, and can be updated") {
  using hal::CutOutcome;
  const auto outcome =
      GENERATE(CutOutcome::kOld, CutOutcome::kNew, CutOutcome::kMixed, CutOutcome::kUnstable);
  int cuts = 0, on_old = 0, on_new = 0;
  for (std::size_t n = 0;; ++n) {
    CAPTURE(int(outcome), n);
    Part part;
    // Something is there already, as after an earlier update.
    write_image(part.flash, 1, make_image({.version = 6, .slot = 1, .words = 30}, part.key));
    part.slot(1).confirm();
    UpdateBench bench(part);
    part.flash.cut_after(n, outcome);
    bool through = true;
    try {
      update(bench, new_image(part.key));
    } catch (const ServiceError&) {
      through = false;
    } catch (const hal::PowerCut&) {  // in the boot loader
      through = false;
    }
    part.flash.cancel_cut();
    if (through) break;
    ++cuts;
    bench.power_on();
    REQUIRE(bench.powered());
    const std::uint32_t version = running_version(bench);
    CHECK((version == kOld || version == kNew));
    (version == kOld ? on_old : on_new) += 1;
    // Again and again the same one, or on trial until it is refused or confirmed.
    if (version == kNew) {
      bench.updates.confirm(kNew);
    } else {
      update(bench, new_image(part.key, kNew + 1));
    }
    const std::uint32_t now = running_version(bench);
    CHECK(now >= kNew);
    for (int i = 0; i < 3; ++i) {
      bench.power_on();
      CHECK(running_version(bench) == now);
    }
  }
  CAPTURE(cuts, on_old, on_new);
  CHECK(cuts > 50);
  CHECK(on_old > 50);
  CHECK(on_new >= 1);
}

TEST_CASE("update: what the header says is refused before anything is erased") {
  struct Case {
    const char* name;
    ImageSpec spec;
    const char* says;
  };
  const std::size_t words = kBenchImageWords;
  const Case cases[] = {
      {"the same version", {.version = kOld, .slot = 1, .words = words}, "not above"},
      {"an older one", {.version = 6, .slot = 1, .words = words}, "not above"},
      {"the wrong slot", {.version = kNew, .slot = 0, .words = words}, "other slot"},
      {"too long", {.version = kNew, .slot = 1, .words = 65}, "length"},
      {"another board", {.version = kNew, .slot = 1, .words = words, .board = 1}, "another board"}};
  for (const Case& c : cases) {
    CAPTURE(c.name);
    Part part;
    write_image(part.flash, 1, make_image({.version = 6, .slot = 1}, part.key));
    UpdateBench bench(part);
    const std::size_t before = part.flash.operations();
    CHECK_THROWS_WITH(update(bench, update_image(c.spec, part.key)), Contains(c.says));
    CHECK(part.flash.operations() == before);
    CHECK(bench.starts() == 1);
    check_unharmed(part, bench);
  }
}

TEST_CASE("update: signed with another key it is refused by the boot loader, and told") {
  Part part;
  UpdateBench bench(part);
  CHECK_THROWS_WITH(update(bench, new_image(SigningKey(2))),
                    Contains("went back to version 7") && Contains("signature"));
  CHECK(bench.running() == 0);
  check_unharmed(part, bench);
}

TEST_CASE(
    "update: one flipped bit of header, signature or image is refused, and the old one stays") {
  for (std::size_t word = 1; word < 32 + kBenchImageWords; ++word) {
    CAPTURE(word);
    Part part;
    UpdateBench bench(part);
    auto image = new_image(part.key);
    std::uint32_t& hit = word < 32 ? image.header.word[word] : image.words[word - 32];
    hit ^= 1u << (word * 11 % 32);
    CHECK_THROWS_AS(update(bench, image), ServiceError);
    CHECK(running_version(bench) == kOld);
    bench.power_on();
    CHECK(bench.running() == 0);
  }
}

TEST_CASE("update: a new image that is sick, crashes, or is never confirmed: the old one is back") {
  Part part;
  UpdateBench bench(part);
  const auto image = new_image(part.key);
  SECTION("a fault that stays") {
    bench.make_new_image_sick();
    CHECK_THROWS_WITH(update(bench, image), Contains("does not report healthy"));
    CHECK(bench.running() == 1);
    bench.run_ms(61'000);
  }
  SECTION("a crash as soon as it starts, each time") {
    bench.crash_in_trial();
    CHECK_THROWS_WITH(update(bench, image), Contains("went back") && Contains("not confirmed"));
    CHECK(bench.starts() == 1 + 3 + 1);
  }
  SECTION("nobody confirms it") {
    bench.client.greet();
    bench.updates.send(image, {});
    bench.client.write_update(firmware::protocol::UpdateObject::kRestart, 0, 50'000'000);
    bench.run_ms(30'000);
    CHECK(bench.running() == 1);
    bench.run_ms(31'000);
  }
  SECTION("nobody confirms it, and its power is switched again and again") {
    bench.client.greet();
    bench.updates.send(image, {});
    bench.client.write_update(firmware::protocol::UpdateObject::kRestart, 0, 50'000'000);
    for (int i = 0; i < 3; ++i) {
      bench.run_ms(5'000);
      CHECK(bench.running() == 1);
      bench.power_on();
    }
  }
  CHECK(bench.running() == 0);
  bench.client.greet();
  CHECK(bench.updates.read_status()->spare_refusal == Problem::kNotConfirmed);
  for (int i = 0; i < 3; ++i) {
    bench.power_on();
    CHECK(bench.running() == 0);
  }
}

TEST_CASE("update: healthy is two seconds and a thousand ticks; without SYNC the two seconds") {
  Part part;
  UpdateBench bench(part);
  bench.sync = GENERATE(true, false);
  const auto image = new_image(part.key);
  bench.client.greet();
  bench.updates.send(image, {});
  bench.client.write_update(firmware::protocol::UpdateObject::kRestart, 0, 50'000'000);
  bench.run_ms(1500);
  bench.client.greet();
  using firmware::protocol::ServiceResult;
  const auto confirm = [&] {
    return bench.client.write_update(firmware::protocol::UpdateObject::kConfirm, kNew, 50'000'000);
  };
  CHECK(bench.updates.read_status()->on_trial);
  CHECK(confirm() == ServiceResult::kBusy);
  CHECK_FALSE(part.slot(1).confirmed());
  bench.run_ms(700);
  CHECK(bench.client.write_update(firmware::protocol::UpdateObject::kConfirm, kNew + 1,
                                  50'000'000) == ServiceResult::kOutOfRange);
  CHECK(confirm() == ServiceResult::kDone);
  CHECK(part.slot(1).confirmed());
  bench.run_ms(70'000);
  CHECK(bench.running() == 1);
}

TEST_CASE("update: frames lost, repeated, corrupted and replayed on the way, each seed") {
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    CAPTURE(seed);
    Part part;
    UpdateBench bench(part);
    std::mt19937 random(seed);
    std::deque<hal::CanFrame> former;
    int lost = 0, replayed = 0, corrupted = 0;
    bench.repeat_each = seed % 3 == 0;
    bench.meddle = [&](hal::CanFrame& frame) {
      const std::uint32_t dice = random() % 60;
      former.push_back(frame);
      if (former.size() > 20) former.pop_front();
      if (dice == 0) return ++lost, false;
      if (dice == 1) frame = former[random() % former.size()], ++replayed;
      if (dice == 2) frame.data[random() % 8] ^= std::uint8_t(1 << random() % 8), ++corrupted;
      return true;
    };
    const auto image = new_image(part.key);
    // A supervisor tries again where its patience ends.
    for (int tries = 0; tries < 5; ++tries) {
      try {
        update(bench, image);
        break;
      } catch (const ServiceError&) {
        bench.client.greet();
        if (running_version(bench) == kNew) bench.updates.confirm(kNew);
      }
    }
    bench.meddle = {};
    CHECK(lost + replayed + corrupted > 2);
    CHECK(running_version(bench) == kNew);
    CHECK(part.slot(1).confirmed());
    for (std::size_t i = 0; i < image.words.size(); ++i) {
      CHECK(part.flash.read(1, firmware::update::kHeaderWords + i) == image.words[i]);
    }
  }
}

TEST_CASE("update: a tool that was stopped goes on where it was") {
  Part part;
  UpdateBench bench(part);
  const auto image = new_image(part.key);
  struct Stopped {};
  bench.client.greet();
  CHECK_THROWS_AS(bench.updates.send(image,
                                     [](std::size_t done, std::size_t) {
                                       if (done == 45) throw Stopped{};
                                     }),
                  Stopped);
  const std::size_t erases = part.flash.erases();
  std::size_t first = 0;
  bench.updates.send(image, [&](std::size_t done, std::size_t) { first = first ? first : done; });
  CHECK(first == 46);
  CHECK(part.flash.erases() == erases);
  bench.updates.start_and_confirm(image);
  CHECK(running_version(bench) == kNew);
}

TEST_CASE("update: not while a fault is latched, not by another than the owner, not on trial") {
  Part part;
  UpdateBench bench(part);
  const auto image = new_image(part.key);
  bench.client.greet();
  SECTION("a fault") {
    bench.loop().emergency_stop();
    CHECK_THROWS_WITH(bench.updates.send(image, {}), Contains("mode off"));
  }
  SECTION("on trial") {
    bench.updates.send(image, {});
    bench.client.write_update(firmware::protocol::UpdateObject::kRestart, 0, 50'000'000);
    bench.run_ms(1000);
    bench.client.greet();
    CHECK_THROWS_WITH(bench.updates.send(new_image(part.key, kNew + 1, 0), {}),
                      Contains("on trial"));
  }
  CHECK(part.slot(0).header().version() == kOld);
  CHECK(part.slot(0).confirmed());
}
