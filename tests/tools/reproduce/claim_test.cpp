#include "tools/reproduce/claim.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "tools/calibrate/paper_tables.h"
#include "tools/experiment/run_settings.h"
#include "tools/reproduce/cell.h"
#include "tools/reproduce/claims_report.h"
#include "tools/reproduce/ground.h"
#include "tools/reproduce/paper.h"
#include "tools/reproduce/run_store.h"
#include "tools/reproduce/variation.h"

using namespace hoof::tools;

namespace {

const Claim& claim(const std::string& name) {
  for (const Claim& c : paper_claims()) {
    if (c.name == name) return c;
  }
  throw std::runtime_error("no claim " + name);
}

/// Sinkages at 60 kg, 0.1 m/s by opening, the same on every bed but for each bed's own factor and
/// some scatter.
Outcomes openings(const std::vector<double>& mm, double scatter, unsigned seed = 1, int beds = 5) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, scatter);
  Outcomes outcomes;
  for (int bed = 1; bed <= beds; ++bed) {
    const double softness = 0.5 + 0.4 * bed;
    for (int i = 0; i < 5; ++i) {
      const std::string condition = "sinkage-bionic-toe" + std::to_string(10 * i) + "-60kg-0.1m_s";
      outcomes[condition][bed].sinkage_mm = softness * mm[std::size_t(i)] * (1 + noise(random));
    }
  }
  return outcomes;
}

}  // namespace

TEST_CASE("claims: thirty degrees is first, names are unique, every condition is a cell") {
  CHECK(paper_claims().front().name == "30-best");
  std::set<std::string> names;
  for (const Claim& c : paper_claims()) {
    CHECK(names.insert(c.name).second);
    CHECK_FALSE(c.contrasts.empty());
    for (const Contrast& contrast : c.contrasts) {
      INFO(contrast.name);
      for (const std::string& condition : contrast.conditions) {
        CHECK(cell_of(condition).condition() == condition);
      }
      // The paper's own numbers lie on the side that it claims.
      if (!std::isfinite(contrast.paper)) continue;
      CHECK((contrast.below ? contrast.paper < contrast.bound : contrast.paper > contrast.bound));
    }
  }
  CHECK_THROWS_AS(cell_of("sinkage-bionic-toe30-10kg"), std::invalid_argument);
  CHECK_THROWS_AS(cell_of("sinkage-bionic-toe030-10kg-0.1m_s"), std::invalid_argument);
}

TEST_CASE("a claim holds where each interval excludes the bound, paired on the bed") {
  const Claim& best = claim("30-best");
  const std::vector<double> paper = {13.0, 11.73, 11.5, 11.0, 11.65};
  CHECK(find(best, openings(paper, 0.002)) == Finding::kHolds);
  // Beds that differ fourfold do not matter: each run is compared on its own bed.
  CHECK(weigh(best.contrasts[0], openings(paper, 0))->mean() == Approx(11.0 / 13.0));
  CHECK(weigh(best.contrasts[0], openings(paper, 0))->sample.confidence == Approx(0).margin(1e-9));
  // Effect the other way, effect lost in scatter, one better opening of four.
  CHECK(find(best, openings({11, 12, 12, 13, 12}, 0.002)) == Finding::kFails);
  CHECK(find(best, openings(paper, 0.5)) == Finding::kFails);
  CHECK(find(best, openings({13.0, 11.73, 10.5, 11.0, 11.65}, 0.002)) == Finding::kFails);
  // Not all openings, or one bed: nothing is said, unless what is there fails already.
  Outcomes some = openings(paper, 0.002);
  some.erase("sinkage-bionic-toe20-60kg-0.1m_s");
  CHECK(find(best, some) == Finding::kNotRun);
  CHECK(find(best, openings(paper, 0.002, 1, 1)) == Finding::kNotRun);
  some = openings({11, 12, 12, 13, 12}, 0.002);
  some.erase("sinkage-bionic-toe20-60kg-0.1m_s");
  CHECK(find(best, some) == Finding::kFails);
  CHECK(find(best, {}) == Finding::kNotRun);
}

