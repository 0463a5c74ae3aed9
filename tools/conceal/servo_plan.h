#pragma once

#include <string>
#include <vector>

#include "tools/conceal/random_stream.h"
#include "tools/conceal/servo_machine.h"

namespace hoof::tools::conceal {

/// A number of the machine that the operator knows with doubt only.
struct DoubtfulParameter {
  std::string key;
  double ServoMachine::*field;
  double believed = 0.0, sigma = 0.0;
};

/// What the recorder adds to a channel that the model predicts.
struct ChannelNoise {
  std::string channel;
  std::vector<double> ServoSignals::*signal;
  double sigma = 0.0;
};

/// A machine, what is done with it, what of it is written down and what is believed of it.
struct ServoPlan {
  ServoMachine machine;
  std::vector<ServoExercise> exercises;
  std::vector<bool> holdout;
  std::vector<std::string> files;
  std::vector<DoubtfulParameter> doubts;
  std::vector<ChannelNoise> predicted;
  double effort_snr_db = 0.0;
  double loop_rate_rad_s = 0.0;  ///< of the position loop, 0 where there is none
  bool supply_channel = false, torque_ff = false, temperature = false, noise_given = false;
  bool degrees = false, own_names = false;
  double missing_share = 0.0, first_time_s = 0.0;
};

struct PlanWish {
  DriveLaw law = DriveLaw::kImpedance;
  bool stiff = false;             ///< position loop that hides what happens
  bool right_parameters = false;  ///< believed = true
  bool two_masses = false;        ///< motor and link may part: the loop must bear it
  bool start_cold = false;        ///< every recording begins with the machine at rest
  bool plain_supply = false;      ///< no channel of the supply
};

/// Draws all but the noise of the effort, which goes by the effort's own size.
ServoPlan draw_servo_plan(const PlanWish& wish, RandomStream& random);

/// Sets the noise of torque and current `plan.effort_snr_db` below their rms.
void set_effort_noise(ServoPlan& plan, const std::vector<ServoSignals>& clean);

std::vector<ServoSignals> run_plan(const ServoPlan& plan, const std::vector<HiddenEffect>& hidden,
                                   double step_s = 1e-4);

/// The paths of a plan's exercises; `kind` counts on through slow, fast, steps, drop, ...
GoalPath draw_position_path(int kind, double duration_s, RandomStream& random,
                            double& disable_at_s);

}  // namespace hoof::tools::conceal
