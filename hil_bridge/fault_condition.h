// When a fault begins: a comparison on a signal of the run, "depth_m > 0.005", "mode == running".
#pragma once

#include <string>
#include <string_view>

namespace hoof::bridge {

struct TickRecord;

class FaultCondition {
 public:
  /// Signal, one of > >= < <= == !=, number or, for the mode, its name.
  /// @throws std::invalid_argument saying what is wrong and what is known
  explicit FaultCondition(std::string_view text);

  /// All signals there are, "time_s, tick, ...".
  static std::string signal_names();

  bool holds(const TickRecord& record) const;
  const std::string& text() const { return text_; }

 private:
  using Signal = double (*)(const TickRecord&);

  std::string text_;
  Signal signal_ = nullptr;
  std::string comparison_;
  double value_ = 0;
};

}  // namespace hoof::bridge
