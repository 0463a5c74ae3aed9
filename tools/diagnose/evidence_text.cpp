#include "tools/diagnose/evidence_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace hoof::tools {
namespace {

std::string number(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.3g", value);
  return buffer;
}

std::string percent(double share) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.0f %%", 100 * share);
  return buffer;
}

/// "position 0.07 to 0.031"
std::string change_of(const Errors& before, const Errors& after) {
  std::string text;
  for (const auto& [key, value] : before) {
    const auto to = after.find(key);
    if (to == after.end()) continue;
    const std::string channel = key.substr(0, key.rfind("_rmse"));
    text +=
        (text.empty() ? "" : ", ") + channel + " " + number(value) + " to " + number(to->second);
  }
  return text;
}

bool all_smaller(const Errors& a, const Errors& b) {
  return !a.empty() && std::all_of(a.begin(), a.end(), [&b](const auto& entry) {
    const auto other = b.find(entry.first);
    return other != b.end() && entry.second < other->second;
  });
}

/// A number that someone stated, and that a fit contradicts.
bool far_from_stated(const RigModel& model, const Eigen::VectorXd& x, Eigen::Index i) {
  constexpr double kFar = 2.5;  // sigmas
  return model.doubtful()[static_cast<std::size_t>(i)].stated && std::abs(x[i]) >= kFar;
}

}  // namespace

void write_evidence(const Judgement& judgement, const Fitter& fitter, const Fit& none,
                    const Fit& winner, Verdict& verdict) {
  auto& pro = verdict.evidence_for;
  auto& contra = verdict.evidence_against;
  const Standing* best = nullptr;
  const Standing* rival = nullptr;
  for (const Standing& s : judgement.standings) {
    if (s.fit == &winner) {
      best = &s;
    } else if (!rival && !s.fit->effects.empty()) {
      rival = &s;
    }
  }
  const double floor = std::sqrt(std::exp(2 * judgement.misfit));
  pro.push_back("With its doubtful numbers refitted the nominal model leaves " + number(floor) +
                " times the noise of the sensors.");
  for (Eigen::Index i = 0; i < none.x.size(); ++i) {
    if (!far_from_stated(fitter.model(), none.x, i)) continue;
    contra.push_back("To fit, the nominal model takes " +
                     fitter.model().doubtful()[static_cast<std::size_t>(i)].name + " " +
                     number(std::abs(none.x[i])) + " sigma from what the operator stated.");
  }
  if (best && best->fit != &none) {
    pro.push_back(name_of(winner.effects) + " removes " + percent(best->explained) +
                  " of what the nominal model leaves above the noise (log evidence " +
                  number(best->evidence) + ").");
    if (!verdict.before.holdout.empty()) {
      (best->holdout_gain > 0 ? pro : contra)
          .push_back("On recordings it was not fitted to the rmse goes from " +
                     change_of(verdict.before.holdout, verdict.after.holdout) + ".");
    }
    if (best->explained < 0.7) {
      contra.push_back(
          "It leaves more than the noise: something else is at work as well, or the "
          "effect's form is only near the truth.");
    }
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(fitter.model().doubtful().size()); ++i) {
      if (!far_from_stated(fitter.model(), winner.x, i)) continue;
      contra.push_back("It needs " + fitter.model().doubtful()[static_cast<std::size_t>(i)].name +
                       " " + number(std::abs(winner.x[i])) + " sigma from what was stated.");
    }
  }
  // A member that does better alone, where nothing was fitted.
  if (winner.effects.size() > 1) {
    for (const AblationRow& row : verdict.ablation) {
      const bool single = row.model.starts_with("nominal + ") &&
                          row.model.find_first_of("+,", 10) == std::string::npos;
      if (!single || !all_smaller(row.holdout, verdict.after.holdout)) continue;
      contra.push_back("On held-out recordings " + row.model.substr(10) + " alone comes nearer: " +
                       change_of(verdict.after.holdout, row.holdout) + ".");
    }
  }
  if (rival) {
    const double lead =
        best ? best->evidence + best->holdout_gain - rival->evidence - rival->holdout_gain : 0;
    (lead > 5 ? pro : contra)
        .push_back("The next explanation, " + name_of(rival->fit->effects) + ", is behind by " +
                   number(lead) + " in log evidence, held-out data included.");
  }
}

UnknownTerm describe_unknown(const Fitter& fitter, const Fit& none, const Fit& stand_in,
                             const std::vector<std::string>& channels, const Errors& holdout) {
  UnknownTerm term;
  term.inputs = channels;
  term.form = stand_in.effects.empty() ? "none of the stand-ins fits"
                                       : std::string(stand_in.effects.front()->equation);
  double before = 0, after = 0;
  for (std::size_t g = 0; g < fitter.groups().size(); ++g) {
    const double square = fitter.groups()[g].noise * fitter.groups()[g].noise;
    before += std::max(none.squares[g] / square - fitter.groups()[g].samples, 0.0);
    after += std::max(stand_in.squares[g] / square - fitter.groups()[g].samples, 0.0);
  }
  term.residual_share = before > 0 ? std::clamp(1 - after / before, 0.0, 1.0) : 0;
  term.holdout = holdout;
  return term;
}

}  // namespace hoof::tools
