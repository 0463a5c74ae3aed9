// A test on the rig, seen from outside: something that goes on in exchange intervals until it is
// over. It knows the plant and nothing of who controls its drives.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

#include "sim/coupling/plant.h"

namespace hoof::sim {

enum class Phase {
  kPreparing,  // drives home and take their positions; the ground is not touched
  kLowering,   // sinkage: carriage goes down at its speed until first contact
  kLoaded,     // sinkage: free under the load; traction: from first contact on
  kFinished,
};

const char* to_string(Phase phase);

/// What a control tick looked like from the plant. Forces are means over the tick.
struct Observation {
  double time_s = 0;
  Phase phase = Phase::kPreparing;
  double depth_m = 0;                                  // see the experiment
  double sink_speed_m_s = 0;                           // downward
  Eigen::Vector3d foot_m = Eigen::Vector3d::Zero();    // middle of the sole, world
  Eigen::Vector3d ground_N = Eigen::Vector3d::Zero();  // ground on foot, world
  double toe_left_rad = 0;                             // true openings
  double toe_right_rad = 0;
};

class Experiment {
 public:
  virtual ~Experiment() = default;

  /// Control says that the foot is as the test wants it: the test may go on.
  virtual void foot_ready() = 0;

  /// One exchange interval. @throws std::runtime_error when the plant diverges
  void advance();

  /// The mean since the last call; once per control tick.
  Observation observe();

  virtual bool finished() const = 0;
  /// About how far the test has come, 0 to 1, for a progress bar.
  virtual double progress() const = 0;

  Phase phase() const { return phase_; }
  Plant& plant() { return *plant_; }
  const Plant& plant() const { return *plant_; }
  double time_s() const { return plant_->time_s(); }

 protected:
  explicit Experiment(std::unique_ptr<Plant> plant) : plant_(std::move(plant)) {}

  virtual void before_interval() {}
  virtual void after_interval() = 0;
  virtual double depth_m() const = 0;

  Phase phase_ = Phase::kPreparing;

 private:
  std::unique_ptr<Plant> plant_;
  Eigen::Vector3d ground_sum_N_ = Eigen::Vector3d::Zero();
  int intervals_ = 0;
};

}  // namespace hoof::sim