TEST_CASE(
    "claims of the sand: pressure and arch by what runs kept, nothing by runs that kept none") {
  Outcomes outcomes = openings({13.0, 11.73, 11.5, 11.0, 11.65}, 0.002);
  CHECK(find(claim("pressure-falls"), outcomes) == Finding::kNotRun);
  CHECK(find(claim("arch-at-30"), outcomes) == Finding::kNotRun);
  const auto set = [&](int deg, double share, double area, double gap) {
    for (auto& [bed, run] :
         outcomes.at("sinkage-bionic-toe" + std::to_string(deg) + "-60kg-0.1m_s")) {
      run.high_pressure_share = share, run.support_area_ratio = area + 0.001 * bed;
      run.gap_stress_ratio = gap + 0.001 * bed;
    }
  };
  set(0, 0.32, 0.5, Outcome::kNone), set(20, 0.3, 0.5, 0.2), set(30, 0.24, 0.6, 0.3);
  set(40, 0.3, 0.5, 0.1);
  CHECK(find(claim("pressure-falls"), outcomes) == Finding::kHolds);
  CHECK(find(claim("arch-at-30"), outcomes) == Finding::kHolds);
  set(40, 0.3, 0.5, 0.4);  // it carries more at 40 degrees
  CHECK(find(claim("arch-at-30"), outcomes) == Finding::kFails);
  set(40, 0.3, 0.5, 0.1), set(30, 0.33, 0.45, 0.3);  // less sand carries, more pressure is high
  CHECK(find(claim("arch-at-30"), outcomes) == Finding::kFails);
  CHECK(find(claim("pressure-falls"), outcomes) == Finding::kFails);
}

TEST_CASE("claims upward and by a bound that is not one") {
  const Claim& raise = claim("spines-raise-T");
  Outcomes outcomes;
  for (int bed = 1; bed <= 5; ++bed) {
    for (const std::string step : {"0.45Hz", "1.12Hz"}) {
      outcomes["traction-bionic-toe0-" + step][bed].coefficient = 0.6 + 0.01 * bed;
      outcomes["traction-bionic-plain-toe0-" + step][bed].coefficient = 0.4 + 0.005 * bed;
      for (const int deg : {10, 20, 30, 40}) {
        outcomes["traction-bionic-toe" + std::to_string(deg) + "-" + step][bed].coefficient =
            (0.6 + 0.01 * bed) * (1 + 0.002 * deg);
      }
    }
  }
  CHECK(find(raise, outcomes) == Finding::kHolds);
  // 1 to 1.08 by a mean of 1.04: 7.7 %.
  CHECK(weigh(claim("T-flat").contrasts[0], outcomes)->mean() == Approx(0.08 / 1.04));
  CHECK(find(claim("T-flat"), outcomes) == Finding::kHolds);
  CHECK(find(claim("T-best-at-40"), outcomes) == Finding::kHolds);
  for (auto& [bed, run] : outcomes["traction-bionic-toe40-1.12Hz"]) run.coefficient *= 1.05;
  CHECK(find(claim("T-flat"), outcomes) == Finding::kFails);
  for (auto& [bed, run] : outcomes["traction-bionic-toe0-0.45Hz"]) run.coefficient = 0.3;
  CHECK(find(raise, outcomes) == Finding::kFails);
}

TEST_CASE(
    "ratios count by their logarithms: turned round they say the same, and stay above nothing") {
  const Contrast& below = claim("30-best").contrasts[0];
  Contrast above = below;
  std::swap(above.conditions[0], above.conditions[1]);
  above.below = false;
  Outcomes outcomes = openings({10, 12, 12, 8, 12}, 0.3);
  const auto one = weigh(below, outcomes), other = weigh(above, outcomes);
  CHECK(one->low() > 0);
  CHECK(one->mean() == Approx(1 / other->mean()));
  CHECK(one->low() == Approx(1 / other->high()));
  CHECK(one->margin(below) == Approx(other->margin(above)));
  CHECK(holds(below, *one) == holds(above, *other));
  // 0.5, 1, 2: the middle is 1, and t of two degrees of freedom times ln 2 / sqrt 3.
  Outcomes three;
  for (const auto& [bed, mm] : std::map<int, double>{{1, 5}, {2, 10}, {3, 20}}) {
    three[below.conditions[0]][bed].sinkage_mm = mm;
    three[below.conditions[1]][bed].sinkage_mm = 10;
  }
  CHECK(weigh(below, three)->mean() == Approx(1));
  CHECK(weigh(below, three)->high() == Approx(std::exp(4.303 * std::log(2.0) / std::sqrt(3.0))));
  // A depth of nothing has no logarithm.
  three[below.conditions[0]][1].sinkage_mm = 0;
  CHECK_FALSE(weigh(below, three)->logarithms);
  CHECK(weigh(below, three)->mean() == Approx(1));
  // Something over nothing is no evidence that it is less, and does not vanish either.
  three[below.conditions[0]][1].sinkage_mm = 0.1, three[below.conditions[0]][2].sinkage_mm = 0.1;
  CHECK(holds(below, *weigh(below, three)) == false);  // 20 over 10
  three[below.conditions[0]][3].sinkage_mm = 0.1;
  CHECK(holds(below, *weigh(below, three)));
  three[below.conditions[1]][2].sinkage_mm = 0;
  CHECK(weigh(below, three)->infinite == 1);
  CHECK(weigh(below, three)->beds == std::vector<int>{1, 3});
  CHECK_FALSE(holds(below, *weigh(below, three)));
  // Nothing over nothing says nothing.
  three[below.conditions[0]][2].sinkage_mm = 0;
  CHECK(weigh(below, three)->infinite == 0);
  CHECK(holds(below, *weigh(below, three)));
}

