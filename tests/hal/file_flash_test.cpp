#include "hal/file_flash/file_flash.h"

#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>

using hoof::hal::FileFlash;
using hoof::hal::FlashResult;
using hoof::hal::Nonvolatile;

namespace {

struct TemporaryFile {
  std::string path =
      (std::filesystem::temp_directory_path() / ("hoof-flash-test-" + std::to_string(std::rand())))
          .string();
  ~TemporaryFile() { std::remove(path.c_str()); }
};

}  // namespace

TEST_CASE("A file of flash begins erased and keeps what was programmed") {
  TemporaryFile file;
  {
    FileFlash flash(file.path, 3, 16);
    CHECK(flash.sector_count() == 3);
    CHECK(flash.sector_words(2) == 16);
    CHECK(flash.sector_words(3) == 0);
    CHECK(flash.read(1, 5) == Nonvolatile::kErased);
    CHECK(flash.program(1, 5, 0x1234'5678) == FlashResult::kOk);
    CHECK(flash.program(2, 0, 7) == FlashResult::kOk);
  }
  CHECK(std::filesystem::file_size(file.path) == 3 * 16 * 4);
  {
    FileFlash flash(file.path, 3, 16);
    CHECK(flash.read(1, 5) == 0x1234'5678);
    CHECK(flash.read(2, 0) == 7);
    CHECK(flash.erase(2) == FlashResult::kOk);
    CHECK(flash.read(2, 0) == Nonvolatile::kErased);
  }
  FileFlash flash(file.path, 3, 16);
  CHECK(flash.read(2, 0) == Nonvolatile::kErased);
  CHECK(flash.read(1, 5) == 0x1234'5678);
}

TEST_CASE("A file of flash refuses what flash cannot do") {
  TemporaryFile file;
  FileFlash flash(file.path, 2, 8);
  REQUIRE(flash.program(0, 0, 0xFFFF'0000) == FlashResult::kOk);
  CHECK(flash.program(0, 0, 0x0001'0000) == FlashResult::kOk);
  CHECK(flash.program(0, 0, 0x0001'0001) == FlashResult::kNeedsErase);
  CHECK(flash.read(0, 0) == 0x0001'0000);
  CHECK(flash.program(2, 0, 0) == FlashResult::kOutOfRange);
  CHECK(flash.program(0, 8, 0) == FlashResult::kOutOfRange);
  CHECK(flash.erase(2) == FlashResult::kOutOfRange);
  CHECK(flash.read(0, 8) == Nonvolatile::kErased);
}

TEST_CASE("A file that is no flash of this size, or cannot be made, is an error with its name") {
  TemporaryFile file;
  std::ofstream(file.path) << "something else";
  CHECK_THROWS_WITH(FileFlash(file.path, 2, 8),
                    Catch::Contains(file.path) && Catch::Contains("64 bytes"));
  CHECK(std::filesystem::file_size(file.path) == 14);  // left as it was
  CHECK_THROWS_WITH(FileFlash("/nowhere/at/all", 2, 8), Catch::Contains("/nowhere/at/all"));
}
