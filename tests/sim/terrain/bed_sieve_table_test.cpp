#include "sim/terrain/bed_sieve_table.h"

#include <catch2/catch.hpp>

#include "sim/config/config_error.h"
#include "sim/config/settings.h"
#include "tests/sim/terrain/temporary_folder.h"

using namespace hoof::sim;
using namespace hoof::sim::test;

namespace {

std::vector<SieveClass> read(const std::string& text, const SieveSelection& selection = {}) {
  const TemporaryFolder folder("sieve");
  write_bytes(folder.path() / "table.csv", text);
  return read_sieve_table(folder.path() / "table.csv", selection);
}

/// What is wrong, without the folder.
std::string refusal(const std::string& text, const SieveSelection& selection = {}) {
  try {
    read(text, selection);
  } catch (const ConfigError& error) {
    const std::string what = error.what();
    return what.substr(what.find("table.csv"));
  }
  return "accepted";
}

}  // namespace

TEST_CASE("what passes and what is retained say the same") {
  const std::string passing =
      "# a sample\n\naperture_mm,passing_percent\r\n1,10\r\n2,40\r\n 4 , 100 \r\n";
  const std::string retained = "aperture_mm,retained_percent\n0,10\n1,30\n2,60\n4,0\n";
  SieveSelection from_1_mm;
  from_1_mm.from_m = 1e-3;
  for (const auto& classes : {read(passing), read(retained, from_1_mm)}) {
    REQUIRE(classes.size() == 2);
    CHECK(classes[0].low_m == Approx(1e-3));
    CHECK(classes[0].high_m == Approx(2e-3));
    CHECK(classes[0].mass_share == Approx(30.0 / 90));
    CHECK(classes[1].low_m == Approx(2e-3));
    CHECK(classes[1].high_m == Approx(4e-3));
    CHECK(classes[1].mass_share == Approx(60.0 / 90));
  }
}

TEST_CASE("a range within classes takes its part of them, and a scale enlarges what is left") {
  const SieveSelection selection{1.5e-3, 3e-3, 2};
  const auto classes = read("aperture_mm,passing_percent\n1,0\n2,40\n4,100\n", selection);
  REQUIRE(classes.size() == 2);
  CHECK(classes[0].low_m == Approx(3e-3));
  CHECK(classes[0].high_m == Approx(4e-3));
  CHECK(classes[0].mass_share == Approx(20.0 / 50));
  CHECK(classes[1].high_m == Approx(6e-3));
  CHECK(classes[1].mass_share == Approx(30.0 / 50));
}

TEST_CASE("classes without mass are left out") {
  const auto classes = read("aperture_mm,passing_percent\n1,0\n2,50\n3,50\n4,100\n");
  REQUIRE(classes.size() == 2);
  CHECK(classes[1].low_m == Approx(3e-3));
}

TEST_CASE("the shipped table of the paper gives the grading of the shipped beds") {
  const SieveSelection as_paper{0.5e-3, 1.6e-3, 4};
  const auto classes =
      read_sieve_table(default_config_dir() / "beds" / "paper-sieve.csv", as_paper);
  REQUIRE(classes.size() == 2);
  CHECK(classes[0].low_m == Approx(2e-3));
  CHECK(classes[0].high_m == Approx(4e-3));
  CHECK(classes[1].high_m == Approx(6.4e-3));
  // Table 1: 39.03 % and 28.45 % of the mass; the beds state four digits.
  CHECK(classes[0].mass_share == Approx(39.03 / 67.48).epsilon(1e-12));
  CHECK(classes[0].mass_share == Approx(0.5784).margin(5e-5));
  CHECK(classes[1].mass_share == Approx(0.4216).margin(5e-5));
}

TEST_CASE("a wrong table is refused in one line with file, line, column, value and bound") {
  const std::string passing = "aperture_mm,passing_percent\n";
  const std::string retained = "aperture_mm,retained_percent\n";
  struct Case {
    std::string text, message;
  };
  const Case cases[] = {
      {"", "table.csv:1: '': must be aperture_mm,passing_percent or aperture_mm,retained_percent"},
      {"size,share\n",
       "table.csv:1: 'size,share': must be aperture_mm,passing_percent or "
       "aperture_mm,retained_percent"},
      {passing + "1,10\n", "table.csv: has 1 sieves, must have at least 2"},
      {passing + "1;10\n", "table.csv:2: '1;10': must be two numbers with a comma between them"},
      {passing + "1,ten\n", "table.csv:2: '1,ten': must be two numbers with a comma between them"},
      {passing + "-1,10\n2,100\n",
       "table.csv:2: aperture_mm = -1.0: must be a number from 0 to 100"},
      {passing + "1,10\n\n2,101\n",
       "table.csv:4: passing_percent = 101.0: must be a number from 0 to 100"},
      {passing + "2,10\n2,100\n",
       "table.csv:3: aperture_mm = 2.0: must be above that of the row before, 2.0"},
      {passing + "1,10\n2,5\n4,100\n",
       "table.csv:3: passing_percent = 5.0: must not be under that of the row before, 10.0"},
      {passing + "1,10\n2,99.9\n",
       "table.csv:3: passing_percent = 99.9: must be 100 for the widest sieve"},
      {retained + "0,10\n1,89\n2,0\n",
       "table.csv: retained_percent adds up to 99.0, must be 100 within 0.05"},
      {retained + "0,10\n1,85\n2,5\n",
       "table.csv:4: retained_percent = 5.0: must be 0 for the widest sieve: nobody knows how "
       "large its grains are"},
      {retained + "0,10\n1,90\n2,0\n",
       "table.csv: the range 0.0 to 2.0 mm must begin above 0: such grains are dust"},
  };
  for (const Case& c : cases) CHECK(refusal(c.text) == c.message);

  const std::string good = passing + "1,10\n2,100\n";
  CHECK(refusal(good, {0.5e-3, {}, 1}) ==
        "table.csv: the range 0.5 to 2.0 mm must lie within its sieves, 1.0 to 2.0 mm");
  CHECK(refusal(good, {{}, 3e-3, 1}) ==
        "table.csv: the range 1.0 to 3.0 mm must lie within its sieves, 1.0 to 2.0 mm");
  CHECK_THAT(refusal(good, {2e-3, 1e-3, 1}), Catch::Contains("must lie within its sieves"));
  CHECK(refusal(passing + "1,10\n2,10\n4,100\n", {1e-3, 2e-3, 1}) ==
        "table.csv: no mass in the range 1.0 to 2.0 mm");
  CHECK_THROWS_WITH(read_sieve_table("/nowhere.csv", {}),
                    "/nowhere.csv: cannot read: No such file or directory");
}
