// The board's own image brings its successor over CAN, and the boot loader chooses: with the supply
// failing, with images that hang, crash or are never confirmed.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>

#include "hil_bridge/update_client.h"
#include "tests/firmware/update/signed_image.h"
#include "tests/tools/emulator/powered_board.h"

using namespace hoof;
using namespace hoof::tools::emulator;
using bridge::UpdateImage;
using firmware::update::ImageSlot;
using firmware::update::Problem;
using test::PoweredBoard;
using test::Word;

namespace {

constexpr std::size_t kSlotB = 4;  // of the emulator's flash
constexpr std::uint32_t kUnexpectedReset = 1u << 19;

/// The key that this build folder's image is signed with.
const test::SigningKey& build_key() {
  static const test::SigningKey key = [] {
    test::SigningKey made;
    std::ifstream in(HOOF_BOARD_KEY);
    std::string text;
    in >> text;
    std::array<std::uint8_t, crypto_sign_SEEDBYTES> seed{};
    REQUIRE(sodium_hex2bin(seed.data(), seed.size(), text.data(), text.size(), nullptr, nullptr,
                           nullptr) == 0);
    crypto_sign_seed_keypair(made.open.data(), made.secret.data(), seed.data());
    return made;
  }();
  return key;
}

/// The image for slot B of this build, as a higher version; `change` may spoil it before it is
/// signed. Header and image as words of the slot.
std::vector<Word> image_b(std::uint32_t version,
                          const std::function<void(std::vector<Word>&)>& change = {}) {
  static const bridge::UpdateFile file = bridge::read_update_file(HOOF_BOARD_UPDATE);
  const UpdateImage* image = file.for_slot(1);
  REQUIRE(image != nullptr);
  std::vector<Word> words(firmware::update::kHeaderWords, hal::Nonvolatile::kErased);
  std::copy(image->header.word.begin(), image->header.word.end(), words.begin());
  words.insert(words.end(), image->words.begin(), image->words.end());
  words[6] = version;
  if (change) change(words);
  test::sign(words, build_key());
  return words;
}

UpdateImage as_update(const std::vector<Word>& words) {
  UpdateImage image;
  std::copy_n(words.begin(), image.header.word.size(), image.header.word.begin());
  image.words.assign(words.begin() + firmware::update::kHeaderWords, words.end());
  return image;
}

/// Replaces the first instructions of the image's start by one.
void start_with(std::vector<Word>& words, std::uint16_t instruction) {
  const Word entry = words[firmware::update::kHeaderWords + 1] & ~1u;
  const Word slot = FlashController::kSlotsStart + FlashController::kSlotBytes;
  Word& word = words[(entry - slot) / 4];
  word = instruction | Word(instruction) << 16;
}

/// A flash in which the board has run once from slot A, and where slot B holds this.
hal::RamFlash flash_with_b(const std::vector<Word>& words) {
  hal::RamFlash flash = blank_flash();
  { PoweredBoard once(flash); }
  test::write_image(flash, kSlotB, words);
  return flash;
}

/// Where the core sleeps.
std::size_t running(PoweredBoard& foot) {
  const std::uint32_t pc = foot.board().cpu().registers().pc;
  return pc >= FlashController::kSlotsStart + FlashController::kSlotBytes ? 1 : 0;
}

std::uint32_t version(PoweredBoard& foot) {
  foot.client().greet();
  return foot.client().status(firmware::protocol::Status::kImageVersion);
}

/// Runs until the slot runs, or the time is over.
bool reaches(PoweredBoard& foot, std::size_t slot, int ms) {
  for (int i = 0; i < ms && running(foot) != slot; i += 10) foot.run_ms(10);
  return running(foot) == slot;
}

}  // namespace

TEST_CASE("update on the board: over CAN into slot B, confirmed, and there to stay") {
  hal::RamFlash flash = blank_flash();
  const UpdateImage image = as_update(image_b(2));
  {
    PoweredBoard foot(flash);
    CHECK(version(foot) == 1);
    CHECK(running(foot) == 0);
    bridge::UpdateClient updates(foot.client(), {.word_period_ns = 0});
    CHECK(&updates.choose({{image}}, *updates.read_status()) != nullptr);
    updates.send(image, {});
    CHECK(running(foot) == 0);
    CHECK(flash.erases() == 2);  // the log's sector at the first start, and slot B
    updates.start_and_confirm(image);
    CHECK(running(foot) == 1);
    CHECK(foot.board().resets() == 1);
    CHECK(version(foot) == 2);
    CHECK_FALSE(updates.read_status()->on_trial);
    REQUIRE(foot.heartbeat());
    CHECK(foot.heartbeat()->mode == firmware::protocol::Mode::kOff);
    CHECK(foot.heartbeat()->faults == 0);  // a restart on request is no crash
  }
  PoweredBoard again(flash);
  CHECK(running(again) == 1);
  CHECK(version(again) == 2);
}

