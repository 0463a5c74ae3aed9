// The emulated board's flash in a file.
#include "tools/emulator/kept_flash.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <random>

#include "tools/emulator/board.h"

using namespace hoof;
using tools::emulator::KeptFlash;

namespace {

struct TemporaryFile {
  std::string path = (std::filesystem::temp_directory_path() /
                      ("kept_flash_test." + std::to_string(std::random_device{}())))
                         .string();
  ~TemporaryFile() { std::filesystem::remove(path); }
};

}  // namespace

TEST_CASE("kept flash: sectors as the board's, each by itself, in the file at once") {
  const TemporaryFile file;
  KeptFlash flash(file.path);
  const hal::RamFlash like = tools::emulator::blank_flash();
  REQUIRE(flash.sector_count() == like.sector_count());
  for (std::size_t s = 0; s < flash.sector_count(); ++s) {
    REQUIRE(flash.sector_words(s) == like.sector_words(s));
    const std::size_t last = flash.sector_words(s) - 1;
    CHECK(flash.program(s, 0, std::uint32_t(s)) == hal::FlashResult::kOk);
    CHECK(flash.program(s, last, std::uint32_t(100 + s)) == hal::FlashResult::kOk);
    CHECK(flash.program(s, last + 1, 0) == hal::FlashResult::kOutOfRange);
    CHECK(flash.program(s, 0, ~0u) == hal::FlashResult::kNeedsErase);
    CHECK(flash.read(s, last + 1) == hal::Nonvolatile::kErased);
  }
  CHECK(flash.sector_words(5) == 0);
  CHECK(flash.erase(5) == hal::FlashResult::kOutOfRange);
  CHECK(flash.erase(3) == hal::FlashResult::kOk);
  // As a program finds it that starts after this one was killed.
  const KeptFlash again(file.path);
  for (std::size_t s = 0; s < again.sector_count(); ++s) {
    CAPTURE(s);
    const std::size_t last = again.sector_words(s) - 1;
    CHECK(again.read(s, 0) == (s == 3 ? ~0u : std::uint32_t(s)));
    CHECK(again.read(s, last) == (s == 3 ? ~0u : std::uint32_t(100 + s)));
  }
}

TEST_CASE("kept flash: a file of another size is refused by its name") {
  const TemporaryFile file;
  std::ofstream(file.path) << "no flash";
  CHECK_THROWS_WITH(KeptFlash(file.path), Catch::Contains(file.path));
}
