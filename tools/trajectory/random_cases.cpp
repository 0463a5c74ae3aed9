#include "tools/trajectory/random_cases.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <memory>
#include <sstream>

#include "firmware/trajectory/generator.h"

namespace hoof::tools::trajectory {

using firmware::trajectory::Interface;
using firmware::trajectory::Synchronisation;

std::uint64_t Random::next() {
  state_ += 0x9e3779b97f4a7c15u;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

double Random::uniform(double low, double high) {
  return low + (high - low) * (static_cast<double>(next() >> 11) * 0x1p-53);
}

double Random::log_uniform(double low, double high) {
  return std::exp(uniform(std::log(low), std::log(high)));
}

int Random::integer(int low, int high) {
  return low + static_cast<int>(next() % static_cast<std::uint64_t>(high - low + 1));
}

const char* name(Family family) {
  constexpr const char* kNames[] = {"base",
                                    "asymmetric",
                                    "rest_to_rest",
                                    "target_moving",
                                    "tiny",
                                    "huge",
                                    "lattice",
                                    "exact_limits",
                                    "zero_displacement",
                                    "blocked",
                                    "replan",
                                    "start_outside",
                                    "no_jerk_limit",
                                    "velocity",
                                    "phase",
                                    "minimum_duration",
                                    "discrete",
                                    "no_sync"};
  return kNames[static_cast<int>(family)];
}

namespace {

struct Scales {
  double position, velocity, acceleration, jerk;
};

class InputMaker {
 public:
  InputMaker(Random& random, int joints) : random_(random) { input_.joints = joints; }

  Input& input() { return input_; }

  void limits(int i, const Scales& scales, bool asymmetric) {
    const auto pick = [&](double scale) { return scale * random_.uniform(0.02, 1); };
    input_.set_limits(i, pick(scales.velocity), pick(scales.acceleration), pick(scales.jerk));
    if (asymmetric) {
      input_.min_velocity[i] = -pick(scales.velocity);
      input_.min_acceleration[i] = -pick(scales.acceleration);
    }
  }

  // An acceleration, then a velocity such that neither is outside nor bound to leave; for a start
  // (side = +1) the velocity where the acceleration has gone counts, for a target (side = -1) the
  // one where it began.
  void admissible(int i, int side, double& velocity, double& acceleration) {
    const double v_max = input_.max_velocity[i];
    const double v_min = input_.min_velocity[i];
    const double jerk = input_.max_jerk[i];
    acceleration = random_.uniform(input_.min_acceleration[i], input_.max_acceleration[i]);
    double swing = acceleration * acceleration / (2 * jerk);
    if (swing > 0.9 * (v_max - v_min)) {
      acceleration *= std::sqrt(0.9 * (v_max - v_min) / swing);
      swing = acceleration * acceleration / (2 * jerk);
    }
    const bool rises = acceleration * side > 0;
    velocity =
        rises ? random_.uniform(v_min, v_max - swing) : random_.uniform(v_min + swing, v_max);
  }

  void start(int i) {
    admissible(i, 1, input_.velocity[i], input_.acceleration[i]);
    thin_out(input_.velocity[i], input_.acceleration[i]);
  }

  void target(int i) {
    admissible(i, -1, input_.target_velocity[i], input_.target_acceleration[i]);
    thin_out(input_.target_velocity[i], input_.target_acceleration[i]);
  }

  void positions(int i, double scale) {
    input_.position[i] = random_.uniform(-scale, scale);
    input_.target_position[i] = random_.uniform(-scale, scale);
  }

 private:
  // Zeros meet other borders of the solver than general values.
  void thin_out(double& velocity, double& acceleration) {
    if (random_.chance(0.3)) acceleration = 0;
    if (random_.chance(0.2)) velocity = acceleration = 0;
  }

  Random& random_;
  Input input_;
};

constexpr Scales kUsual{5, 16, 16, 16};

void moving_axis(InputMaker& maker, int i, const Scales& scales, bool asymmetric, bool to_rest) {
  maker.limits(i, scales, asymmetric);
  maker.positions(i, scales.position);
  maker.start(i);
  if (!to_rest) maker.target(i);
}

void tiny_axis(Random& random, InputMaker& maker, int i) {
  Input& in = maker.input();
  maker.limits(i, kUsual, random.chance(0.5));
  maker.positions(i, kUsual.position);
  in.target_position[i] =
      in.position[i] + random.log_uniform(1e-12, 1e-3) * (random.chance(0.5) ? 1 : -1);
  if (random.chance(0.5)) return;
  in.velocity[i] = random.log_uniform(1e-14, 1e-4) * (random.chance(0.5) ? 1 : -1);
  in.acceleration[i] = random.log_uniform(1e-14, 1e-3) * (random.chance(0.5) ? 1 : -1);
}

void huge_axis(Random& random, InputMaker& maker, int i) {
  const Scales scales{3000, random.log_uniform(10, 1e6), random.log_uniform(10, 1e6),
                      random.log_uniform(10, 1e6)};
  moving_axis(maker, i, scales, random.chance(0.5), random.chance(0.5));
}

void lattice_axis(Random& random, InputMaker& maker, int i) {
  Input& in = maker.input();
  in.set_limits(i, random.integer(1, 2), random.integer(1, 2), random.integer(1, 2));
  const auto unit = [&] { return static_cast<double>(random.integer(-1, 1)); };
  in.position[i] = unit();
  in.velocity[i] = unit();
  in.acceleration[i] = unit();
  in.target_position[i] = unit();
  in.target_velocity[i] = unit();
  in.target_acceleration[i] = unit();
  const double swing =
      in.target_acceleration[i] * std::fabs(in.target_acceleration[i]) / 2 / in.max_jerk[i];
  if (std::fabs(in.target_velocity[i] - swing) > in.max_velocity[i]) in.target_acceleration[i] = 0;
}

// States on the borders of the admissible set, or on a limit.
void exact_state(Random& random, const Input& in, int i, int side, double& v, double& a) {
  const double v_max = in.max_velocity[i];
  const double v_min = in.min_velocity[i];
  switch (random.integer(0, 3)) {
    case 0:
      v = random.chance(0.5) ? v_max : v_min;
      a = 0;
      return;
    case 1:
      a = 0;
      v = 0;
      return;
    default: {
      const bool up = random.chance(0.5);
      a = up ? in.max_acceleration[i] : in.min_acceleration[i];
      if (random.chance(0.3)) a /= 2;
      const double swing = a * a / (2 * in.max_jerk[i]);
      const bool rises = a * side > 0;
      v = rises ? v_max - swing : v_min + swing;
      if (swing > v_max - v_min) v = a = 0;
    }
  }
}

void exact_axis(Random& random, InputMaker& maker, int i) {
  Input& in = maker.input();
  maker.limits(i, kUsual, random.chance(0.3));
  maker.positions(i, kUsual.position);
  exact_state(random, in, i, 1, in.velocity[i], in.acceleration[i]);
  if (random.chance(0.6)) {
    exact_state(random, in, i, -1, in.target_velocity[i], in.target_acceleration[i]);
  }
}

// Both accelerations one way and a short way to go.
void blocked_axis(Random& random, InputMaker& maker, int i) {
  Input& in = maker.input();
  moving_axis(maker, i, kUsual, random.chance(0.5), false);
  const bool same_sign = in.acceleration[i] * in.target_acceleration[i] > 0;
  if (!same_sign) in.target_velocity[i] = in.target_acceleration[i] = 0;
  const double time_s = std::fabs(in.target_velocity[i] - in.velocity[i]) / in.max_acceleration[i] +
                        std::fabs(in.target_acceleration[i] - in.acceleration[i]) / in.max_jerk[i];
  in.target_position[i] = in.position[i] + random.uniform(0.3, 2) * time_s *
                                               (in.velocity[i] + in.target_velocity[i]) / 2;
}

// The state of a running profile some way along, in double or rounded to float, with the same goal.
Input replan(Random& random) {
  Input input = random_input(random.chance(0.5) ? Family::kTargetMoving : Family::kBase, random);
  const auto generator =
      std::make_unique<firmware::trajectory::Generator<double, kMaxJoints>>(0.001);
  generator->plan(input);
  firmware::trajectory::Output<double, kMaxJoints> output;
  generator->at_time(generator->duration_s() * random.uniform(0.05, 0.999), output);
  const bool as_float = random.chance(0.5);
  const auto rounded = [&](double x) { return as_float ? static_cast<float>(x) : x; };
  for (int i = 0; i < input.joints; ++i) {
    input.position[i] = rounded(output.position[i]);
    input.velocity[i] = rounded(output.velocity[i]);
    input.acceleration[i] = rounded(output.acceleration[i]);
  }
  return input;
}

void outside_axis(Random& random, InputMaker& maker, int i) {
  Input& in = maker.input();
  moving_axis(maker, i, kUsual, random.chance(0.5), random.chance(0.5));
  in.velocity[i] *= random.uniform(0.5, 3);
  in.acceleration[i] *= random.uniform(0.5, 3);
}

void collinear(Random& random, InputMaker& maker) {
  Input& in = maker.input();
  for (int i = 0; i < in.joints; ++i) {
    maker.limits(i, kUsual, false);
    maker.positions(i, kUsual.position);
  }
  if (random.chance(0.5)) return;
  const double speed = random.uniform(-0.1, 0.1);
  for (int i = 0; i < in.joints; ++i) {
    const double way = in.target_position[i] - in.position[i];
    in.velocity[i] = speed * way * std::min(1.0, in.max_velocity[i] / std::fabs(way));
  }
}

void make_axis(Family family, Random& random, InputMaker& maker, int i) {
  Input& in = maker.input();
  switch (family) {
    case Family::kRestToRest:
      maker.limits(i, kUsual, random.chance(0.3));
      return maker.positions(i, kUsual.position);
    case Family::kTargetMoving:
      return moving_axis(maker, i, kUsual, random.chance(0.5), false);
    case Family::kTiny:
      return tiny_axis(random, maker, i);
    case Family::kHuge:
      return huge_axis(random, maker, i);
    case Family::kLattice:
      return lattice_axis(random, maker, i);
    case Family::kExactLimits:
      return exact_axis(random, maker, i);
    case Family::kZeroDisplacement:
      moving_axis(maker, i, kUsual, random.chance(0.5), random.chance(0.5));
      in.target_position[i] = in.position[i];
      return;
    case Family::kBlocked:
      return blocked_axis(random, maker, i);
    case Family::kStartOutside:
      return outside_axis(random, maker, i);
    case Family::kNoJerkLimit:
      moving_axis(maker, i, kUsual, random.chance(0.5), random.chance(0.5));
      in.acceleration[i] = in.target_acceleration[i] = 0;
      in.max_jerk[i] = std::numeric_limits<double>::infinity();
      return;
    case Family::kAsymmetric:
      return moving_axis(maker, i, kUsual, true, random.chance(0.5));
    default:
      return moving_axis(maker, i, kUsual, random.chance(0.3), random.chance(0.5));
  }
}

}  // namespace

Input random_input(Family family, Random& random) {
  if (family == Family::kReplan) return replan(random);
  InputMaker maker(random, random.chance(0.4) ? 1 : random.integer(2, 4));
  Input& in = maker.input();
  if (family == Family::kPhase) {
    collinear(random, maker);
    in.synchronisation = Synchronisation::kPhase;
    return in;
  }
  for (int i = 0; i < in.joints; ++i) make_axis(family, random, maker, i);
  if (family == Family::kVelocity) {
    in.interface = Interface::kVelocity;
    if (random.chance(0.5)) in.synchronisation = Synchronisation::kNone;
  }
  if (family == Family::kNoSync) in.synchronisation = Synchronisation::kNone;
  if (family == Family::kMinimumDuration) in.minimum_duration_s = random.log_uniform(0.5, 50);
  if (family == Family::kDiscrete) {
    constexpr double kSteps_s[] = {0.001, 0.002, 0.005, 0.01};
    in.duration_step_s = kSteps_s[random.integer(0, 3)];
  }
  return in;
}

std::string as_command(const Input& in) {
  std::ostringstream text;
  text << std::setprecision(17);
  for (int i = 0; i < in.joints; ++i) {
    text << "  hoof trajectory solve --from=" << in.position[i] << "," << in.velocity[i] << ","
         << in.acceleration[i] << " --to=" << in.target_position[i] << "," << in.target_velocity[i]
         << "," << in.target_acceleration[i] << " --limits=" << in.max_velocity[i] << ","
         << in.min_velocity[i] << "," << in.max_acceleration[i] << "," << in.min_acceleration[i]
         << "," << in.max_jerk[i] << "\n";
  }
  if (in.minimum_duration_s > 0) text << "  minimum duration " << in.minimum_duration_s << " s\n";
  if (in.duration_step_s > 0) text << "  duration step " << in.duration_step_s << " s\n";
  return text.str();
}

}  // namespace hoof::tools::trajectory
