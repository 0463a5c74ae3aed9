// The supply fails while the board's image writes its flash: the next start must find the set of
// before or the set of after, and a board that can store again. It must never be bricked.
#include <catch2/catch.hpp>
#include <cstdlib>

#include "firmware/app/parameters.h"
#include "tests/tools/emulator/powered_board.h"

using namespace hoof;
using namespace hoof::tools::emulator;
using test::PoweredBoard;
namespace protocol = firmware::protocol;

namespace {

std::uint8_t index_of(std::string_view name) {
  const auto* entry = firmware::app::find_parameter(name);
  REQUIRE(entry != nullptr);
  return std::uint8_t(entry - firmware::app::parameter_table().data());
}

constexpr float kOld = 240.0f, kNew = 260.0f, kLater = 250.0f;

void store(hal::RamFlash& flash, float value) {
  PoweredBoard foot(flash);
  foot.client().connect();
  foot.client().write_parameter(index_of("toe_kp_Nm_rad"), value);
  foot.client().store_parameters();
}

float stored(hal::RamFlash& flash) {
  PoweredBoard foot(flash);
  foot.client().connect();
  return foot.client().read_parameter(index_of("toe_kp_Nm_rad"));
}

/// @return false where the store was over before the cut
bool cut_a_store(hal::RamFlash& flash, std::size_t operations, hal::CutOutcome outcome) {
  PoweredBoard foot(flash);
  foot.client().connect();
  foot.client().write_parameter(index_of("toe_kp_Nm_rad"), kNew);
  flash.cut_after(operations, outcome);
  bool answered = true;
  try {
    foot.client().store_parameters();
  } catch (const bridge::ServiceError&) {
    answered = false;
  }
  flash.cancel_cut();
  CHECK(foot.board().powered() == answered);
  return !answered;
}

bool full() {
  return std::getenv("HOOF_FULL_TESTS") != nullptr;
}

}  // namespace

TEST_CASE("power cut: at every write and erase of a store the board keeps the old set or the new") {
  const auto outcome = GENERATE(hal::CutOutcome::kOld, hal::CutOutcome::kNew,
                                hal::CutOutcome::kMixed, hal::CutOutcome::kUnstable);
  hal::RamFlash before = blank_flash();
  store(before, kLater);  // both copies of parameters are in use
  store(before, kOld);
  const std::size_t step = full() ? 1 : 9;
  int cuts = 0, old_sets = 0, new_sets = 0;
  std::size_t erases = 0;
  for (std::size_t n = 0;; n += step) {
    CAPTURE(int(outcome), n);
    hal::RamFlash flash = before;
    const std::size_t erased = flash.erases();
    if (!cut_a_store(flash, n, outcome)) break;
    ++cuts;
    if (n == 0) erases = flash.erases() - erased;  // it begins with one
    const float value = stored(flash);
    CHECK((value == kOld || value == kNew));
    (value == kOld ? old_sets : new_sets) += 1;
    store(flash, kLater);
    CHECK(stored(flash) == kLater);
  }
  CAPTURE(cuts, old_sets, new_sets);
  CHECK(cuts > (full() ? 60 : 6));
  CHECK(old_sets > 0);
  CHECK(erases == 1);
}

TEST_CASE("power cut: while a fault is written to its log the next start is in order") {
  const auto outcome = GENERATE(hal::CutOutcome::kNew, hal::CutOutcome::kMixed);
  hal::RamFlash before = blank_flash();
  store(before, kOld);
  const std::size_t step = full() ? 1 : 37;
  int cuts = 0;
  for (std::size_t n = 0;; n += step) {
    CAPTURE(int(outcome), n);
    hal::RamFlash flash = before;
    {
      PoweredBoard foot(flash);
      foot.run_ms(20);
      flash.cut_after(n, outcome);
      foot.board().press_emergency_stop(true);
      foot.run_ms(400);  // two words a millisecond
      flash.cancel_cut();
      if (foot.board().powered()) break;
    }
    ++cuts;
    PoweredBoard again(flash);
    again.run_ms(300);
    REQUIRE(again.heartbeat());
    CHECK(again.heartbeat()->mode == protocol::Mode::kOff);
    CHECK(again.heartbeat()->faults == 0);
    CHECK(again.board().resets() == 0);
    again.client().connect();
    CHECK(again.client().read_parameter(index_of("toe_kp_Nm_rad")) == kOld);
  }
  CHECK(cuts > (full() ? 200 : 5));
}

namespace {

/// Starts, is in mode off without a fault, and stores.
void require_whole(hal::RamFlash& flash) {
  {
    PoweredBoard again(flash);
    again.run_ms(300);
    REQUIRE(again.heartbeat());
    CHECK(again.heartbeat()->mode == protocol::Mode::kOff);
    CHECK(again.heartbeat()->faults == 0);
    CHECK(again.board().resets() == 0);
  }
  store(flash, kLater);
  CHECK(stored(flash) == kLater);
}

}  // namespace

TEST_CASE("power cut: at every write and erase of a part's first start, and of emptying its log") {
  const bool first_start = GENERATE(true, false);
  const auto outcome = GENERATE(hal::CutOutcome::kOld, hal::CutOutcome::kNew,
                                hal::CutOutcome::kMixed, hal::CutOutcome::kUnstable);
  hal::RamFlash before = blank_flash();
  if (first_start) {
    const Board flashed(PoweredBoard::image(), before);  // whoever flashes it writes the images' slots
  } else {
    store(before, kOld);
    PoweredBoard foot(before);
    foot.run_ms(20);
    foot.board().press_emergency_stop(true);
    foot.run_ms(400);  // a record in the log
  }
  int cuts = 0;
  std::size_t erases = 0;
  for (std::size_t n = 0;; ++n) {
    CAPTURE(first_start, int(outcome), n);
    hal::RamFlash flash = before;
    const std::size_t erased = flash.erases();
    {
      if (first_start) flash.cut_after(n, outcome);
      PoweredBoard foot(flash);
      if (!first_start) {
        foot.client().connect();
        flash.cut_after(n, outcome);
        try {
          foot.client().erase_fault_log();
        } catch (const bridge::ServiceError&) {
        }
      }
      flash.cancel_cut();
      if (foot.board().powered()) break;
    }
    ++cuts;
    erases += flash.erases() - erased;
    require_whole(flash);
  }
  CHECK(cuts >= 2);
  CHECK(erases >= 1);
}
