#include "sim/config/settings.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <vector>

#include "sim/config/config_error.h"

using namespace hoof::sim;
namespace fs = std::filesystem;

namespace {

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

/// A folder of its own, gone with the test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "hoof-config-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~TemporaryFolder() { fs::remove_all(path_); }

  void write(const fs::path& file, const std::string& text) const {
    fs::create_directories((path_ / file).parent_path());
    std::ofstream(path_ / file) << text;
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

TEST_CASE("tables, inline tables and arrays of tables become dotted keys with origins") {
  const Settings s = Settings::parse(
      "a = 1\n[b]\n  c = {value = 2.5, source = \"x\"}\n[[d]]\ne = true\n[[d]]\ne = false\n",
      "f.toml");
  CHECK(std::get<std::int64_t>(s.find("a")->value) == 1);
  CHECK(std::get<double>(s.find("b.c.value")->value) == 2.5);
  CHECK(s.find("b.c.value")->origin.text() == "f.toml:3:8");
  CHECK(std::get<bool>(s.find("d.1.e")->value) == false);
  CHECK(s.find("b") == nullptr);
  CHECK(s.entries().size() == 5);
}

TEST_CASE("what is not TOML is named with line and column, on one line") {
  CHECK(error_of([] {
          Settings::parse("a = 1\nb = = 2\n", "f.toml");
        }).starts_with("f.toml:2:5: not TOML: "));
  CHECK(error_of([] { Settings::parse("a = 1\na = 2\n", "f.toml"); }).starts_with("f.toml:2:"));
  CHECK(error_of([] { Settings::parse("a = [1, \"x\"]\n", "f.toml"); }) ==
        "f.toml:1:1: a: must hold only numbers, only strings or only tables");
  CHECK(error_of([] { Settings::parse("a = 2026-01-01\n", "f.toml"); }) ==
        "f.toml:1:1: a: must not be a date or time");
  CHECK(error_of([] { Settings::parse("\"a.b\" = 1\n", "f.toml"); }) ==
        "f.toml:1:1: key \"a.b\": must be letters, digits, _ or -");
  CHECK(error_of([] { Settings::parse("a = \n\n", "f.toml"); }).find('\n') == std::string::npos);
}

TEST_CASE("an override wins, keeps its origin and its type") {
  Settings s = Settings::parse("[foot]\nmass_kg = 1.5\nname = \"x\"\n", "f.toml");
  s.set("foot.mass_kg = 2");
  s.set("foot.name=goat");
  s.set("bed.seed=7");
  s.set("bed.sizes_mm=[1, 2.5]");
  CHECK(std::get<std::int64_t>(s.find("foot.mass_kg")->value) == 2);
  CHECK(s.find("foot.mass_kg")->origin.text() == "--set");
  CHECK(std::get<std::string>(s.find("foot.name")->value) == "goat");
  CHECK(std::get<std::vector<double>>(s.find("bed.sizes_mm")->value).at(1) == 2.5);
  CHECK(error_of([&] { s.set("foot"); }) == "--set foot: must be key=value");
  CHECK(error_of([&] { s.set("=3"); }) == "--set =3: must be key=value");
  CHECK(error_of([&] { s.set("foot=3"); }) ==
        "--set: foot = 3: is a section, must not have a value");
  CHECK(error_of([&] { s.set("foot.name.x=3"); }) ==
        "--set: foot.name.x: foot.name is a value, must not be a section");
  CHECK(error_of([&] { s.set("a=1\nb=2"); }) == "--set a: must be a single line");
}

TEST_CASE("a bare override of a measured value drops the doubt and source it no longer has") {
  Settings s = Settings::parse("mu = {value = 0.5, sigma = 0.1, source = \"paper\"}\n", "f.toml");
  s.set("mu=0.7");
  CHECK(std::get<double>(s.find("mu.value")->value) == 0.7);
  CHECK(std::get<double>(s.find("mu.sigma")->value) == 0.0);
  CHECK(std::get<std::string>(s.find("mu.source")->value) == "set in --set");
}

TEST_CASE("an experiment takes in what it uses; its own keys win, overrides win over all") {
  const TemporaryFolder folder;
  folder.write("feet/small.toml", "mass_kg = 1\nlength_mm = 10\nwidth_mm = 5\n");
  folder.write("feet/large.toml", "mass_kg = 9\nlength_mm = 90\nwidth_mm = 45\n");
  folder.write("experiments/press.toml",
               "[use]\nfoot = \"small\"\n[foot]\nlength_mm = 20\n[experiment]\nload_kg = 40\n");

  const Settings plain = Settings::load_experiment("press", {}, folder.path());
  CHECK(std::get<std::int64_t>(plain.find("foot.mass_kg")->value) == 1);
  CHECK(std::get<std::int64_t>(plain.find("foot.length_mm")->value) == 20);
  CHECK(plain.find("use.foot") == nullptr);

  const std::vector<std::string> overrides = {"foot.width_mm=7", "use.foot=large"};
  const Settings changed = Settings::load_experiment("press", overrides, folder.path());
  CHECK(std::get<std::int64_t>(changed.find("foot.mass_kg")->value) == 9);
  CHECK(std::get<std::int64_t>(changed.find("foot.width_mm")->value) == 7);
  CHECK(changed.find("foot.mass_kg")->origin.text() ==
        (folder.path() / "feet/large.toml").string() + ":1:1");

  SECTION("by path, relative to the file that names it") {
    folder.write("mine/press.toml", "[use]\nfoot = \"../feet/large.toml\"\n");
    const Settings mine =
        Settings::load_experiment((folder.path() / "mine/press.toml").string(), {}, folder.path());
    CHECK(std::get<std::int64_t>(mine.find("foot.length_mm")->value) == 90);
  }
  SECTION("a wrong name lists the right ones") {
    const std::vector<std::string> wrong = {"use.foot=smal"};
    CHECK(
        error_of([&] { Settings::load_experiment("press", wrong, folder.path()); }) ==
        "--set: use.foot = \"smal\": did you mean \"small\"? must be one of: large, small, or the "
        "path of a TOML file");
    CHECK(error_of([&] { Settings::load_experiment("presss", {}, folder.path()); }) ==
          "experiment \"presss\": did you mean \"press\"? must be one of: press, or the path of a "
          "TOML file");
    const std::vector<std::string> section = {"use.food=small"};
    CHECK(error_of([&] { Settings::load_experiment("press", section, folder.path()); }) ==
          "--set: use.food = \"small\": unknown key, did you mean use.foot?");
  }
  SECTION("a missing file is named") {
    CHECK(error_of([&] { Settings::load_experiment("no/such.toml", {}, folder.path()); }) ==
          "no/such.toml: cannot be read: No such file or directory");
    CHECK(error_of([&] { Settings::load_file(folder.path()); }) ==
          folder.path().string() + ": cannot be read: is a folder");
  }
}

TEST_CASE("resolved settings read back as the same values and the same text") {
  Settings s = Settings::parse(
      "z = -0.1\n[b.c]\nt = \"a \\\"quote\\\" \\\\ \\u0007\"\nn = 3\nx = 1e-300\n"
      "[a]\nlist = [1, 2.5]\nwords = [\"p\", \"q\"]\nf = true\nwhole = 5.0\n",
      "f.toml");
  s.set("b.c.n=4");
  const std::string text = s.to_toml("");
  const Settings again = Settings::parse(text, "resolved.toml");
  REQUIRE(again.entries().size() == s.entries().size());
  for (const auto& [key, entry] : s.entries()) {
    INFO(key);
    REQUIRE(again.find(key) != nullptr);
    CHECK(again.find(key)->value == entry.value);
  }
  CHECK(text.starts_with("z = -0.1  # f.toml:1\n\n[a]\nf = true  # f.toml:9\n"));
  CHECK(text.find("n = 4  # --set\n") != std::string::npos);
}

TEST_CASE("resolved settings name presets without the folder they were in") {
  const TemporaryFolder folder;
  folder.write("feet/small.toml", "mass_kg = 1\n");
  folder.write("experiments/press.toml", "[use]\nfoot = \"small\"\n");
  const Settings s = Settings::load_experiment("press", {}, folder.path());
  CHECK(s.to_toml(folder.path()) == "\n[foot]\nmass_kg = 1  # feet/small.toml:1\n");
}
