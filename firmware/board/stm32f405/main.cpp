// The firmware on the board.
#include "firmware/app/control_loop.h"
#include "firmware/app/parameter_store.h"
#include "firmware/board/stm32f405/system.h"

using namespace hoof::firmware;

int main() {
  stm32f405::System& system = stm32f405::system();
  system.start();
  static app::Parameters parameters;
  app::ParameterStore(system.flash, {0, 1}).load(parameters);
  static app::ControlLoop loop({&system.bus0, &system.bus1}, system.clock, parameters);
  system.watchdog.set(stm32f405::Watchdog::Time::kTick);
  for (;;) {
    if (system.board.emergency_stop_pressed() && loop.mode() != control::Mode::kEmergencyOff) {
      loop.emergency_stop();
    }
    loop.poll();
    system.board.feed_watchdog();
    system.rest();
  }
}
