// The cards: every shipped one parses, every value of it says where it is from, and a slip names
// file, line and key.
#include <catch2/catch.hpp>
#include <set>

#include "sim/config/config_error.h"
#include "sim/config/settings.h"
#include "tests/tools/run/scratch_folder.h"
#include "tools/materials/material_shelf.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

using namespace hoof;
using namespace hoof::tools;

namespace {

namespace fs = std::filesystem;

const fs::path kCards = sim::default_config_dir() / "materials";

std::string paper() {
  return read_file(kCards / "paper.toml");
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

sim::MaterialCard card(const std::string& text) {
  return sim::read_material_card(sim::Settings::parse(text, "card.toml"));
}

}  // namespace

TEST_CASE("cards: every shipped one parses, has a law, and each value's source is a reference") {
  const Shelf shelf = read_shelf();
  REQUIRE(shelf.cards.size() >= 4);
  std::set<std::string> names;
  for (const sim::MaterialCard& c : shelf.cards) {
    INFO(c.name);
    names.insert(c.name);
    CHECK(fs::exists(kCards / (c.name + ".toml")));  // use.materials=NAME finds it
    CHECK(c.status == "published");
    CHECK(c.law.size() > 20);
    CHECK_FALSE(c.references.empty());
    for (const sim::Reference& r : c.references) {
      CHECK((r.address.starts_with("doi ") || r.address.starts_with("https://") ||
             r.address.starts_with("tools/")));
    }
  }
  CHECK(names.size() == shelf.cards.size());
  CHECK(names.count("paper") == 1);
  for (const Shelf::MeasuredSand& s : shelf.measured) {
    INFO(s.id);
    CHECK((s.repose_rad || s.bulk_density_kg_m3));
  }
}

TEST_CASE("cards: a source that is missing or no reference is told with file, line and key") {
  const std::string sound = paper();
  CHECK(card(sound).name == "paper");
  CHECK_THROWS_WITH(card(with(sound, ", source = \"Ji et al. 2026, material table\"", "")),
                    Catch::Contains("card.toml") && Catch::Contains("sand.young_MPa.source") &&
                        Catch::Contains("missing"));
  CHECK_THROWS_WITH(
      card(with(sound, "source = \"Ji et al. 2026, table 3", "source = \"hearsay, table 3")),
      Catch::Contains("card.toml:") && Catch::Contains("sand_abs.restitution.source") &&
          Catch::Contains("must begin with a reference of the file (Ji et al. 2026)"));
  CHECK_THROWS_WITH(card(with(sound, "[card.references.ji2026]", "[card.reference.ji2026]")),
                    Catch::Contains("card.toml:") && Catch::Contains("unknown key"));
  CHECK_THROWS_WITH(card(with(sound, "status = \"published\"", "status = \"true\"")),
                    Catch::Contains("card.toml:") && Catch::Contains("card.status"));
}

TEST_CASE("cards: a range holds its value; a value out of bounds names its bound") {
  const std::string value = "static_friction = { value = 0.52,";
  CHECK_NOTHROW(card(with(paper(), value, value + " low = 0.52, high = 0.9,")));
  CHECK_THROWS_WITH(card(with(paper(), value, value + " low = 0.53,")),
                    Catch::Contains("card.toml:") &&
                        Catch::Contains("sand_sand.static_friction.low = 0.53") &&
                        Catch::Contains("from 0.0 to 0.52"));
  CHECK_THROWS_WITH(
      card(with(paper(), value, value + " high = 0.5,")),
      Catch::Contains("sand_sand.static_friction.high = 0.5") && Catch::Contains("from 0.52 to 5.0"));
  CHECK_THROWS_WITH(card(with(paper(), "repose_deg = { value = 37.8", "repose_deg = { value = 91")),
                    Catch::Contains("card.repose_deg.value = 91") && Catch::Contains("to 89.0"));
  const sim::MaterialCard ranged = card(with(paper(), value, value + " low = 0.4, high = 0.9,"));
  CHECK(*ranged.ranges.at("sand_sand.static_friction").low == 0.4);
  CHECK(*ranged.ranges.at("sand_sand.static_friction").high == 0.9);
}

TEST_CASE("cards: a card is no part of a run, which its text must not make another one") {
  const sim::Settings run = sim::Settings::load_experiment("sinkage");
  CHECK(run.find("materials.sand.density_kg_m3.value") != nullptr);
  for (const auto& [key, entry] : run.entries()) {
    CHECK_FALSE(key.starts_with("materials.card"));
  }
  for (const char* name : {"grc-1", "desert-sand"}) {
    const std::vector<std::string> use = {std::string("use.materials=") + name};
    const sim::Settings other = sim::Settings::load_experiment("sinkage", use);
    const sim::Materials m = sim::read_materials(sim::Reader(other).section("materials"));
    CHECK_FALSE(m.sand_sand.restitution.source.empty());
  }
}

TEST_CASE("cards: the list has all, a card is shown whole, an unknown one names those there are") {
  const Shelf shelf = read_shelf();
  const std::string list = shelf_text(shelf);
  for (const sim::MaterialCard& c : shelf.cards) CHECK_THAT(list, Catch::Contains(c.name));
  for (const Shelf::MeasuredSand& s : shelf.measured) CHECK_THAT(list, Catch::Contains(s.id));
  const std::string grc = card_text(shelf, "grc-1");
  CHECK_THAT(grc, Catch::Contains("0.5 (0.5 to 1.2)") && Catch::Contains("clumps") &&
                      Catch::Contains("https://github.com/projectchrono/DEM-Engine"));
  CHECK_THAT(card_text(shelf, "dune"), Catch::Contains("32 (30 to 34)"));
  CHECK(card_text(shelf, (kCards / "paper.toml").string()) == card_text(shelf, "paper"));
  CHECK_THROWS_WITH(card_text(shelf, "gravel"),
                    Catch::Contains("gravel: no such card") && Catch::Contains("paper"));
}
