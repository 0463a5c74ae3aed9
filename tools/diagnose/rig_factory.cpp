// The rig of some data sets.
#include "tools/diagnose/foot_model.h"
#include "tools/diagnose/pendulum_model.h"
#include "tools/diagnose/press_model.h"
#include "tools/diagnose/rig_model.h"
#include "tools/run/errors.h"

namespace hoof::tools {

std::unique_ptr<RigModel> make_rig_model(const std::vector<DataSet>& data_sets) {
  if (data_sets.empty()) throw UserError("no data set given");
  const RigKind rig = data_sets.front().rig;
  // A press on sand and one on a block are one machine.
  if (rig == RigKind::kPlateSand || rig == RigKind::kRigidPress) {
    return std::make_unique<PressModel>(data_sets);
  }
  for (const DataSet& data_set : data_sets) {
    if (data_set.rig == rig) continue;
    throw UserError(data_set.file.string() + ": rig = \"" + rig_name(data_set.rig) +
                    "\" cannot be one machine with " + rig_name(rig) + " of " +
                    data_sets.front().file.string());
  }
  switch (rig) {
    case RigKind::kServoPendulum:
      return std::make_unique<PendulumModel>(data_sets);
    case RigKind::kFootHil:
      return std::make_unique<FootModel>(data_sets);
    case RigKind::kPlateSand:
    case RigKind::kRigidPress:
      return std::make_unique<PressModel>(data_sets);
    default:
      throw UserError(data_sets.front().file.string() + ": no model of rig " + rig_name(rig));
  }
}

}  // namespace hoof::tools
