// A simulated set of registers whose reactions a test writes down, register by register.
#pragma once

#include <functional>
#include <map>

#include "hal/register.h"

namespace hoof::tests {

class SimulatedRegisters : public hal::RegisterWatcher {
 public:
  using OnWrite = std::function<void(hal::Register&, std::uint32_t)>;
  using OnRead = std::function<std::uint32_t(hal::Register&)>;

  SimulatedRegisters() { hal::Register::watcher = this; }
  ~SimulatedRegisters() { hal::Register::watcher = nullptr; }
  SimulatedRegisters(const SimulatedRegisters&) = delete;

  /// In place of storing the value.
  void when_written(hal::Register& target, OnWrite reaction) {
    writes_[&target] = std::move(reaction);
  }
  /// In place of the stored value.
  void when_read(hal::Register& target, OnRead reaction) { reads_[&target] = std::move(reaction); }

  std::size_t accesses = 0;

  std::uint32_t on_read(hal::Register& accessed) override {
    ++accesses;
    const auto found = reads_.find(&accessed);
    return found == reads_.end() ? accessed.stored() : found->second(accessed);
  }
  void on_write(hal::Register& accessed, std::uint32_t value) override {
    ++accesses;
    const auto found = writes_.find(&accessed);
    if (found == writes_.end()) {
      accessed.store(value);
    } else {
      found->second(accessed, value);
    }
  }

 private:
  std::map<hal::Register*, OnWrite> writes_;
  std::map<hal::Register*, OnRead> reads_;
};

}  // namespace hoof::tests
