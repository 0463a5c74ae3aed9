#include "tools/diagnose/prediction_cache.h"

#include <bit>

namespace hoof::tools {

void PredictionKey::add(double value) {
  bits_.push_back(std::bit_cast<std::uint64_t>(value));
}

void PredictionKey::add(int number) {
  bits_.push_back(static_cast<std::uint64_t>(number));
}

std::size_t PredictionCache::size() const {
  const std::lock_guard lock(mutex_);
  return kept_.size();
}

void PredictionCache::keep(const PredictionKey& key, const Prediction& prediction) {
  std::size_t numbers = 0;
  for (const auto& channel : prediction) numbers += channel.size();
  const std::lock_guard lock(mutex_);
  if (numbers_ + numbers > most_numbers_) {
    kept_.clear();
    numbers_ = 0;
  }
  if (kept_.emplace(key, prediction).second) numbers_ += numbers;
}

}  // namespace hoof::tools
