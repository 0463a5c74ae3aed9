// What outlives the power: the parameters and the fault log, each in sectors of its own.
#pragma once

#include <array>
#include <cstddef>

#include "firmware/app/fault_log.h"
#include "firmware/app/parameter_store.h"
#include "hal/nonvolatile.h"

namespace hoof::firmware::app {

struct StorageSectors {
  std::array<std::size_t, 2> parameters{0, 1};
  std::size_t fault_log = 2;
};

class Storage {
 public:
  explicit Storage(hal::Nonvolatile& flash, const StorageSectors& sectors = {})
      : parameters_(flash, sectors.parameters), fault_log_(flash, sectors.fault_log) {}

  /// At the start, before any drive is entered: sets all parameters, and readies the log where
  /// there is nothing in it yet, for which it erases a sector.
  const LoadReport& load(Parameters& parameters);

  /// Of the last load(), its sequence also of the last store().
  const LoadReport& report() const { return report_; }

  /// Whether what was stored could not be read, or not all of it: not to be moved with.
  bool doubtful() const;

  StoreResult store(const Parameters& parameters, control::Mode mode);
  FaultLog& fault_log() { return fault_log_; }
  const FaultLog& fault_log() const { return fault_log_; }

 private:
  ParameterStore parameters_;
  FaultLog fault_log_;
  LoadReport report_;
};

}  // namespace hoof::firmware::app
