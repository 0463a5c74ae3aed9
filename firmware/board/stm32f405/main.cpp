// The firmware on the board.
#include "firmware/app/control_loop.h"
#include "firmware/app/storage.h"
#include "firmware/board/stm32f405/system.h"

using namespace hoof::firmware;

/// For the image's header: which dictionary it speaks.
extern "C" [[gnu::section(".protocol_hash"), gnu::used]] const std::uint32_t hoof_protocol_hash =
    app::kSpokenDictionary;

int main() {
  stm32f405::System& system = stm32f405::system();
  system.start();
  static app::Parameters parameters;
  static app::Storage storage(system.flash);
  storage.load(parameters);
  static app::ControlLoop loop({&system.bus0, &system.bus1}, system.clock, system.board, parameters,
                               &storage, &system.slots);
  system.watchdog.set(stm32f405::Watchdog::Time::kTick);
  for (;;) {
    loop.poll();  // feeds the watchdog once it has finished
    system.rest();
  }
}