TEST_CASE("update on the board: the supply fails while it is brought; the former image starts") {
  const auto outcome = GENERATE(hal::CutOutcome::kMixed, hal::CutOutcome::kUnstable);
  const UpdateImage image = as_update(image_b(2));
  const bool full = std::getenv("HOOF_FULL_TESTS") != nullptr;
  const std::size_t all = image.words.size();
  std::vector<std::size_t> cuts = {0, 1, 2, 700};  // magic, erase, first words
  if (full) {
    for (std::size_t n = 1000; n < all; n += 997) cuts.push_back(n);
    for (std::size_t n = all - 40; n < all + 40; ++n) cuts.push_back(n);
  }
  for (const std::size_t n : cuts) {
    CAPTURE(int(outcome), n);
    hal::RamFlash flash = blank_flash();
    bool through = false;
    {
      PoweredBoard foot(flash);
      foot.client().connect();
      bridge::UpdateClient updates(foot.client(), {.word_period_ns = 0});
      flash.cut_after(n, outcome);
      try {
        updates.send(image, {});
        updates.start_and_confirm(image);
        through = true;
      } catch (const bridge::ServiceError&) {
      }
      flash.cancel_cut();
      if (!through) CHECK_FALSE(foot.board().powered());
    }
    PoweredBoard foot(flash);
    const std::uint32_t now = version(foot);
    CHECK((now == 1 || (now == 2 && n + 40 > all)));
    foot.run_ms(300);
    REQUIRE(foot.heartbeat());
    CHECK(foot.heartbeat()->faults == 0);
  }
}

TEST_CASE("update on the board: the supply fails in the boot loader; something sound starts") {
  const auto outcome = GENERATE(hal::CutOutcome::kOld, hal::CutOutcome::kNew,
                                hal::CutOutcome::kMixed, hal::CutOutcome::kUnstable);
  static const hal::RamFlash before = flash_with_b(image_b(2));
  hal::RamFlash flash = before;
  std::size_t starts_of_b = 0;
  for (int i = 0; i < 6; ++i) {
    CAPTURE(int(outcome), i);
    if (i % 2 == 0) flash.cut_after(0, outcome);
    PoweredBoard foot(flash);
    flash.cancel_cut();
    if (!foot.board().powered()) continue;  // cut while it noted an attempt
    foot.run_ms(150);
    REQUIRE(foot.heartbeat());
    starts_of_b += running(foot);
  }
  CHECK(starts_of_b >= 1);
  CHECK(starts_of_b <= 3);
  for (int i = 0; i < 3; ++i) PoweredBoard uses_up_attempts(flash);
  PoweredBoard foot(flash);
  CHECK(running(foot) == 0);
  CHECK(ImageSlot(flash, kSlotB).refusal() == Problem::kNotConfirmed);
}

TEST_CASE("update on the board: an image that hangs or crashes at once is tried three times") {
  const bool hangs = GENERATE(true, false);
  CAPTURE(hangs);
  hal::RamFlash flash = blank_flash();
  PoweredBoard foot(flash);
  foot.run_ms(20);
  // b .   or   an undefined instruction
  test::write_image(flash, kSlotB, image_b(2, [&](std::vector<Word>& words) {
                      start_with(words, hangs ? 0xE7FE : 0xDE00);
                    }));
  foot.board().reset(hal::ResetCause::kPin);
  foot.run_ms(200);
  CHECK(reaches(foot, 0, 10'000));
  CHECK(foot.board().resets() == 1 + 3);
  CHECK(ImageSlot(flash, kSlotB).refusal() == Problem::kNotConfirmed);
  foot.run_ms(300);
  REQUIRE(foot.heartbeat());
  CHECK((foot.heartbeat()->faults & kUnexpectedReset) != 0);  // somebody should look
}

TEST_CASE("update on the board: an image that nobody confirms gives way after a minute") {
  hal::RamFlash flash = flash_with_b(image_b(2));
  PoweredBoard foot(flash);
  foot.run_ms(59'000);
  CHECK(running(foot) == 1);
  foot.run_ms(2'000);
  CHECK(running(foot) == 0);
  CHECK(foot.board().resets() == 1);
  CHECK(ImageSlot(flash, kSlotB).refusal() == Problem::kNotConfirmed);
}

TEST_CASE(
    "update on the board: a bit of the new image that is not as signed, and the old one starts") {
  std::mt19937 random(11);
  const auto good = image_b(2);
  for (int i = 0; i < 6; ++i) {
    auto words = good;
    std::size_t at = 1 + random() % (words.size() - 1);
    if (at >= 32 && at < firmware::update::kHeaderWords) at = 7;  // not read there
    words[at] ^= 1u << random() % 32;
    CAPTURE(i, at);
    hal::RamFlash flash = flash_with_b(words);
    PoweredBoard foot(flash);
    CHECK(running(foot) == 0);
    CHECK(ImageSlot(flash, kSlotB).attempts() == 0);
  }
}
