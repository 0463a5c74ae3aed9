#include "firmware/update/boot_choice.h"

#include <catch2/catch.hpp>
#include <optional>

#include "tests/firmware/update/signed_image.h"

using namespace hoof;
using namespace hoof::firmware::update;
using test::ImageSpec;
using test::make_image;
using test::SigningKey;
using test::write_image;
using Started = std::optional<std::size_t>;

namespace {

constexpr std::size_t kSlotWords = kHeaderWords + 64 + kMarkWords;

struct Part {
  hal::RamFlash flash{{kSlotWords, kSlotWords}};
  SigningKey key;

  ImageSlot slot(std::size_t number) { return {flash, number}; }
  void put(std::size_t slot, std::uint32_t version) {
    write_image(flash, slot, make_image({.version = version, .slot = slot}, key));
  }
  void put_confirmed(std::size_t slot, std::uint32_t version) {
    put(slot, version);
    this->slot(slot).confirm();
  }
  Started start() {
    return BootChoice(flash, key.open, kFootBoard, [] {}).choose();
  }
};

}  // namespace

TEST_CASE("boot: nothing there, nothing started; one image there, it counts as confirmed") {
  for (const std::size_t slot : {0u, 1u}) {
    Part part;
    CHECK(part.start() == std::nullopt);
    CHECK(part.flash.operations() == 0);
    part.put(slot, 1);
    CHECK(part.start() == Started(slot));
    CHECK(part.slot(slot).confirmed());
    CHECK(part.slot(slot).attempts() == 0);
  }
}

TEST_CASE("boot: the newest is tried three times, then the former one is back for good") {
  for (const std::size_t fresh : {0u, 1u}) {
    Part part;
    part.put_confirmed(1 - fresh, 7);
    CHECK(part.start() == Started(1 - fresh));
    part.put(fresh, 8);
    for (int i = 0; i < 3; ++i) CHECK(part.start() == Started(fresh));
    for (int i = 0; i < 3; ++i) CHECK(part.start() == Started(1 - fresh));
    CHECK(part.slot(fresh).refusal() == Problem::kNotConfirmed);
    CHECK_FALSE(part.slot(fresh).confirmed());
  }
}

TEST_CASE("boot: confirmed on its last attempt it stays; confirming a refused one does nothing") {
  Part part;
  part.put_confirmed(0, 7);
  part.put(1, 8);
  for (int i = 0; i < 3; ++i) part.start();
  part.slot(1).confirm();
  for (int i = 0; i < 5; ++i) CHECK(part.start() == Started(1));
  part.slot(1).refuse(Problem::kNotConfirmed);
  CHECK(part.start() == Started(0));
}

TEST_CASE(
    "boot: an older image is not started while the newer one is sound; a decayed one is left") {
  Part part;
  part.put_confirmed(0, 7);
  part.put_confirmed(1, 6);
  CHECK(part.start() == Started(0));
  REQUIRE(part.flash.program(0, kHeaderWords + 30, 0) == hal::FlashResult::kOk);
  CHECK(part.start() == Started(1));
  CHECK(part.slot(0).refusal() == Problem::kSignature);
}

TEST_CASE("boot: an image of another key, board, slot or length is not started") {
  const int what = GENERATE(0, 1, 2, 3, 4, 5);
  CAPTURE(what);
  Part part;
  part.put_confirmed(0, 1);
  ImageSpec spec{.version = 2, .slot = 1};
  if (what == 1) spec.board += 1;
  if (what == 2) spec.slot = 0;
  auto words = make_image(spec, what == 0 ? SigningKey(2) : part.key);
  if (what == 3) words[5] += 4;  // with a signature of its own, each of these
  if (what == 4) words[5] = 4 * (64 + 1);
  if (what == 5) words[5] -= 2;
  if (what >= 3) test::sign(words, part.key);
  write_image(part.flash, 1, words);
  CHECK(part.start() == Started(0));
  CHECK(part.slot(1).attempts() == 0);
}

TEST_CASE(
    "boot: one flipped bit of the new image, anywhere that is signed, and it is not started") {
  const SigningKey key;
  const auto good = make_image({.version = 2, .slot = 1}, key);
  for (std::size_t word = 1; word < good.size(); ++word) {
    if (word == ImageHeader::kWords) word = kHeaderWords;  // between them nothing is read
    Part part;
    part.put_confirmed(0, 1);
    auto bad = good;
    bad[word] ^= 1u << (word * 7 % 32);
    write_image(part.flash, 1, bad);
    CAPTURE(word);
    REQUIRE(part.start() == Started(0));
  }
}

// Each start writes at most a few marks; the power fails in each of them, in each way, again and
// again until a start gets through.
TEST_CASE("boot: cut at any write, something sound starts, and the trial still ends") {
  using hal::CutOutcome;
  const auto outcome =
      GENERATE(CutOutcome::kOld, CutOutcome::kNew, CutOutcome::kMixed, CutOutcome::kUnstable);
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(int(outcome), seed);
    std::mt19937 random(seed);
    Part part;
    part.flash = hal::RamFlash({kSlotWords, kSlotWords}, seed);
    part.put_confirmed(0, 7);
    part.put(1, 8);
    const bool confirms = random() % 2 == 0;
    bool confirmed = false;
    int trials = 0;
    for (int i = 0; i < 12; ++i) {
      Started started;
      try {
        part.flash.cut_after(random() % 3, outcome);
        started = part.start();
        if (confirms && started == Started(1) && random() % 4 == 0) {
          part.slot(1).confirm();
          confirmed = true;
        }
      } catch (const hal::PowerCut&) {
        continue;
      }
      part.flash.cancel_cut();
      REQUIRE(started);
      if (started == Started(1) && !part.slot(1).confirmed()) ++trials;
    }
    part.flash.cancel_cut();
    CHECK(trials <= 3);
    for (int i = 0; i < 5; ++i) part.start();
    if (confirmed && part.slot(1).refusal() == Problem::kNone) CHECK(part.start() == Started(1));
    if (!confirms) CHECK(part.start() == Started(0));
    const Started settled = part.start();
    for (int i = 0; i < 5; ++i) CHECK(part.start() == settled);
  }
}
