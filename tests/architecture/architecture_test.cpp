// The rules of the house, held over the source tree; and the checks themselves, held over a tree
// with planted violations.

#include <catch2/catch.hpp>

#include "tests/architecture/file_rules.h"
#include "tests/architecture/include_rules.h"
#include "tests/architecture/source_file.h"
#include "tests/architecture/toml_rules.h"

using namespace hoof::tests;

namespace {

std::vector<std::string> texts(const std::vector<Finding>& findings) {
  std::vector<std::string> lines;
  for (const Finding& finding : findings) lines.push_back(to_string(finding));
  return lines;
}

SourceFile file(const std::string& path, const std::vector<std::string>& lines) {
  return {path, lines};
}

std::string include(const std::string& header) {
  return "#include \"" + header + "\"";
}

const std::vector<std::string> kNone;

}  // namespace

TEST_CASE("the source tree is read") {
  const auto files = read_source_tree(HOOF_SOURCE_DIR);
  const auto has = [&files](const std::string& path) {
    for (const SourceFile& source : files) {
      if (source.path == path) return !source.lines.empty();
    }
    return false;
  };
  CHECK(has("CMakeLists.txt"));
  CHECK(has("hal/can_bus.h"));
  CHECK(has("tools/hoof"));
  CHECK(has("tests/architecture/source_file.cpp"));
  CHECK_FALSE(has("tools/report/vendor/uplot/README.md"));
}

TEST_CASE("everyone includes only whom the house allows") {
  CHECK(texts(check_includes(read_source_tree(HOOF_SOURCE_DIR))) == kNone);
}

TEST_CASE("files are short, headers guarded, and no path of one machine is in them") {
  CHECK(texts(check_files(read_source_tree(HOOF_SOURCE_DIR))) == kNone);
}

TEST_CASE("the top level is the fixed one") {
  CHECK(texts(check_top_level(HOOF_SOURCE_DIR)) == kNone);
}

TEST_CASE("numbers in settings carry their unit") {
  CHECK(texts(check_toml_units(read_source_tree(HOOF_SOURCE_DIR))) == kNone);
}

TEST_CASE("planted: each forbidden include is found, each allowed one passes") {
  struct Case {
    const char* path;
    std::string line;
    bool allowed;
  };
  const std::vector<Case> cases = {
      {"firmware/trajectory/a.h", include("firmware/control/b.h"), false},
      {"firmware/control/a.cpp", include("firmware/trajectory/b.h"), true},
      {"firmware/control/a.cpp", include("firmware/protocol/b.h"), false},
      {"firmware/control/a.cpp", "#include <vector>", false},
      {"firmware/safety/a.cpp", "  #  include <cmath>", false},
      {"firmware/control/a.cpp", "#include <array>", true},
      {"firmware/board/host/a.cpp", "#include <vector>", true},
      {"firmware/protocol/a.h", include("hal/can_frame.h"), true},
      {"firmware/protocol/a.h", include("hal/can_timing.h"), true},
      {"firmware/protocol/a.h", include("hal/can_bus.h"), false},
      {"firmware/safety/a.h", include("firmware/control/types.h"), true},
      {"firmware/safety/a.cpp", include("firmware/control/math.h"), true},
      {"firmware/safety/a.cpp", include("firmware/control/foot_controller.h"), false},
      {"firmware/board/host/a.cpp", include("firmware/protocol/b.h"), false},
      {"firmware/app/a.h", include("hal/can_bus.h"), true},
      {"firmware/app/a.h", include("hal/in_process/bus.h"), false},
      {"firmware/app/a.h", include("sim/dem/b.h"), false},
      {"firmware/board/host/a.cpp", include("hal/socketcan/b.h"), true},
      {"hal/a.h", include("firmware/protocol/b.h"), false},
      {"sim/multibody/a.h", include("sim/drive/b.h"), true},
      {"sim/dem/a.h", include("sim/multibody/b.h"), false},
      {"sim/coupling/a.cpp", include("hal/can_frame.h"), false},
      {"sim/coupling/a.cpp", "#include <linux/can.h>", false},
      {"hil_bridge/a.cpp", include("firmware/app/b.h"), true},
      {"hil_bridge/a.cpp", include("firmware/control/b.h"), false},
      {"hil_bridge/a.cpp", include("tools/run/b.h"), false},
      {"tools/diagnose/a.cpp", include("tools/conceal/b.h"), false},
      {"tools/run/a.cpp", include("tools/conceal/b.h"), false},
      {"tools/cli/conceal_command.cpp", include("tools/conceal/b.h"), true},
      {"tools/cli/a.cpp", include("hil_bridge/b.h"), true},
      {"tools/cli/a.cpp", include("tests/b.h"), false},
      {"attic/a.cpp", include("sim/b.h"), false},
  };
  for (const Case& c : cases) {
    CAPTURE(c.path, c.line);
    CHECK(check_includes({file(c.path, {c.line})}).empty() == c.allowed);
  }
  CHECK(texts(check_includes({file("hal/a.h", {"", include("sim/b.h")})})) ==
        std::vector<std::string>{"hal/a.h:2: hal/ may not include sim/b.h"});
}

TEST_CASE("planted: long files, unguarded headers and machine paths are found") {
  CHECK(check_files({file("a.h", {"#pragma once"})}).empty());
  CHECK(check_files({file("a.h", {"int a;"})}).size() == 1);
  CHECK(check_files({file("a.cpp", std::vector<std::string>(500))}).empty());
  CHECK(check_files({file("a.cpp", std::vector<std::string>(501))}).size() == 1);
  const std::string home = std::string("/ho") + "me/user";
  CHECK(texts(check_files({file("a.cpp", {"", "open(\"" + home + "/x\")"})})) ==
        std::vector<std::string>{"a.cpp:2: path of one machine"});
  CHECK(check_files({file("a.cpp", {"see docs" + home})}).empty());
}

TEST_CASE("planted: a key without a unit is found") {
  const SourceFile units =
      file("sim/config/units.h", {"inline constexpr Unit kMillimetre{\"mm\", 1};"});
  const auto check = [&units](const std::vector<std::string>& toml) {
    return texts(check_toml_units({units, file("sim/config/a.toml", toml)}));
  };
  CHECK(check({"length_mm = 3", "spine_count = 2", "name = \"x\"", "on = true"}) == kNone);
  CHECK(check({"width_mm = { value = 3, sigma = 1, source = \"x\" }"}) == kNone);
  CHECK(check({"", "length = 3"}) ==
        std::vector<std::string>{"sim/config/a.toml:2: the key length does not end in a unit"});
  CHECK(check({"[spines]", "offsets = [1.0, 2.0]"}).size() == 1);
  CHECK(check({"length = { value = 3, source = \"x\" }"}).size() == 1);
  CHECK(check({"length_in = 3"}).size() == 1);
  CHECK(check({"a = "}).size() == 1);
  CHECK(check_toml_units({}).size() == 1);
}
