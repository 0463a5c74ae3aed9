#include "firmware/board/stm32f405/flash_memory.h"

#include <catch2/catch.hpp>

#include "firmware/app/parameter_store.h"
#include "tests/firmware/board/stm32f405/simulated_flash.h"

using namespace hoof;
using namespace hoof::firmware;
using hal::FlashResult;
using stm32f405::FlashMemory;
using tests::SimulatedFlash;
namespace flash = stm32f405::flash;

TEST_CASE("flash: three sectors of 16 KB, and nothing beyond") {
  SimulatedFlash sim;
  CHECK(sim.memory.sector_count() == 3);
  CHECK(sim.memory.sector_words(2) == 4096);
  CHECK(sim.memory.sector_words(3) == 0);
  CHECK(sim.memory.read(3, 0) == 0xFFFF'FFFF);
  CHECK(sim.memory.read(0, 4096) == 0xFFFF'FFFF);
  CHECK(sim.memory.program(3, 0, 0) == FlashResult::kOutOfRange);
  CHECK(sim.memory.program(0, 4096, 0) == FlashResult::kOutOfRange);
  CHECK(sim.memory.erase(3) == FlashResult::kOutOfRange);
  CHECK(sim.programs == 0);
  CHECK(sim.erased_sectors.empty());
}

TEST_CASE("flash: programs a word, clears bits only, and is locked before and after") {
  SimulatedFlash sim;
  CHECK(sim.memory.program(1, 5, 0x1234'5678) == FlashResult::kOk);
  CHECK(sim.memory.read(1, 5) == 0x1234'5678);
  CHECK(sim.words[4096 + 5].stored() == 0x1234'5678);
  CHECK((sim.registers.CR.stored() & flash::kLock) != 0);
  CHECK(sim.memory.program(1, 5, 0x1234'5679) == FlashResult::kNeedsErase);
  CHECK(sim.programs == 1);
  CHECK(sim.memory.program(1, 5, 0) == FlashResult::kOk);
  CHECK(sim.memory.read(1, 5) == 0);
}

TEST_CASE("flash: each error of the device is reported, and the next operation is not hindered") {
  const std::uint32_t error =
      GENERATE(flash::kOperationError, flash::kWriteProtected, flash::kAlignmentError,
               flash::kParallelismError, flash::kSequenceError);
  CAPTURE(error);
  SimulatedFlash sim;
  sim.next_error = error;
  CHECK(sim.memory.program(0, 0, 1) == FlashResult::kFailed);
  CHECK((sim.registers.CR.stored() & flash::kLock) != 0);
  CHECK(sim.memory.program(0, 1, 2) == FlashResult::kOk);
  sim.next_error = error;
  CHECK(sim.memory.erase(0) == FlashResult::kFailed);
  CHECK(sim.memory.erase(0) == FlashResult::kOk);
}

TEST_CASE("flash: a word that does not take the value is seen") {
  SimulatedFlash sim;
  sim.access.when_written(sim.words[7], [](hal::Register&, std::uint32_t) {});
  CHECK(sim.memory.program(0, 7, 0) == FlashResult::kFailed);
}

TEST_CASE("flash: erases the sector meant, with the watchdog's long time and back") {
  for (std::size_t sector = 0; sector < 3; ++sector) {
    CAPTURE(sector);
    SimulatedFlash sim;
    for (std::size_t s = 0; s < 3; ++s) REQUIRE(sim.memory.program(s, 9, 0) == FlashResult::kOk);
    CHECK(sim.memory.erase(sector) == FlashResult::kOk);
    CHECK(sim.erased_sectors == std::vector<int>{static_cast<int>(sector) + 1});
    for (std::size_t s = 0; s < 3; ++s) {
      CHECK(sim.memory.read(s, 9) == (s == sector ? 0xFFFF'FFFF : 0));
    }
    CHECK(sim.watchdog_log == std::vector<std::string>{"reload 734", "feed", "reload 234", "feed"});
    CHECK((sim.registers.CR.stored() & flash::kLock) != 0);
    // The data cache is on again, and was reset while it was off.
    CHECK((sim.registers.ACR.stored() & flash::kDataCache) != 0);
    CHECK((sim.registers.ACR.stored() & flash::kDataCacheReset) == 0);
  }
}

TEST_CASE("flash: an erase at the start leaves the watchdog's long time as it is") {
  SimulatedFlash sim;
  sim.watchdog.set(stm32f405::Watchdog::Time::kStart);
  sim.watchdog_log.clear();
  REQUIRE(sim.memory.erase(2) == FlashResult::kOk);
  CHECK(sim.watchdog_log == std::vector<std::string>{"reload 734", "feed", "reload 734", "feed"});
}

TEST_CASE("flash: the data cache is forgotten after an erase, while it is off") {
  SimulatedFlash sim;
  bool forgotten = false;
  sim.access.when_written(sim.registers.ACR, [&](hal::Register& r, std::uint32_t value) {
    if ((value & flash::kDataCacheReset) != 0) forgotten = (value & flash::kDataCache) == 0;
    r.store(value);
  });
  REQUIRE(sim.memory.erase(0) == FlashResult::kOk);
  CHECK(forgotten);
}

TEST_CASE("flash: time goes on during an erase") {
  SimulatedFlash sim;
  sim.systick.CVR.store(0);
  const std::int64_t before = sim.clock.now_ns();
  sim.erase_ms = 500;
  REQUIRE(sim.memory.erase(0) == FlashResult::kOk);
  const double passed_ms = static_cast<double>(sim.clock.now_ns() - before) / 1e6;
  CHECK(passed_ms == Approx(500).margin(1.1));  // a tick at either end
}

TEST_CASE("flash: an image's sector may take two seconds, in which the watchdog is fed") {
  SimulatedFlash sim;
  FlashMemory images(sim.registers, sim.words.data(), sim.watchdog, sim.clock,
                     FlashMemory::kImages);
  CHECK(images.sector_count() == 2);
  CHECK(images.sector_words(1) == 32'768);
  CHECK(images.sector_words(2) == 0);
  sim.erase_ms = 2000;
  CHECK(images.erase(1) == FlashResult::kOk);
  CHECK(sim.erased_sectors == std::vector<int>{6});
  // At least every 512 ms of the long time, which is 1 s at the fastest.
  CHECK(sim.watchdog_log == std::vector<std::string>{"reload 734", "feed", "feed", "feed", "feed",
                                                     "reload 234", "feed"});
  sim.never_done = true;
  CHECK(images.erase(0) == FlashResult::kFailed);
}

TEST_CASE("flash: an erase that never ends is given up, by the clock or by counting") {
  SimulatedFlash sim;
  sim.never_done = true;
  SECTION("by the clock") {
    CHECK(sim.memory.erase(0) == FlashResult::kFailed);
    CHECK(sim.access.accesses < 100'000);
  }
  SECTION("by counting, where no tick comes") {
    sim.tick_runs = false;
    CHECK(sim.memory.erase(0) == FlashResult::kFailed);
  }
  CHECK(sim.memory.program(0, 0, 0) == FlashResult::kFailed);
}

TEST_CASE("flash: a controller that cannot be unlocked fails and is not written to") {
  SimulatedFlash sim;
  sim.access.when_written(sim.registers.KEYR, [](hal::Register&, std::uint32_t) {});
  CHECK(sim.memory.program(0, 0, 0) == FlashResult::kFailed);
  CHECK(sim.memory.erase(0) == FlashResult::kFailed);
  CHECK(sim.programs == 0);
  CHECK(sim.erased_sectors.empty());
}

TEST_CASE(
    "flash: one that stands unlocked, as a debugger may leave it, is not locked up by the keys") {
  SimulatedFlash sim;
  sim.registers.CR.store(0);
  CHECK(sim.memory.program(0, 0, 1) == FlashResult::kOk);
  CHECK(sim.memory.program(0, 1, 2) == FlashResult::kOk);
}

TEST_CASE("flash: parameters are stored and come back") {
  SimulatedFlash sim;
  app::ParameterStore store(sim.memory, {0, 1});
  app::Parameters parameters;
  REQUIRE(app::set(parameters, "toe_kp_Nm_rad", 200.0f) == app::SetResult::kOk);
  for (int i = 0; i < 3; ++i) {
    REQUIRE(store.store(parameters, control::Mode::kOff) == app::StoreResult::kOk);
  }
  app::Parameters back;
  const app::LoadReport report = app::ParameterStore(sim.memory, {0, 1}).load(back);
  CHECK(report.complete());
  CHECK(report.sequence == 3);
  CHECK(back.control.toe.kp_Nm_rad == 200.0f);
}
