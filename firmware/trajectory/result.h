// Outcomes of planning and of one control tick, and the choices a caller makes.
#pragma once

#include <cstdint>

namespace hoof::firmware::trajectory {

// Negative values are failures; the numbers are those of the case files (tests/data/trajectory).
enum class Result : std::int8_t {
  kWorking = 0,             // a profile is running
  kFinished = 1,            // this tick's sample is the target; reported exactly once per profile
  kHolding = 2,             // after kFinished: at the target (or moving on at its velocity)
  kPlanning = 3,            // only from work(): the plan is not complete yet
  kInvalidInput = -100,     // validate() refuses the input and says why
  kOutOfRange = -101,       // finite input, but the solution leaves the range of Real
  kZeroLimits = -104,       // a limit of zero forbids the motion
  kNoSolution = -110,       // an axis has no feasible duration (does not occur with limits > 0)
  kNoCommonDuration = -111  // axes pinned by zero limits have no duration in common
};

constexpr bool is_failure(Result result) {
  return static_cast<std::int8_t>(result) < 0;
}

enum class Interface : std::uint8_t {
  kPosition,  // reach target position, velocity and acceleration
  kVelocity   // reach target velocity and acceleration; position and velocity limits do not apply
};

enum class Synchronisation : std::uint8_t {
  kNone,  // every axis takes its own minimum duration
  kTime,  // all axes arrive together
  // As kTime; when the states are collinear and it costs no time, all axes also follow one common
  // scalar, that is, a straight line (Output::straight_line tells).
  kPhase
};

inline const char* name(Result result) {
  switch (result) {
    case Result::kWorking:
      return "working";
    case Result::kFinished:
      return "finished";
    case Result::kHolding:
      return "holding";
    case Result::kPlanning:
      return "planning";
    case Result::kInvalidInput:
      return "invalid input";
    case Result::kOutOfRange:
      return "out of numeric range";
    case Result::kZeroLimits:
      return "a zero limit forbids the motion";
    case Result::kNoSolution:
      return "no feasible duration";
    case Result::kNoCommonDuration:
      return "no common duration";
  }
  return "unknown";
}

}  // namespace hoof::firmware::trajectory
