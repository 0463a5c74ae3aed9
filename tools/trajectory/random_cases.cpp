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

double Random::normal(double sigma) {
  double sum = 0;  // of twelve: variance one, and never beyond six
  for (int i = 0; i < 12; ++i) sum += uniform(-0.5, 0.5);
  return sigma * sum;
}

int Random::integer(int low, int high) {
  return low + static_cast<int>(next() % static_cast<std::uint64_t>(high - low + 1));
}

const char* name(Family family) {
  constexpr const char* kNames[] = {"base",
                                    "asym",
                                    "hoof",
                                    "rest_to_rest",
                                    "target_moving",
                                    "tiny",
                                    "huge",
                                    "lattice",
                                    "exact_limits",
                                    "zero_displacement",
                                    "blocked",
                                    "replan",
                                    "replan_f32",
                                    "start_outside",
                                    "no_jerk_limit",
                                    "velocity_control",
                                    "phase_sync",
                                    "minimum_duration",
                                    "discrete_duration",
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

  void start(int i) { state(i, 1, input_.velocity[i], input_.acceleration[i]); }
  void target(int i) { state(i, -1, input_.target_velocity[i], input_.target_acceleration[i]); }

  void positions(int i, double sigma) {
    input_.position[i] = random_.normal(sigma);
    input_.target_position[i] = random_.normal(sigma);
  }

 private:
  // Half of them spread over all that is admissible; half slow, cut off at the limit where they are
  // beyond it, as in the case files.
  void state(int i, int side, double& velocity, double& acceleration) {
    if (random_.chance(0.5)) {
      admissible(i, side, velocity, acceleration);
    } else {
      const auto slow = [&](double low, double high) {
        return std::clamp(random_.normal(1), low, high);
      };
      velocity = slow(input_.min_velocity[i], input_.max_velocity[i]);
      acceleration = slow(input_.min_acceleration[i], input_.max_acceleration[i]);
      const double beyond =
          velocity + side * acceleration * std::fabs(acceleration) / (2 * input_.max_jerk[i]);
      if (beyond > input_.max_velocity[i] || beyond < input_.min_velocity[i]) acceleration = 0;
    }
    thin_out(velocity, acceleration);
  }

  // Zeros meet other borders of the solver than general values.
  void thin_out(double& velocity, double& acceleration) {
    if (random_.chance(0.3)) acceleration = 0;
    if (random_.chance(0.2)) velocity = acceleration = 0;
  }

  Random& random_;
  Input input_;
};

constexpr Scales kUsual{3.5, 16, 16, 16};

void moving_axis(InputMaker& maker, int i, const Scales& scales, bool asymmetric, bool to_rest) {
  maker.limits(i, scales, asymmetric);
  maker.positions(i, scales.position);
  maker.start(i);
  if (!to_rest) maker.target(i);
}

void hoof_axis(Random& random, InputMaker& maker, int i) {
  Input& in = maker.input();
  in.set_limits(i, random.log_uniform(0.8, 20), random.log_uniform(5, 300),
                random.log_uniform(200, 80'000));
  if (random.chance(0.4)) {
    in.min_velocity[i] *= random.uniform(0.3, 1);
    in.min_acceleration[i] *= random.uniform(0.3, 1);
  }
  maker.positions(i, 0.7);
  maker.start(i);
  if (random.chance(0.4)) maker.target(i);
}

void tiny_axis(Random& random, InputMaker& maker, int i) {
  Input& in = maker.input();
  maker.limits(i, {5, 10, 10, 10}, random.chance(0.5));
  maker.positions(i, 5);
  in.target_position[i] =
      in.position[i] + random.log_uniform(1e-12, 1e-3) * (random.chance(0.5) ? 1 : -1);
  if (random.chance(0.4)) return;
  in.velocity[i] = random.log_uniform(1e-14, 1e-4) * (random.chance(0.5) ? 1 : -1);
  in.acceleration[i] = random.log_uniform(1e-14, 1e-3) * (random.chance(0.5) ? 1 : -1);
}

void huge_axis(Random& random, InputMaker& maker, int i) {
  Input& in = maker.input();
  const auto scale = [&] { return random.log_uniform(10, 1e6); };
  in.set_limits(i, scale(), scale(), scale());
  if (random.chance(0.5)) {
    in.min_velocity[i] = -scale();
    in.min_acceleration[i] = -scale();
  }
  maker.positions(i, 1000);
  if (random.chance(0.6)) maker.start(i);
  if (random.chance(0.4)) maker.target(i);
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
Input replan(Random& random, int joints, bool as_float) {
  constexpr Family kParents[] = {Family::kTargetMoving, Family::kBase, Family::kHoof};
  Input input = random_input(kParents[random.integer(0, 2)], random, joints);
  const auto generator =
      std::make_unique<firmware::trajectory::Generator<double, kMaxJoints>>(0.001);
  generator->plan(input);
  firmware::trajectory::Output<double, kMaxJoints> output;
  // In the file anything from the start to the last microsecond.
  const double share =
      random.chance(0.5) ? random.uniform(0.05, 0.999) : 1 - random.log_uniform(1e-7, 1e-1);
  generator->at_time(generator->duration_s() * share, output);
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
  moving_axis(maker, i, {3.5, 8, 8, 8}, random.chance(0.5), random.chance(0.5));
  const auto beyond = [&](double low, double high) {
    const double of_limit = random.uniform(-2.5, 2.5);
    return of_limit > 0 ? of_limit * high : -of_limit * low;
  };
  in.velocity[i] = beyond(in.min_velocity[i], in.max_velocity[i]);
  in.acceleration[i] = beyond(in.min_acceleration[i], in.max_acceleration[i]);
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
    case Family::kHoof:
      return hoof_axis(random, maker, i);
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
      if (random.chance(0.3)) {
        in.target_velocity[i] = in.velocity[i];
        in.acceleration[i] = in.target_acceleration[i] = 0;
      }
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

// Nearest float, but not beyond a limit it is not beyond now.
void round_to_float(Input& in) {
  for (int i = 0; i < in.joints; ++i) {
    for (auto* vector : {&in.position, &in.target_position, &in.max_velocity, &in.min_velocity,
                         &in.max_acceleration, &in.min_acceleration, &in.max_jerk}) {
      (*vector)[i] = static_cast<float>((*vector)[i]);
    }
    for (auto* vector :
         {&in.velocity, &in.acceleration, &in.target_velocity, &in.target_acceleration}) {
      const float nearest = static_cast<float>((*vector)[i]);
      (*vector)[i] =
          std::fabs(nearest) <= std::fabs((*vector)[i]) ? nearest : std::nextafter(nearest, 0.0f);
    }
  }
}

int random_joints(Random& random) {
  if (random.chance(0.4)) return 1;
  return random.chance(0.1) ? random.integer(5, kMaxJoints) : random.integer(2, 4);
}

void set_modes(Family family, Random& random, Input& in) {
  if (family == Family::kVelocity) {
    in.interface = Interface::kVelocity;
    if (random.chance(0.5)) in.synchronisation = Synchronisation::kNone;
    for (int i = 0; i < in.joints; ++i) {
      if (random.chance(0.1)) in.acceleration[i] *= random.uniform(1, 2);
    }
  }
  if (family == Family::kNoSync) in.synchronisation = Synchronisation::kNone;
  if (family == Family::kMinimumDuration) in.minimum_duration_s = random.log_uniform(0.5, 50);
  if (family == Family::kDiscrete) {
    constexpr double kSteps_s[] = {0.001, 0.002, 0.005, 0.01};
    in.duration_step_s = kSteps_s[random.integer(0, 3)];
  }
}

}  // namespace

Input random_input(Family family, Random& random, int joints) {
  if (family == Family::kReplan || family == Family::kReplanFloat) {
    return replan(random, joints, family == Family::kReplanFloat);
  }
  InputMaker maker(random, joints > 0 ? joints : random_joints(random));
  Input& in = maker.input();
  if (family == Family::kPhase) {
    collinear(random, maker);
    in.synchronisation = Synchronisation::kPhase;
    return in;
  }
  for (int i = 0; i < in.joints; ++i) make_axis(family, random, maker, i);
  // Half the numbers of the case files are floats.
  const bool exact = family == Family::kExactLimits || family == Family::kTiny;
  if (!exact && random.chance(0.5)) round_to_float(in);
  set_modes(family, random, in);
  // A rounded limit may be just below the velocity a target's acceleration needs.
  if (validate(in)) {
    for (int i = 0; i < in.joints; ++i) {
      in.target_velocity[i] /= 2;
      in.target_acceleration[i] /= 2;
    }
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
