#include "sim/config/reader.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "sim/config/config_error.h"

using namespace hoof::sim;

namespace {

struct Block {
  double width_m = -1.0;
  double angle_rad = -1.0;
  int count = -1;
  bool hard = false;
  std::string kind;
  std::vector<double> sizes_m;
  Measured friction;
};

Block read_block(const std::string& toml) {
  const Settings settings = Settings::parse(toml, "f.toml");
  Reader root(settings);
  Reader r = root.section("block");
  Block block;
  r.number("width_mm", block.width_m, kMillimetre, 1.0, 200.0);
  r.number("angle_deg", block.angle_rad, kDegree, -10.0, 45.0);
  r.integer("count", block.count, 0, 9);
  r.flag("hard", block.hard);
  r.choice("kind", block.kind, {"round", "square"});
  r.numbers("sizes_mm", block.sizes_m, kMillimetre, 0.0, 10.0);
  r.measured("friction", block.friction, kUnitless, 0.0, 2.0);
  root.finish();
  return block;
}

/// The full text with one line replaced, to break one thing at a time.
std::string text_with(const std::string& from = "", const std::string& to = "") {
  std::string text =
      "[block]\nwidth_mm = 175\nangle_deg = -9\ncount = 3\nhard = true\nkind = \"round\"\n"
      "sizes_mm = [1, 2.5]\nfriction = { value = 0.5, sigma = 0.1, source = \"bench\" }\n";
  if (!from.empty()) text.replace(text.find(from), from.size(), to);
  return text;
}

std::string error_of(const std::string& toml) {
  try {
    read_block(toml);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("each type is read and converted once to SI") {
  const Block block = read_block(text_with());
  CHECK(block.width_m == 0.175);  // exactly: a ratio, not a rounded factor
  CHECK(block.angle_rad == -9.0 * std::numbers::pi / 180.0);
  CHECK(block.count == 3);
  CHECK(block.hard);
  CHECK(block.kind == "round");
  CHECK(block.sizes_m == std::vector<double>{0.001, 0.0025});
  CHECK(block.friction.value == 0.5);
  CHECK(block.friction.sigma == 0.1);
  CHECK(block.friction.source == "bench");
}

TEST_CASE("each mistake gives one line with file, line, key, value and bound") {
  const std::string width = "width_mm = 175";
  const std::string bound = "must be a number from 1.0 to 200.0 mm";
  CHECK(error_of(text_with(width, "width_mm = -5")) == "f.toml:2:1: block.width_mm = -5: " + bound);
  CHECK(error_of(text_with(width, "width_mm = 200.5")) ==
        "f.toml:2:1: block.width_mm = 200.5: " + bound);
  CHECK(error_of(text_with(width, "width_mm = nan")) ==
        "f.toml:2:1: block.width_mm = nan: " + bound);
  CHECK(error_of(text_with(width, "width_mm = \"wide\"")) ==
        "f.toml:2:1: block.width_mm = \"wide\": " + bound);
  CHECK(error_of(text_with(width, "width_cm = 17.5")) ==
        "f.toml:2:1: block.width_cm = 17.5: unknown key, did you mean width_mm?");
  CHECK(error_of(text_with(width, "")) == "f.toml: block.width_mm: missing, " + bound);
  CHECK(error_of(text_with("count = 3", "count = 3.5")) ==
        "f.toml:4:1: block.count = 3.5: must be a whole number from 0 to 9");
  CHECK(error_of(text_with("count = 3", "count = 3\ncuont = 4")) ==
        "f.toml:5:1: block.cuont = 4: unknown key, did you mean count?");
  CHECK(error_of(text_with("hard = true", "hard = 1")) ==
        "f.toml:5:1: block.hard = 1: must be true or false");
  CHECK(error_of(text_with("\"round\"", "\"oval\"")) ==
        "f.toml:6:1: block.kind = \"oval\": must be one of: round, square");
  CHECK(error_of(text_with("2.5]", "11]")) ==
        "f.toml:7:1: block.sizes_mm = [1.0, 11.0]: must be a list of numbers from 0.0 to 10.0 mm");
  CHECK(error_of(text_with(", source = \"bench\"", "")) ==
        "f.toml: block.friction.source: missing, must be a string that is not empty");
  CHECK(error_of(text_with("friction = { value = 0.5, sigma = 0.1, source = \"bench\" }",
                           "friction = 0.5")) ==
        "f.toml:8:1: block.friction = 0.5: must be {value = , sigma = , source = \"\"}");
  CHECK(error_of("[blokc]\nwidth_mm = 1\n") ==
        "f.toml:2:1: blokc.width_mm = 1: unknown key, did you mean block.width_mm?");
}

TEST_CASE("bounds are allowed themselves") {
  CHECK(read_block(text_with("175", "1")).width_m == 0.001);
  CHECK(read_block(text_with("175", "200")).width_m == 0.2);
}

TEST_CASE("a section is finished on its own, and validate() gets file and section in front") {
  const Settings settings = Settings::parse("[a]\nx_m = 1\n[b]\ntemperature_C = 2\n", "f.toml");
  Reader root(settings);
  Reader a = root.section("a");
  double x = 0.0;
  a.number("x_m", x, kMetre, 0.0, 5.0);
  CHECK_NOTHROW(a.finish());
  CHECK_THROWS_WITH(root.finish(), "f.toml:4:1: b.temperature_C = 2: unknown key");
  CHECK_THROWS_WITH(a.check([] { throw std::invalid_argument("x = 1 m: must be odd"); }),
                    "f.toml: a: x = 1 m: must be odd");
  CHECK(a.has("x_m"));
  CHECK_FALSE(a.has("temperature_C"));
  CHECK(root.has("b"));
  CHECK(root.sections() == std::vector<std::string>{"a", "b"});
}
