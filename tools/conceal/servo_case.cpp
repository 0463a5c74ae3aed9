#include "tools/conceal/servo_case.h"

#include "tools/conceal/servo_hide.h"
#include "tools/conceal/servo_truth.h"
#include "tools/run/errors.h"

namespace hoof::tools::conceal {
namespace {

constexpr int kMostDraws = 100;

}  // namespace

CaseData finish_servo_case(const std::string& name, const CaseRequest& request,
                           const ServoPlan& plan, const HiddenInServo& hidden,
                           const RandomStream& random) {
  CaseData data = record_servo(name, plan, hidden.signals, random.branch(1));
  data.truth = servo_truth(request, plan, hidden.effects, hidden.signals, hidden.together);
  data.truth["holdout_rmse"] = truth_holdout_rmse(plan, hidden.effects, data);
  return data;
}

CaseData make_servo_case(const std::string& name, const CaseRequest& request,
                         const RandomStream& random) {
  for (int draw = 0; draw < kMostDraws; ++draw) {
    const RandomStream stream = random.branch(std::uint64_t(draw));
    RandomStream planning = stream.branch(0);
    PlanWish wish = wish_for(request.effects, request.stiff, planning);
    wish.right_parameters = request.kind == "none";
    ServoPlan plan = draw_servo_plan(wish, planning);
    HiddenInServo hidden;
    hidden.signals = run_plan(plan, {});
    if (!all_sane(hidden.signals)) continue;
    set_effort_noise(plan, hidden.signals);
    if (!request.effects.empty() &&
        !hide_in_servo(request, plan, scale_of(plan, hidden.signals), stream.branch(2), hidden)) {
      continue;
    }
    return finish_servo_case(name, request, plan, hidden, stream);
  }
  throw CannotFinish(name + ": no machine was found that hides what was drawn");
}

}  // namespace hoof::tools::conceal
