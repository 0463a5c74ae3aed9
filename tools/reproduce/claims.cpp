#include "tools/reproduce/claims.h"

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <set>
#include <thread>

#include "tools/reproduce/claims_report.h"
#include "tools/reproduce/cost.h"
#include "tools/reproduce/reasons.h"
#include "tools/run/errors.h"

namespace hoof::tools {
namespace fs = std::filesystem;
namespace {

template <class Named>
std::vector<const Named*> chosen(const std::vector<Named>& all,
                                 const std::vector<std::string>& names) {
  std::vector<const Named*> some;
  for (const Named& one : all) {
    const bool wanted =
        names.empty() || std::find(names.begin(), names.end(), one.name) != names.end();
    if (wanted) some.push_back(&one);
  }
  return some;
}

class Inquiry {
 public:
  explicit Inquiry(const ClaimsOptions& options)
      : options_(options), settings_(options.ground.settings()) {
    settings_.asked = options.settings;
    variations_ = claim_variations(settings_);
    claims_ = chosen(paper_claims(), options.names);
    used_ = chosen(variations_, options.variations);
  }

  void go() {
    const fs::path out = options_.out.empty() ? options_.ground.folder() : options_.out;
    Campaign campaign(out, cells(), settings_);
    if (options_.plan_only) {
      plan(campaign);
      return;
    }
    CampaignEnd end;
    if (!options_.no_runs) {
      end = campaign.run(options_.engine, [&] { write_claims(out, judged(campaign), used_); });
    }
    const std::vector<JudgedClaim> claims = judged(campaign);
    write_claims(out, claims, used_);
    std::cout << claims_text(claims);
    if (end.queued > 0) {
      std::cout << end.queued << " runs are in the cluster's queue or under way\n";
    }
    std::cout << (out / "claims.html").string() << std::endl;
    if (!end.failed.empty()) {
      throw CannotFinish(std::to_string(end.failed.size()) +
                         " runs could not be finished, the first: " + end.failed.front());
    }
  }

 private:
  /// First all of the base, then variation after variation, each bed after bed.
  std::vector<Cell> cells() const {
    std::vector<Cell> all;
    std::set<std::string> there;
    const auto add = [&](const Variation* variation) {
      for (int bed = options_.first_bed; bed < options_.first_bed + options_.beds; ++bed) {
        for (const Claim* claim : claims_) {
          for (const Contrast& contrast : claim->contrasts) {
            for (const std::string& condition : contrast.conditions) {
              Cell cell = cell_under(condition, variation, bed);
              if (there.insert(cell.id()).second) all.push_back(cell);
            }
          }
        }
      }
    };
    add(nullptr);
    for (const Variation* variation : used_) add(variation);
    return all;
  }

  static Cell cell_under(const std::string& condition, const Variation* variation, int bed) {
    Cell cell = cell_of(condition);
    cell.bed = bed;
    return variation == nullptr ? cell : varied(cell, *variation);
  }

  /// Outcomes under a variation; where it changes nothing of a condition, those of the base.
  static Outcomes outcomes(const Campaign& campaign, const Outcomes& base,
                           const Variation* variation) {
    if (variation == nullptr) return base;
    Outcomes all = campaign.outcomes(variation->name);
    all.merge(unchanged(base, *variation));
    return all;
  }

  std::vector<JudgedClaim> judged(const Campaign& campaign) const {
    const Outcomes base = campaign.outcomes();
    std::vector<const Variation*> all = {nullptr};
    all.insert(all.end(), used_.begin(), used_.end());
    std::vector<JudgedClaim> judged;
    for (const Claim* claim : claims_) judged.push_back({claim, Verdict::kOpen, {}});
    for (const Variation* variation : all) {
      const Outcomes under = outcomes(campaign, base, variation);
      for (JudgedClaim& j : judged) {
        if (variation == nullptr || changes_any(*j.claim, *variation)) {
          j.under.push_back(weigh_all(*j.claim, under, variation));
        }
      }
    }
    const Outcomes by_sole = read_by_sole(base);
    for (JudgedClaim& j : judged) {
      std::vector<Finding> findings;
      for (std::size_t i = 1; i < j.under.size(); ++i) findings.push_back(j.under[i].finding);
      j.verdict = judge(j.under.front().finding, findings);
      // Supported is said of all that the paper leaves open, not of a part.
      const bool part = used_.size() < variations_.size();
      if (part && j.verdict == Verdict::kSupported) j.verdict = Verdict::kOpen;
      ClaimUnder reading = weigh_all(*j.claim, by_sole, nullptr);
      reading.variation = kSoleReading, reading.kind = "reading";
      if (differs(reading, j.under.front())) j.under.push_back(std::move(reading));
    }
    return judged;
  }

