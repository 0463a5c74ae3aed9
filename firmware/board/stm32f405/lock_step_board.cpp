#include "firmware/board/stm32f405/lock_step_board.h"

#include "hal/interrupt_lock.h"

namespace hoof::firmware::stm32f405 {

namespace lock_step = hal::lock_step;

bool only_core_and_lines(const RccRegisters& rcc, const GpioRegisters& port_a,
                         const GpioRegisters& port_b, const hal::bxcan::Registers& can) {
  return rcc.CR.read() == 0 && port_a.MODER.read() == 0 && port_b.MODER.read() == 0 &&
         can.MCR.read() == 0;
}

LockStepBoard::Word LockStepBoard::next_word() {
  hal::CanFrame frame;
  Word word = Word::kNone;
  while (word == Word::kNone && serial_[0]->receive(frame)) word = take(frame);
  send_all();  // what the lines themselves answer
  return word;
}

LockStepBoard::Word LockStepBoard::take(const hal::CanFrame& frame) {
  if (!lock_step::is_any(frame)) {
    buses_[0].put(frame);
  } else if (lock_step::is_begin(frame) && !begun_) {
    // Once: a second life would begin with what the first one left, it takes a reset.
    begun_ = asked_ = true;
    return Word::kBegin;
  } else if (const auto go = lock_step::decode_go(frame); go && begun_) {
    return obey(*go);
  }
  return Word::kNone;
}

/// Frames of the other line lie there already: the simulator has waited until they were taken.
LockStepBoard::Word LockStepBoard::obey(const lock_step::Go& go) {
  hal::CanFrame frame;
  while (serial_[1]->receive(frame)) buses_[1].put(frame);
  if (go.time_ns < clock_.now_ns()) return Word::kNone;
  clock_.advance_to(go.time_ns);
  for (std::size_t bus = 0; bus < buses_.size(); ++bus) {
    buses_[bus].allow(go.free[bus], go.bus_off[bus]);
  }
  asked_ = go.answer;
  return Word::kGo;
}

/// All that was sent in a step leaves before its Done, on both lines.
void LockStepBoard::answer(std::int64_t due_ns) {
  send_all();
  if (!asked_) return;
  serial_[0]->send(encode(lock_step::done(clock_.now_ns(), due_ns)));
  send_all();
}

/// By hand: QEMU before 8.2 raises no interrupt for an empty transmit register.
void LockStepBoard::send_all() {
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    for (std::size_t byte = 0; byte <= SerialLine::kBuffer && !lines_[i]->all_sent(); ++byte) {
      const hal::InterruptLock lock;
      lines_[i]->on_interrupt(*serial_[i], clock_.now_ns());
    }
  }
}

}  // namespace hoof::firmware::stm32f405
