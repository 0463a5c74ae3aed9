// Symbols: probability p per period that a goal is the first lost of a burst, burst mean length.
//   Goals are lost in bursts, the last one that arrived is held.
// Which goals are lost is drawn by a generator with a fixed seed: the same run, the same losses.
#include <algorithm>
#include <cmath>
#include <random>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class FrameLoss final : public JointEffect {
 public:
  explicit FrameLoss(std::span<const double> values)
      : probability_(values[0]), burst_periods_(std::max(1.0, values[1])) {}

  unsigned stages() const override { return kGoalStage; }

  void reset(double /*current_rms_A*/, double /*torque_rms_Nm*/) override {
    random_.seed(kSeed);
    losing_ = false;
  }

  bool goal_lost() override {
    const double u = static_cast<double>(random_() >> 11) * 0x1p-53;
    losing_ = losing_ ? u >= 1 / burst_periods_ : u < probability_;
    return losing_;
  }

 private:
  static constexpr std::uint64_t kSeed = 1;
  double probability_, burst_periods_;
  std::mt19937_64 random_{kSeed};
  bool losing_ = false;
};

}  // namespace

EffectInfo frame_loss_effect() {
  return {.name = "frame_loss",
          .plug_in = PlugIn::kBus,
          .summary = "goals that never arrive; the drive holds the last one",
          .equation =
              "a burst begins with `probability` per period and lasts `burst` periods in "
              "the mean",
          .source =
              "two-state loss of Gilbert, Capacity of a burst-noise channel, Bell Syst. Tech. "
              "J. 39 (1960) 1253",
          .parameters = {{"probability", "1/period", 0, 0.9, 0.02, true, false, {0.02}},
                         {"burst", "periods", 1, 1000, 5, true, false, {5}}},
          .experiment = "log the goals at the drive, or its counter of frames",
          .make_joint = [](std::span<const double> values) {
            return std::make_unique<FrameLoss>(values);
          }};
}

}  // namespace hoof::sim
