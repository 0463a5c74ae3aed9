#include "firmware/board/stm32f405/watchdog.h"

namespace hoof::firmware::stm32f405 {
namespace {

struct Setting {
  std::uint32_t prescaler;  // PR: divides by 4 * 2^PR
  std::uint32_t reload;
};

constexpr std::uint32_t kFastest_Hz = 47'000;
constexpr std::uint32_t kSlowest_Hz = 17'000;

constexpr std::uint32_t time_us(Setting setting, std::uint32_t oscillator_Hz) {
  const std::uint64_t cycles = (std::uint64_t{4} << setting.prescaler) * (setting.reload + 1);
  return static_cast<std::uint32_t>(cycles * 1'000'000 / oscillator_Hz);
}

constexpr Setting kTick{0, 234};
constexpr Setting kStart{4, 734};
static_assert(time_us(kTick, kFastest_Hz) == 20'000 && time_us(kTick, kSlowest_Hz) == 55'294);
static_assert(time_us(kStart, kFastest_Hz) == 1'000'851 &&
              time_us(kStart, kSlowest_Hz) < 2'800'000);
static_assert(kStart.reload <= iwdg::kLargestReload);

/// An earlier change takes up to five of the slow oscillator's cycles, 0.3 ms.
constexpr std::uint32_t kUpdateTries = 20'000;

}  // namespace

void Watchdog::set(Time time) {
  time_ = time;
  const Setting& setting = time == Time::kTick ? kTick : kStart;
  const auto settled = [this] { return !registers_.SR.has_any(iwdg::kUpdating); };
  hal::wait_until(kUpdateTries, settled);
  registers_.KR.write(iwdg::kUnlock);
  registers_.PR.write(setting.prescaler);
  registers_.RLR.write(setting.reload);
  // Fed earlier it would start from the former reload value.
  hal::wait_until(kUpdateTries, settled);
  feed();
}

}  // namespace hoof::firmware::stm32f405
