// What the two CAN controllers let through, from the dictionary.
#pragma once

#include "hal/bxcan/registers.h"

namespace hoof::firmware::stm32f405 {

/// Every identifier addressed to the foot on its bus, CAN1 being bus 0; the e-stop's alone goes
/// into FIFO 0, where no flood of others can overrun it.
/// @return false when the dictionary has more identifiers than there are filters
bool set_can_filters(hal::bxcan::Registers& can1);

}  // namespace hoof::firmware::stm32f405
