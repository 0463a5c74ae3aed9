#include "tools/qemu/qemu_line.h"

#include <chrono>
#include <stdexcept>
#include <thread>

#include "hal/monotonic_clock.h"

namespace hoof::tools::qemu {
namespace {

/// Then whoever waits looks at its own time.
constexpr std::int64_t kLongestFlush_ns = 100'000'000;
/// A machine that dies closes its lines a moment before it can be asked how it ended.
constexpr std::int64_t kLastBreath_ns = 1'000'000'000;

}  // namespace

QemuLine::QemuLine(const std::vector<std::uint8_t>& flash, std::int64_t patience_ns)
    : machine_(flash),
      clients_{SlcanClient("USART1", machine_.line(0)), SlcanClient("USART2", machine_.line(1))} {
  for (std::size_t i = 0; i < clients_.size(); ++i) {
    if (clients_[i].open(patience_ns)) continue;
    const std::string why = gone();
    throw std::runtime_error(
        foot() + " did not open its serial line on USART" + std::to_string(i + 1) + " within " +
        std::to_string(patience_ns / 1'000'000) + " ms" + (why.empty() ? "" : ": " + why));
  }
}

std::string QemuLine::advice() const {
  return "an image with CAN or clocks of its own does not; is it one of `hoof firmware build`?";
}

bool QemuLine::flush() {
  return flush_in_order(clients_[1], clients_[0], kLongestFlush_ns);
}

std::string QemuLine::gone() {
  std::string end = machine_.ended();
  for (const SlcanClient& client : clients_) {
    if (!end.empty() || client.failure().empty()) continue;
    const hal::MonotonicClock clock;
    const std::int64_t give_up_ns = clock.now_ns() + kLastBreath_ns;
    while ((end = machine_.ended()).empty() && clock.now_ns() < give_up_ns) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (end.empty()) end = client.failure();
  }
  return end;
}

}  // namespace hoof::tools::qemu
