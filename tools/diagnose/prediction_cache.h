// Rollouts that were made, kept for whoever asks for the same again: a fit's slopes, its judgement
// and the tables of a report all begin where the fit before them ended.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <vector>

#include "tools/diagnose/rig_model.h"

namespace hoof::tools {

/// What a rollout depends on, bit by bit: numbers that differ in the last bit are others.
class PredictionKey {
 public:
  void add(double value);
  void add(int number);
  auto operator<=>(const PredictionKey&) const = default;

 private:
  std::vector<std::uint64_t> bits_;
};

/// From several threads at once. What is told does not depend on what is kept.
class PredictionCache {
 public:
  /// @param most_numbers all predictions together; beyond that all are forgotten
  explicit PredictionCache(std::size_t most_numbers = std::size_t{1} << 24)
      : most_numbers_(most_numbers) {}

  /// @param make called where there is none of this key, outside of the lock
  template <class Make>
  Prediction get(const PredictionKey& key, Make make) {
    {
      const std::lock_guard lock(mutex_);
      if (const auto found = kept_.find(key); found != kept_.end()) return found->second;
    }
    Prediction made = make();
    keep(key, made);
    return made;
  }

  std::size_t size() const;

 private:
  void keep(const PredictionKey& key, const Prediction& prediction);

  std::size_t most_numbers_;
  std::size_t numbers_ = 0;
  std::map<PredictionKey, Prediction> kept_;
  mutable std::mutex mutex_;
};

}  // namespace hoof::tools