  static bool differs(const ClaimUnder& a, const ClaimUnder& b) {
    for (std::size_t i = 0; i < a.evidence.size(); ++i) {
      const auto &of_a = a.evidence[i], &of_b = b.evidence[i];
      if (of_a && of_b && of_a->mean() != of_b->mean()) return true;
    }
    return false;
  }

  static bool changes(const Contrast& contrast, const Variation& variation) {
    return std::any_of(contrast.conditions.begin(), contrast.conditions.end(),
                       [&](const std::string& condition) {
                         return !varied(cell_of(condition), variation).variation.empty();
                       });
  }

  static bool changes_any(const Claim& claim, const Variation& variation) {
    return std::any_of(claim.contrasts.begin(), claim.contrasts.end(),
                       [&](const Contrast& contrast) { return changes(contrast, variation); });
  }

  static ClaimUnder weigh_all(const Claim& claim, const Outcomes& outcomes,
                              const Variation* variation) {
    ClaimUnder under;
    under.variation = variation == nullptr ? "base" : variation->name;
    under.kind = variation == nullptr ? "" : variation->kind;
    // What a variation changes nothing of says nothing of it.
    Claim changed = claim;
    if (variation != nullptr) {
      std::erase_if(changed.contrasts, [&](const Contrast& c) { return !changes(c, *variation); });
    }
    under.finding = find(changed, outcomes);
    for (const Contrast& contrast : claim.contrasts) {
      std::vector<std::string> runs;
      if (variation != nullptr && !changes(contrast, *variation)) {
        under.evidence.push_back({}), under.runs.push_back(runs);
        continue;
      }
      under.evidence.push_back(weigh(contrast, outcomes));
      if (under.evidence.back()) {
        for (const int bed : under.evidence.back()->beds) {
          for (const std::string& condition : contrast.conditions) {
            runs.push_back(cell_under(condition, variation, bed).id());
          }
        }
      }
      under.runs.push_back(runs);
    }
    return under;
  }

  void plan(const Campaign& campaign) const {
    std::vector<PlannedRun> all, missing;
    for (const Cell& cell : campaign.cells()) {
      const bool there = campaign.done(cell);
      all.push_back(campaign.planned(cell));
      if (!there) missing.push_back(all.back());
      std::printf("%-8s %s\n", there ? "done" : "missing", cell.id().c_str());
    }
    for (const Variation* v : used_) {
      std::printf("%s (%s): %s\n", v->name.c_str(), v->kind.c_str(), v->what.c_str());
    }
    std::printf("%zu runs, %zu done\n", all.size(), all.size() - missing.size());
    const int cores = int(std::max(1U, std::thread::hardware_concurrency()));
    std::fputs(cost_text(CostModel(campaign.store(), all), missing,
                         options_.engine.jobs_at_once(cores), options_.engine.threads_each(cores))
                   .c_str(),
               stdout);
  }

  const ClaimsOptions& options_;
  CampaignSettings settings_;
  std::vector<Variation> variations_;
  std::vector<const Claim*> claims_;
  std::vector<const Variation*> used_;
};

}  // namespace

void list_claims() {
  for (const Claim& claim : paper_claims()) {
    std::printf("%-18s %s\n", claim.name.c_str(), claim.statement.c_str());
  }
  const std::size_t judged = claim_variations({}).size();
  std::size_t n = 0;
  for (const Variation& v : all_variations({})) {
    if (n == 0) std::printf("variations that claims are judged over (of the bed demo):\n");
    if (n == judged) std::printf("more, of hoof reproduce --vary:\n");
    std::printf("%-18s %s: %s\n", v.name.c_str(), v.kind.c_str(), v.what.c_str());
    ++n;
  }
}

void judge_claims(const ClaimsOptions& options) {
  Inquiry(options).go();
}

}  // namespace hoof::tools