TEST_CASE("the interval misses a true null in one of twenty") {
  // Two openings that are alike: the claim that one sinks less must hold in 2.5 % of the campaigns.
  const Contrast& contrast = claim("30-best").contrasts[0];
  int held = 0;
  constexpr int kCampaigns = 4000;
  for (int seed = 0; seed < kCampaigns; ++seed) {
    const auto evidence = weigh(contrast, openings({12, 12, 12, 12, 12}, 0.03, unsigned(seed)));
    held += holds(contrast, *evidence) ? 1 : 0;
  }
  // Four standard deviations of a count of 100.
  CHECK(held > 60);
  CHECK(held < 140);
}

TEST_CASE("verdicts") {
  using F = Finding;
  struct Row {
    F base;
    std::vector<F> varied;
    Verdict verdict;
  };
  const Row rows[] = {{F::kHolds, {F::kHolds, F::kHolds}, Verdict::kSupported},
                      {F::kHolds, {F::kHolds, F::kFails}, Verdict::kFragile},
                      {F::kHolds, {F::kNotRun, F::kFails}, Verdict::kFragile},
                      {F::kHolds, {F::kHolds, F::kNotRun}, Verdict::kOpen},
                      {F::kHolds, {}, Verdict::kOpen},
                      {F::kFails, {F::kHolds}, Verdict::kUnsupported},
                      {F::kFails, {}, Verdict::kUnsupported},
                      {F::kNotRun, {F::kHolds}, Verdict::kOpen},
                      {F::kNotRun, {F::kFails}, Verdict::kOpen}};
  for (const Row& row : rows) CHECK(judge(row.base, row.varied) == row.verdict);
}

TEST_CASE("variations: of geometry, grain size and valley, and what claims are not judged over") {
  std::set<std::string> hashes, names;
  const std::vector<std::string> bases = {"sinkage-bionic-toe30-60kg-0.1m_s",
                                          "traction-bionic-toe0-0.45Hz"};
  for (const std::string& condition : bases) {
    const Cell cell = cell_of(condition);
    hashes.insert(settings_hash(read_run_settings(cell.kind(), cell.overrides()).tree));
  }
  const auto variations = all_variations({});
  for (const Variation& v : variations) {
    INFO(v.name);
    CHECK(names.insert(v.name).second);
    bool changes_one = false;
    for (const std::string condition :
         {"sinkage-bionic-toe30-60kg-0.1m_s", "traction-bionic-toe0-0.45Hz",
          "traction-bionic-plain-toe0-0.45Hz", "traction-traditional-1.12Hz"}) {
      const Cell cell = varied(cell_of(condition), v);
      const RunSettings run = read_run_settings(cell.kind(), cell.overrides());  // is a run
      // Without a change it is the base's run and shares its folder.
      CHECK(cell.changes.empty() == cell.variation.empty());
      CHECK((cell.id() == cell_of(condition).id()) == cell.changes.empty());
      const bool base = std::count(bases.begin(), bases.end(), condition) == 1;
      if (base && !cell.changes.empty()) CHECK(hashes.insert(settings_hash(run.tree)).second);
      changes_one = changes_one || !cell.changes.empty();
    }
    CHECK(changes_one);
  }
  const auto judged = claim_variations({});
  CHECK(judged.size() == claim_variation_names().size());
  for (std::size_t i = 0; i < judged.size(); ++i) {
    CHECK(judged[i].name == claim_variation_names()[i]);
    CHECK(judged[i].name == variations[i].name);
  }
  CHECK(std::vector<std::string>(names.begin(), names.end()) == [] {
    auto all = variation_names();
    std::sort(all.begin(), all.end());
    return all;
  }());
  CHECK(varied(cell_of("traction-traditional-1.12Hz"), variations[0]).changes.empty());
  CHECK_FALSE(varied(cell_of("traction-traditional-1.12Hz"), variations[2]).changes.empty());
  for (const char* bed : {"demo", "medium", "bench", "paper"}) {
    const CampaignSettings settings = Ground{bed, "dem"}.settings();
    for (const std::string kind : {"sinkage", "traction"}) {
      const auto plain = read_run_settings(kind, settings.of(kind)).bed;
      for (const Variation& v : all_variations(settings)) {
        INFO(bed << " " << kind << " " << v.name);
        std::vector<std::string> all = settings.of(kind);
        all.insert(all.end(), v.of_all.begin(), v.of_all.end());
        const auto& own = kind == "sinkage" ? v.of_sinkage : v.of_traction;
        all.insert(all.end(), own.begin(), own.end());
        const RunSettings run = read_run_settings(kind, all);
        const auto& changed = run.bed;
        // A step of no larger share of the smallest grain's Rayleigh time, which goes with its
        // size.
        CHECK(changed.step_s() / changed.grain_scale <= plain.step_s() / plain.grain_scale * 1.001);
        CHECK(changed.settling_step_s() / changed.grain_scale <=
              plain.settling_step_s() / plain.grain_scale * 1.001);
        // A whole number of steps between two exchanges with the foot.
        const double steps = run.coupling.exchange_s / changed.step_s();
        CHECK(steps == Approx(std::round(steps)).epsilon(1e-12));
        // Of what this kind stands on, not of the other's.
        const double times = changed.grain_scale / plain.grain_scale;
        CHECK(times == Approx(v.name == "fine-grains"     ? 0.8
                              : v.name == "coarse-grains" ? 1.25
                                                          : 1));
        CHECK(changed.depth_m / plain.depth_m == Approx(v.name == "deep-bed" ? 2 : 1));
      }
    }
  }
}

