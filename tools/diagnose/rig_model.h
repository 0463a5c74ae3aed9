// A rig as the search sees it: doubtful numbers and effects in, predicted channels out.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sim/effects/effect.h"
#include "tools/diagnose/data_set.h"
#include "tools/diagnose/verdict.h"

namespace hoof::tools {

/// A number of the setup that is not known exactly: normal about `value`, cut at `low`.
struct DoubtfulValue {
  std::string name;  // key of [setup]; "key@recording" where one recording overrides it
  double value = 0;
  double sigma = 0;
  double low = 0;  // -infinity where it may be negative
  double high = std::numeric_limits<double>::infinity();
  int recording = -1;  // the only one whose prediction it changes; -1: any
  bool stated = true;  // by the data set; else what a recording leaves open, and value a guess
};

struct ActiveEffect {
  const sim::EffectInfo* info = nullptr;
  std::vector<double> values;  // in the order of info->parameters
  std::string joint = {};      // of an effect at one joint of the foot, as a file names it
};

/// What a model is asked for.
enum class Rollout {
  kFree,      // from the first sample, by the recorded inputs alone: what is reported
  kCorrected  // the same, the state drawn weakly to what was measured: what is fitted where noise
              // of the inputs would carry a free rollout away. May be the same as kFree.
};

/// By compared channel, in the order of RigModel::channels, one value per sample of the recording;
/// NaN: not compared there.
using Prediction = std::vector<std::vector<double>>;

class RigModel {
 public:
  virtual ~RigModel() = default;

  /// Of all data sets, one after the other.
  virtual int recordings() const = 0;
  virtual const Recording& recording(int index) const = 0;
  /// Names of the channels that are predicted and were recorded.
  virtual const std::vector<std::string>& channels(int recording) const = 0;

  /// Stated 1-sigma noise of a channel of a recording; 0 where the data set states none.
  virtual double stated_noise(int recording, const std::string& channel) const = 0;

  /// 1-sigma that a perfect model leaves in a corrected rollout beside the sensor's noise, from
  /// noise of the inputs; 0 where inputs are exact.
  virtual double input_noise(int /*recording*/, const std::string& /*channel*/) const { return 0; }

  virtual const std::vector<DoubtfulValue>& doubtful() const = 0;
  /// Those that can act on this rig with these recordings, stand-ins for unlisted physics included.
  virtual const std::vector<const sim::EffectInfo*>& effects() const = 0;

  /// `starts` and `typical` of an effect's parameter are in this unit: the effort of these data for
  /// torques, so that one catalogue serves motors of any size.
  virtual double unit_of(const sim::EffectParameter& /*parameter*/) const { return 1; }

  /// What an effect costs beside its parameters, in log evidence: where a model takes from the
  /// recordings what cannot be known otherwise, such as which goals were lost.
  virtual double complexity(const sim::EffectInfo& /*effect*/) const { return 0; }

  /// A parameter that is counted in the recordings and not fitted.
  struct Counted {
    int parameter = 0;
    double value = 0, low95 = 0, high95 = 0;
  };
  virtual std::vector<Counted> counted(const sim::EffectInfo& /*effect*/) const { return {}; }

  /// True where a prediction takes so long that a search must look at the most promising only.
  virtual bool costly() const { return false; }

  /// Safe to call from several threads. Same arguments, same bytes.
  /// @param setup values in the order of doubtful()
  virtual Prediction predict(int recording, std::span<const double> setup,
                             std::span<const ActiveEffect> effects, Rollout rollout) const = 0;

  /// A prediction takes no integration in time: a search can afford thousands more of them.
  virtual bool quick() const { return false; }

  /// How strongly effects act at each sample, in any unit; empty where only the change of a channel
  /// tells.
  virtual std::vector<double> strength(int /*recording*/, std::span<const double> /*setup*/,
                                       std::span<const ActiveEffect> /*effects*/) const {
    return {};
  }

  /// Conditions in rig channels that tell where an effect may be at work, e.g. "velocity < 0", and
  /// for each sample whether it holds; for the verdict's `where`.
  struct Condition {
    std::string text;
    std::vector<bool> holds;
  };
  virtual std::vector<Condition> conditions(int recording) const = 0;

  /// What these recordings can tell at most, beside what is wrong with single ones.
  virtual std::vector<QualityNote> notes() const { return {}; }
};

/// @throws UserError where the data sets lack a key or channel of the rig, or are of rigs that
///         cannot be one machine
std::unique_ptr<RigModel> make_rig_model(const std::vector<DataSet>& data_sets);

}  // namespace hoof::tools
