#include "firmware/board/stm32f405/can_filters.h"

#include "firmware/app/received_ids.h"
#include "hal/bxcan/bxcan_bus.h"
#include "hal/bxcan/filters.h"

namespace hoof::firmware::stm32f405 {

bool set_can_filters(hal::bxcan::Registers& can1) {
  using hal::bxcan::BxCanBus;
  hal::bxcan::FilterSetup setup(can1);
  bool all = true;
  for (std::size_t bus = 0; bus < 2; ++bus) {
    app::for_each_received_id(bus, [&](std::uint32_t id) {
      const bool urgent = id == app::kEmergencyStopId;
      all = setup.accept(bus, id, urgent ? BxCanBus::kUrgentFifo : BxCanBus::kOrdinaryFifo) && all;
    });
  }
  return all;
}

}  // namespace hoof::firmware::stm32f405