TEST_CASE("a reading by which a claim is otherwise is told below the table, and counts nowhere") {
  const Claim one{"one",
                  "a is less than b",
                  {{"a over b", {"a", "b"}, [](const std::vector<Outcome>&) { return 0.0; }}}};
  const auto under = [](const std::string& name, const std::string& kind, double mean,
                        Finding finding) {
    ClaimUnder u;
    u.variation = name, u.kind = kind, u.finding = finding;
    u.evidence = {Evidence{sample_of({mean, mean}), false, {1, 2}}};
    u.runs = {{}};
    return u;
  };
  JudgedClaim judged{&one, Verdict::kUnsupported, {}};
  judged.under = {under("base", "", 2, Finding::kFails),
                  under("long-spines", "geometry", 3, Finding::kFails),
                  under("sole-depth", "reading", 0.5, Finding::kHolds)};
  CHECK_THAT(claims_text({judged}), Catch::Contains("| -         | long-spines | -       |") &&
                                        Catch::Contains("Otherwise by the depth of the sole:\n"
                                                        "  one holds: a over b is 0.5 (0.5 to "
                                                        "0.5)\n"));
  judged.under.back() = under("sole-depth", "reading", 1.5, Finding::kFails);
  CHECK_THAT(claims_text({judged}), !Catch::Contains("Otherwise by"));
}

TEST_CASE("the weakest contrast is told: by interval, of one bed only where there is no other") {
  const auto contrast = [](const char* name) {
    return Contrast{name, {"a", "b"}, [](const std::vector<Outcome>&) { return 0.0; }};
  };
  const Claim two{"two", "less", {contrast("first"), contrast("second"), contrast("third")}};
  const auto evidence = [](const std::vector<double>& values) {
    std::vector<int> beds;
    for (std::size_t i = 0; i < values.size(); ++i) beds.push_back(int(i) + 1);
    return Evidence{sample_of(values), false, beds};
  };
  ClaimUnder base;
  base.variation = "base", base.runs = {{}, {}, {}};
  JudgedClaim judged{&two, Verdict::kUnsupported, {}};
  base.evidence = {evidence({0.5, 0.6}), evidence({1.5, 1.6}), evidence({9})};
  judged.under = {base};
  CHECK_THAT(claims_text({judged}), Catch::Contains("| two   | unsupported | second "));
  judged.under[0].evidence = {evidence({0.5}), evidence({1.5}), evidence({0.9})};
  CHECK_THAT(claims_text({judged}), Catch::Contains("| two   | unsupported | second "));
  judged.under[0].evidence = {evidence({0.5}), {}, evidence({0.9})};
  CHECK_THAT(claims_text({judged}), Catch::Contains("| two   | unsupported | third "));
  judged.under[0].evidence = {evidence({0.5, 0.6}), evidence({1.5, 1.6}), evidence({0.2, 0.3})};
  judged.under[0].evidence[2]->infinite = 1;
  CHECK_THAT(claims_text({judged}),
             Catch::Contains("| third ") && Catch::Contains("over nothing on 1 more beds"));
}

TEST_CASE("the valley's points have the paper's angle of repose, and are far from each other") {
  for (const ValleyPoint& p : valley_points()) {
    CHECK(paper_repose_fit_deg(p.restitution, p.rolling_friction, p.static_friction) ==
          Approx(kPaperReposeMeasured_deg).margin(0.45));  // the fit's own doubt there
    for (const ValleyPoint& q : valley_points()) {
      if (&p == &q) continue;
      CHECK(std::abs(p.restitution - q.restitution) +
                std::abs(p.static_friction - q.static_friction) >
            0.25);
    }
  }
}
