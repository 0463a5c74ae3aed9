#include "tools/reproduce/reasons.h"

#include <catch2/catch.hpp>

#include "tools/reproduce/paper.h"
#include "tools/reproduce/variation.h"

using namespace hoof::tools;

namespace {

const std::string kSpined = "sinkage-bionic-toe0-40kg-0.1m_s";
const std::string kPlain = "sinkage-bionic-plain-toe0-40kg-0.1m_s";
const std::string kRatio = "sinkage, spined over plain, 40kg, 0.1 m/s";  // 0.80 to 0.95

Outcomes depths(double spined_mm, double plain_mm, const std::vector<int>& beds) {
  Outcomes outcomes;
  for (const int bed : beds) {
    outcomes[kSpined][bed].sinkage_mm = spined_mm;
    outcomes[kPlain][bed].sinkage_mm = plain_mm;
  }
  return outcomes;
}

Outcomes only(const std::string& condition, double mm, const std::vector<int>& beds) {
  Outcomes outcomes;
  for (const int bed : beds) outcomes[condition][bed].sinkage_mm = mm;
  return outcomes;
}

Outcomes but(Outcomes outcomes, const std::string& condition) {
  outcomes.erase(condition);
  return outcomes;
}

Comparison judged(const Outcomes& base, const std::vector<Altered>& changes,
                  const std::string& name = kRatio) {
  std::vector<Comparison> rows = compare_with_paper(base);
  try_changes(rows, changes);
  for (const Comparison& row : rows) {
    CHECK(row.found().find(',') == std::string::npos);  // a CSV takes none within a text
    if (row.name == name) return row;
  }
  throw std::runtime_error("no target " + name);
}

}  // namespace

TEST_CASE("reasons: the change that brings a target inside is named, of its beds alone") {
  Outcomes base = depths(20, 10, {1, 2, 3});  // ratio 2
  base[kSpined][3].sinkage_mm = 80;           // a bed that the change was not run on
  const Altered shorter = altered("geometry", "short-spines", "shorter", base,
                                  only(kSpined, 9, {1, 2}), but(base, kSpined));
  const Altered softer = altered("law", "other-law", "another law", base, depths(15, 10, {1}), {});
  const Comparison row = judged(base, {softer, shorter});
  REQUIRE(row.tried.size() == 2);
  CHECK(row.found() == "inside by geometry (short-spines): 0.9 in place of 2 on 2 beds");
  CHECK_FALSE(row.tried[0].inside);
  CHECK(row.tried[0].with.mean == Approx(1.5));
  CHECK(row.tried[1].with.n == 2);
  CHECK(row.tried[1].without.mean == Approx(2));

  // With the other alone it is said that nothing explains it, and what comes nearest.
  CHECK(judged(base, {softer}).found() ==
        "nothing else was tried than law (other-law): 1.5 in place of 2 on 1 bed");
  CHECK(judged(base, {}).found().empty());
}

TEST_CASE("reasons: a target inside has none, though what changes it is kept") {
  const Outcomes base = depths(9, 10, {1, 2});
  const Comparison row = judged(base, {altered("geometry", "long-spines", "longer", base,
                                               only(kSpined, 20, {1, 2}), but(base, kSpined))});
  CHECK(row.judgement() == Judgement::kInside);
  CHECK(row.found().empty());
  REQUIRE(row.tried.size() == 1);
  CHECK_FALSE(row.tried[0].inside);
}

TEST_CASE("reasons: a bed that was inside by its scatter is no reason") {
  Outcomes base = depths(20, 10, {1, 2, 3});
  base[kSpined][1].sinkage_mm = 8.5;  // inside on bed 1, outside in the mean
  const Comparison row = judged(base, {altered("law", "other-law", "another law", base,
                                               only(kSpined, 9, {1}), but(base, kSpined))});
  CHECK(row.judgement() == Judgement::kOutside);
  CHECK(row.tried.at(0).inside);
  CHECK(row.found() ==
        "nothing else was tried than law (other-law): 0.9 in place of 0.85 on 1 bed");
}

