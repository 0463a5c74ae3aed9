// Picks the moments of a run whose fields are kept, and survives the run being cut off.
#pragma once

#include <Eigen/Geometry>
#include <deque>
#include <optional>

#include "sim/experiments/experiment.h"
#include "tools/fields/field_moment.h"

namespace hoof::tools {

/// Which moments. "contact" is the first tick with the foot on the sand: displacements and changes
/// of packing count from there. The bed is looked at every kLook_ticks for what may turn out to be
/// the extreme, so that moment is found to half of that.
struct FieldPlan {
  static constexpr int kLook_ticks = 5;
  static constexpr int kMean_ticks = 11;  // over which Fx is averaged, as for the result's peak

  /// Sinkage: times after the contact, s; then "greatest depth" and "end".
  std::vector<double> after_contact_s;
  /// Traction: phases of the stance in turns of the ellipse, 0.5 its deepest point; then "peak Fx".
  std::vector<double> phases_turns;
  /// Of the foot on its path, turns; traction only.
  std::function<double(const Eigen::Vector3d& foot_m)> turns;
  /// What of the bed is kept.
  Eigen::AlignedBox3d region_m;

  bool is_traction() const { return !phases_turns.empty(); }
};

class FieldRecorder {
 public:
  explicit FieldRecorder(FieldPlan plan) : plan_(std::move(plan)) {}

  /// After every tick in which the bed is what the run says, not what a journal answers.
  void tick(const sim::Observation& plant, const sim::Rig& rig, const sim::SandBed& bed);

  /// All that is needed to go on from here, for a checkpoint of the bed.
  std::string save() const;
  /// @throws std::runtime_error where the bytes are damaged
  void restore(std::string_view bytes);

  /// The moments by time, the last state of the bed among them after a sinkage test. Empty where
  /// the foot never touched.
  std::vector<FieldMoment> finish(const sim::Observation& last, const sim::Rig& rig,
                                  const sim::SandBed& bed);

 private:
  FieldMoment look(const std::string& name, const sim::Observation& plant, const sim::Rig& rig,
                   const sim::SandBed& bed) const;
  std::optional<std::string> due(const sim::Observation& plant);
  void look_for_greatest_depth(const sim::Observation& plant, const sim::Rig& rig,
                               const sim::SandBed& bed);
  void look_for_peak(const sim::Observation& plant, const sim::Rig& rig, const sim::SandBed& bed);

  FieldPlan plan_;
  double last_time_s_ = -1;
  double contact_s_ = -1;
  std::uint64_t loaded_ticks_ = 0;
  std::uint64_t next_ = 0;  // of the planned times or phases
  bool in_first_stance_ = true;
  std::deque<double> fx_N_;  // of the last kMean_ticks
  double best_ = -1e300;     // depth, or mean Fx
  std::optional<FieldMoment> extreme_;
  std::optional<FieldMoment> pending_;  // half a mean ago
  std::vector<FieldMoment> moments_;
};

}  // namespace hoof::tools
