#pragma once

#include <vector>

namespace hoof::tools::conceal {

/// A smooth function of time: what the operator asks of the joint, in rad, or of the motor, in Nm.
/// Steps are ramps of least jerk, so that it matters little how a reader fills the time between
/// two samples.
class GoalPath {
 public:
  struct Sine {
    double amplitude, frequency_Hz, phase;
  };
  struct Chirp {
    double amplitude, from_Hz, to_Hz, duration_s;
  };
  /// Moves by `by` within `duration_s` from `start_s` on: least jerk where smooth, else a straight
  /// ramp with corners rounded over 0.1 s.
  struct Move {
    double start_s, duration_s, by;
    bool smooth;
  };

  double offset = 0.0;
  double fade_in_s = 0.0;  ///< the waves grow from nothing, so that the run starts at rest
  std::vector<Sine> sines;
  std::vector<Chirp> chirps;
  std::vector<Move> moves;

  /// Before time 0 the path rests at its first value.
  double value(double t_s) const;
  double rate(double t_s) const;  ///< per second, by central differences

  /// All of it larger or smaller about its offset.
  void scale(double factor);
};

}  // namespace hoof::tools::conceal
