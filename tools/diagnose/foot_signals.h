// What a session of the foot tells: drives on the bus, ground forces and depth, at a modest rate.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "hal/can_frame.h"
#include "sim/multibody/rig.h"

namespace hoof::tools {

/// Means over blocks of control ticks: of a recorded session and of a predicted one by the same
/// code, so that both are the same functions of their frames. A block in which a drive has not
/// spoken yet is NaN; one that says nothing any more keeps its last word, as an operator's screen
/// does.
class FootSignals {
 public:
  static constexpr int kBlock_ticks = 5;  // 200 Hz
  static constexpr double kTick_s = 1e-3;

  explicit FootSignals(int ticks);

  /// Replies of drives are taken, all other frames left. @param frame its stamp is run time
  void take(const hal::CanFrame& frame);
  void ground(int tick, double depth_m, double fx_N, double fz_N);
  /// Once, at the end.
  void finish();

  /// "toe_position" ... "ground_fz"; those of a joint without a drive are NaN throughout.
  static const std::vector<std::string>& channel_names();
  const std::vector<double>& channel(const std::string& name) const;
  std::vector<double> time_s() const;  // middles of the blocks

 private:
  static constexpr int kOfJoint = 3;  // position, velocity, torque
  static constexpr int kChannels = kOfJoint * sim::kJointCount + 3;

  void add(int channel, int tick, double value);

  int blocks_;
  std::array<std::vector<double>, kChannels> sums_;
  std::array<std::vector<int>, kChannels> counts_;
};

}  // namespace hoof::tools
