#include "firmware/app/storage.h"

namespace hoof::firmware::app {

const LoadReport& Storage::load(Parameters& parameters) {
  report_ = parameters_.load(parameters);
  if (fault_log_.state() == LogState::kUnformatted && fault_log_.used() == 0) {
    fault_log_.erase(control::Mode::kOff);
  }
  return report_;
}

/// Names that are new since are at their defaults; that is no doubt.
bool Storage::doubtful() const {
  return report_.result == LoadResult::kDamaged || report_.result == LoadResult::kOtherLayout ||
         report_.out_of_range > 0;
}

StoreResult Storage::store(const Parameters& parameters, control::Mode mode) {
  const StoreResult result = parameters_.store(parameters, mode);
  if (result == StoreResult::kOk) ++report_.sequence;
  return result;
}

}  // namespace hoof::firmware::app