TEST_CASE("reasons: what a change is not of is not tried, nor what was not run with it") {
  const Outcomes base = depths(20, 10, {1, 2});
  // The change is of the spined foot; of the plain one's own depth it says nothing.
  const Altered of_spined = altered("geometry", "short-spines", "shorter", base,
                                    only(kSpined, 9, {1, 2}), but(base, kSpined));
  CHECK(judged(base, {of_spined}, kPlain).tried.empty());
  // A change of both that was run of one foot alone tells no ratio.
  const Altered half =
      altered("law", "other-law", "another law", base, only(kSpined, 9, {1, 2}), {});
  CHECK(judged(base, {half}).tried.empty());
  CHECK(judged(base, {half}, kSpined).tried.size() == 1);
}

TEST_CASE("reasons: depth by the sole needs no run") {
  Outcomes base = depths(20, 10, {1, 2});
  for (const int bed : {1, 2}) {
    base[kSpined][bed].sole_sinkage_mm = 8.7, base[kPlain][bed].sole_sinkage_mm = 10;
  }
  const Comparison row = judged(base, {sole_reading(base)});
  CHECK(row.found() == "inside by reading (sole-depth): 0.87 in place of 2 on 2 beds");
  CHECK(judged(base, {sole_reading(base)}, kPlain).tried.empty());  // no spines: one depth
  base[kSpined][1].sole_sinkage_mm = -0.9;                          // hangs above the sand
  CHECK(read_by_sole(base)[kSpined][1].sinkage_mm == 0);
  CHECK(read_by_sole(base)[kSpined][2].sinkage_mm == 8.7);
}

TEST_CASE("reasons: a change and the reading by the sole together, where neither alone explains") {
  const auto with_soles = [](Outcomes outcomes, double spined_mm, double plain_mm) {
    for (auto& [bed, run] : outcomes[kSpined]) run.sole_sinkage_mm = spined_mm;
    for (auto& [bed, run] : outcomes[kPlain]) run.sole_sinkage_mm = plain_mm;
    return outcomes;
  };
  const Outcomes base = with_soles(depths(20, 10, {1, 2}), 2, 10);  // 2, by the sole 0.2
  const Outcomes loose = with_soles(depths(30, 20, {1, 2}), 18, 20);
  const Altered change = altered("packing", "loose-sand", "loose", base, loose, {});
  const Comparison row = judged(base, {sole_reading(base), change, with_sole_reading(change)});
  REQUIRE(row.tried.size() == 3);
  CHECK(row.found() ==
        "inside by packing and reading (loose-sand + sole-depth): 0.9 in place of 2 on 2 beds");
  // Where the change alone does it, the two together say nothing more.
  const Outcomes looser = with_soles(depths(18, 20, {1, 2}), 17, 20);
  const Altered enough = altered("packing", "looser-sand", "looser", base, looser, {});
  CHECK(judged(base, {sole_reading(base), enough, with_sole_reading(enough)}).found() ==
        "inside by packing (looser-sand): 0.9 in place of 2 on 2 beds");
  // A change of other runs on one of the beds is none of these, however they are read.
  const Altered pull = altered("path", "other-path", "of a traction", base,
                               {{"traction-bionic-toe0-1.12Hz", {{1, {}}}}}, base);
  const Comparison alone = judged(base, {sole_reading(base), pull, with_sole_reading(pull)});
  REQUIRE(alone.tried.size() == 1);
  CHECK(alone.tried[0].name == kSoleReading);
  // Without spines both are the change alone.
  const Comparison plain =
      judged(base, {sole_reading(base), change, with_sole_reading(change)}, kPlain);
  REQUIRE(plain.tried.size() == 1);
  CHECK(plain.tried[0].name == "loose-sand");
}

TEST_CASE("reasons: of a variation the base counts where it changes nothing") {
  const Outcomes base = depths(20, 10, {1});
  for (const Variation& v : all_variations({})) {
    INFO(v.name);
    const Outcomes same = unchanged(base, v);
    CHECK(same.count(kSpined) == (v.kind == "path" ? 1 : 0));
    const bool of_spines = v.name == "short-spines" || v.name == "long-spines";
    CHECK(same.count(kPlain) == (v.kind == "path" || of_spines ? 1 : 0));
  }
}
