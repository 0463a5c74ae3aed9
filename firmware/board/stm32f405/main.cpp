// The firmware on the board.
#include "firmware/app/control_loop.h"
#include "firmware/app/storage.h"
#include "firmware/board/stm32f405/lock_step_board.h"
#include "firmware/board/stm32f405/system.h"

using namespace hoof;
using namespace hoof::firmware;
using stm32f405::LockStepBoard;

namespace {

// Not part of main(), whose frame stays on the stack.
#define HOOF_AT_START [[gnu::noinline]]

/// @param told what the loop stands on in an emulator, null on the part
HOOF_AT_START app::ControlLoop& make_loop(stm32f405::System& system, LockStepBoard* told) {
  static app::Parameters parameters;
  static app::Storage storage(system.flash);
  storage.load(parameters);
  const bool on_part = told == nullptr;
  const app::ControlLoop::Buses buses =
      on_part ? app::ControlLoop::Buses{&system.bus0, &system.bus1} : told->buses();
  const hal::Clock& clock = on_part ? system.clock : told->clock();
  hal::Board& board = on_part ? static_cast<hal::Board&>(system.board) : *told;
  static app::ControlLoop loop(buses, clock, board, parameters, &storage,
                               on_part ? &system.slots : nullptr);
  return loop;
}

/// Null on the part.
HOOF_AT_START LockStepBoard* board_of_emulator(stm32f405::System& system) {
  static LockStepBoard told(system.line0, system.serial0, system.line1, system.serial1);
  return system.only_core_and_lines() ? &told : nullptr;
}

[[noreturn]] void run_in_emulator(stm32f405::System& system, LockStepBoard& board,
                                  app::ControlLoop& loop) {
  for (;;) {
    const LockStepBoard::Word word = board.next_word();
    if (word == LockStepBoard::Word::kGo) loop.poll();
    if (word == LockStepBoard::Word::kNone) {
      system.rest_by_lines();
    } else {
      board.answer(loop.next_due_ns());
    }
  }
}

}  // namespace

/// For the image's header: which dictionary it speaks.
extern "C" [[gnu::section(".protocol_hash"), gnu::used]] const std::uint32_t hoof_protocol_hash =
    app::kSpokenDictionary;

int main() {
  stm32f405::System& system = stm32f405::system();
  system.start();
  LockStepBoard* const told = board_of_emulator(system);
  app::ControlLoop& loop = make_loop(system, told);
  if (told != nullptr) run_in_emulator(system, *told, loop);
  system.watchdog.set(stm32f405::Watchdog::Time::kTick);
  for (;;) {
    loop.poll();  // feeds the watchdog once it has finished
    system.rest(loop.waits_for_room());
  }
}
