// What the laboratories say of the paper, and the files they write.
#include "tools/calibrate/findings.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "sim/config/config_error.h"
#include "tests/tools/calibrate/lab_sand.h"
#include "tests/tools/run/scratch_folder.h"
#include "tools/calibrate/single_grain.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

using namespace hoof;
using namespace hoof::tools;

namespace {

const sim::Materials kPaper = lab_materials("", {}, &sim::Materials::sand_abs);

const Reading& reading(const Findings& f, const std::string& part) {
  const auto at = std::find_if(f.readings.begin(), f.readings.end(), [&](const Reading& r) {
    return r.analysis.find(part) != std::string::npos;
  });
  REQUIRE(at != f.readings.end());
  return *at;
}

/// Every target with a band is met, and there are as many.
void check_inside(const Findings& f, int banded) {
  for (const Target& t : f.targets) {
    INFO(t.name << ": " << t.ours);
    CHECK(t.inside());
    banded -= t.has_band() ? 1 : 0;
  }
  CHECK(banded == 0);
}

}  // namespace

TEST_CASE("restitution: table 3 is met without friction; with it the measured L means another e") {
  RestitutionSettings settings;
  settings.check.grains = 10;
  const Findings f = find_restitution(kPaper, settings, {});
  check_inside(f, 2);
  CHECK(reading(f, "its fit").value == Approx(0.5637).margin(1e-4));
  CHECK(reading(f, "L = 2 e H").value == Approx(50.92 / (2 * 40.42)).margin(1e-9));
  CHECK(reading(f, "mu_s = 0").value == Approx(0.564).margin(0.005));
  // 0.61 to 0.62 by an integration of the impact alone, with another friction damping.
  const double e = reading(f, "mu_s = 0.5929").value;
  CHECK(e > 0.605);
  CHECK(e < 0.625);
}

TEST_CASE("rolling: table 5 is met; without spin the same travel means 8 times the friction") {
  RollingSettings settings;
  settings.check.grains = 10;
  const Findings f = find_rolling(kPaper, settings, {});
  check_inside(f, 2);
  CHECK(reading(f, "its fit").value == Approx(0.0404).margin(1e-4));
  // (1 - mu) = 5/7 (1 - mu_r) by hand.
  const double true_mu = reading(f, "with spin").value;
  CHECK(reading(f, "mu_r S1 cos").value == Approx(1 - 5.0 / 7 * (1 - true_mu)).epsilon(1e-6));
  CHECK(reading(f, "grains").value == Approx(true_mu).margin(0.006));  // a quadratic stands between
  // 4 mm / sqrt(12) / sqrt(10) over the slope of 11.5 mm.
  CHECK_THAT(reading(f, "grains").why, Catch::Contains("+- 0.032 of 10 grains"));
}

TEST_CASE("sliding: table 4 is met; the measured tilt means tan of it") {
  SlidingSettings settings;
  settings.grains = 3;
  settings.test.rate_rad_s = 4 * hoof::tests::kDegree;
  const Findings f = find_sliding(kPaper, settings, {});
  check_inside(f, 3);
  CHECK(reading(f, "its fit").value == Approx(0.5930).margin(1e-4));
  CHECK(reading(f, "tan of the tilt").value == Approx(0.5983).margin(1e-4));
  CHECK(reading(f, "at the onset").value == Approx(0.5983).margin(5e-4));
}

TEST_CASE("a laboratory stops when it is told to") {
  int calls = 0;
  CHECK_THROWS_AS(find_rolling(kPaper, {},
                               [&](double share, const std::string&) {
                                 CHECK(share >= 0);
                                 CHECK(share <= 1);
                                 return ++calls < 3;
                               }),
                  LabStopped);
  CHECK(calls == 3);
}

TEST_CASE("bands hold at both sides and not for what is no number") {
  Target t{"x", "mm", {}, -1.0, 2.0, 0, 2};
  for (const auto& [ours, inside] :
       {std::pair(-1.0, true), {2.0, true}, {-1.01, false}, {2.01, false}, {std::nan(""), false}}) {
    t.ours = ours;
    CHECK(t.inside() == inside);
  }
  t.low.reset();
  t.ours = -50;
  CHECK(t.inside());
}

TEST_CASE("findings are written whole, the same bytes again, and say what is outside") {
  const tests::ScratchFolder scratch;
  Findings f;
  f.laboratory = "rolling";
  f.title = "A <title>";
  f.targets = {{"S2", "mm", 36.29, 36.0, 36.5, 40, 2}, {"v", "m/s", {}, {}, {}, std::nan(""), 2}};
  f.readings_of = "mu_r";
  f.readings = {{"balance", std::nan(""), "none & nothing"}};
  f.lines = {{"ours", {{0.1, 35}, {0.2, 36}}, 0, false, true}};
  f.runs = Table({{"mu_r_ratio", 2}});
  f.runs->row({0.1});
  write_findings(f, kPaper, scratch.path() / "deep" / "a");
  write_findings(f, kPaper, scratch.path() / "b");
  for (const char* name : {"result.json", "runs.csv", "report.html"}) {
    const std::string bytes = read_file(scratch.path() / "b" / name);
    CHECK(bytes.size() > 5);
    CHECK(bytes == read_file(scratch.path() / "deep" / "a" / name));
  }
  const auto json = nlohmann::json::parse(read_file(scratch.path() / "b" / "result.json"));
  CHECK(json["targets"][0]["inside"] == false);
  CHECK(json["targets"][1]["inside"].is_null());
  CHECK(json["readings"][0]["value"].is_null());
  const std::string html = read_file(scratch.path() / "b" / "report.html");
  CHECK(html.find("A &lt;title&gt;") != std::string::npos);
  CHECK(html.find("<circle") != std::string::npos);
  CHECK(html.find("OUTSIDE") != std::string::npos);
  CHECK(html.find("http://www.w3.org/2000/svg") != std::string::npos);
  CHECK(html.find("src=\"http") == std::string::npos);
  CHECK(findings_text(f).find("| S2, mm") != std::string::npos);
  write_file(scratch.path() / "file", "");
  CHECK_THROWS_AS(write_findings(f, kPaper, scratch.path() / "file" / "x"), UserError);
}

TEST_CASE("a material's file and flags: flags win in their pair alone, errors name the place") {
  const sim::Materials m = lab_materials("", {0.7, {}, 0.2}, &sim::Materials::sand_sand);
  CHECK(m.sand_sand.restitution.value == 0.7);
  CHECK(m.sand_sand.static_friction.value == 0.52);
  CHECK(m.sand_sand.rolling_friction.value == 0.2);
  CHECK(m.sand_sand.rolling_friction.source == "--mu-r");
  CHECK(m.sand_abs.restitution.value == 0.5636);
  const tests::ScratchFolder scratch;
  const auto file = scratch.path() / "sand.toml";
  std::string text = read_file(std::string(HOOF_SOURCE_DIR) + "/sim/config/materials/paper.toml");
  text.replace(text.find("value = 0.5636"), 14, "value = 1.5636");
  write_file(file, text);
  try {
    lab_materials(file, {}, &sim::Materials::sand_abs);
    FAIL("taken");
  } catch (const sim::ConfigError& error) {
    const std::string what = error.what();
    CHECK_THAT(what, Catch::Contains("sand.toml:") && Catch::Contains("restitution") &&
                         Catch::Contains("1.5636"));
    CHECK(what.find('\n') == std::string::npos);
  }
}
