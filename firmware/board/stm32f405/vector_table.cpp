// What the core fetches on reset, exceptions and interrupts (ARM DDI 0403E, B1.5.3).
#include <array>

#include "firmware/board/stm32f405/crash.h"
#include "firmware/board/stm32f405/interrupts.h"
#include "firmware/board/stm32f405/memory.h"

namespace hoof::firmware::stm32f405 {

extern "C" void hoof_reset();

namespace {

using Handler = void (*)();

struct VectorTable {
  const void* stack;
  std::array<Handler, 15> exceptions;
  std::array<Handler, kInterruptCount> interrupts;
};
static_assert(sizeof(VectorTable) == 4 * (16 + kInterruptCount));

constexpr VectorTable make_vector_table() {
  VectorTable table{&hoof_stack_top, {}, {}};
  table.exceptions.fill(hoof_fault);
  table.interrupts.fill(hoof_fault);
  table.exceptions[0] = hoof_reset;
  table.exceptions[14] = hoof_tick;
  const auto serve = [&table](Interrupt interrupt, Handler handler) {
    table.interrupts[static_cast<std::size_t>(interrupt)] = handler;
  };
  serve(Interrupt::kCan1Transmit, hoof_can1_transmit);
  serve(Interrupt::kCan1Receive0, hoof_can1_receive0);
  serve(Interrupt::kCan1Receive1, hoof_can1_receive1);
  serve(Interrupt::kCan1Status, hoof_can1_status);
  serve(Interrupt::kTimer1Break, hoof_timer1_break);
  serve(Interrupt::kCan2Transmit, hoof_can2_transmit);
  serve(Interrupt::kCan2Receive0, hoof_can2_receive0);
  serve(Interrupt::kCan2Receive1, hoof_can2_receive1);
  serve(Interrupt::kCan2Status, hoof_can2_status);
  serve(Interrupt::kUsart1, hoof_usart1);
  serve(Interrupt::kUsart2, hoof_usart2);
  return table;
}

[[gnu::section(".vectors"), gnu::used]] constexpr VectorTable kVectorTable = make_vector_table();

}  // namespace
}  // namespace hoof::firmware::stm32f405
