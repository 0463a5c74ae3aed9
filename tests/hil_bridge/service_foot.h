// A whole foot with storage on a simulated bus, that lives while a tool waits for it.
#pragma once

#include "firmware/app/control_loop.h"
#include "firmware/protocol/codec.h"
#include "hal/in_process/in_process_bus.h"
#include "hal/in_process/ram_flash.h"
#include "hal/in_process/soft_board.h"
#include "hal/stepped_clock.h"
#include "hil_bridge/service_client.h"

namespace hoof::tests {

struct ServiceFoot {
  static constexpr std::int64_t kTimeout_ns = 2'000'000'000;

  bool keeps_storage;
  hal::InProcessBus bus0{{.name = "can0", .bit_rates = {}}};
  hal::InProcessBus bus1{{.name = "can1", .bit_rates = {}}};
  hal::SteppedClock clock;
  hal::SoftBoard board;
  hal::RamFlash flash{{4096, 4096, 4096}};
  firmware::app::Storage storage{flash};
  firmware::app::Parameters parameters;
  hal::CanBus& desk = bus0.attach("desk");
  hal::CanBus& master = bus0.attach("sync");
  hal::CanBus& foot0 = bus0.attach("foot");
  hal::CanBus& foot1 = bus1.attach("foot");
  firmware::app::ControlLoop foot{
      {&foot0, &foot1}, clock, board, loaded(), keeps_storage ? &storage : nullptr};
  bridge::ServiceClient client{desk, clock, [this] { millisecond(); }, 2, kTimeout_ns};
  bool foot_runs = true;
  std::uint32_t tick = 0;

  explicit ServiceFoot(bool with_storage = true) : keeps_storage(with_storage) {}

  const firmware::app::Parameters& loaded() {
    storage.load(parameters);
    return parameters;
  }

  void millisecond() {
    master.send(encode(firmware::protocol::Sync{tick++}));
    const std::int64_t end_ns = clock.now_ns() + 1'000'000;
    while (clock.now_ns() < end_ns) {
      clock.advance_to(clock.now_ns() + 100'000);
      bus0.advance_to(clock.now_ns());
      bus1.advance_to(clock.now_ns());
      if (foot_runs) foot.poll();
    }
  }
};

}  // namespace hoof::tests
