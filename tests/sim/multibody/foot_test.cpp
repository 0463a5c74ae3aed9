#include "sim/multibody/foot.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>

#include "sim/config/config_error.h"
#include "sim/multibody/mass_properties.h"
#include "sim/multibody/mesh_fault.h"
#include "sim/multibody/stl.h"
#include "tests/sim/multibody/cube.h"
#include "tests/sim/multibody/shipped.h"

using namespace hoof::sim;

TEST_CASE("the shipped feet are whole") {
  const std::string name = GENERATE("traditional", "bionic", "bionic-plain");
  const Foot foot = shipped_foot(name);
  CHECK(foot.name == name);
  CHECK(foot.has_toes == (name != "traditional"));
  CHECK(foot.geometry.has_spines == (name == "bionic"));
  CHECK_FALSE(find_mesh_fault(foot.middle));
  if (!foot.has_toes) return;
  CHECK_FALSE(find_mesh_fault(foot.left_toe));
  CHECK((foot.hinges.left_F_m - Eigen::Vector3d(-0.0625, 0.033, 0.0)).norm() < 1e-12);
}

TEST_CASE("24 spines, as in the paper's pictures") {
  const auto spines = [](const TriangleMesh& spined, const TriangleMesh& plain) {
    return (spined.triangles.size() - plain.triangles.size()) / 12;
  };
  const Foot with = shipped_foot("bionic");
  const Foot without = shipped_foot("bionic-plain");
  CHECK(spines(with.middle, without.middle) + spines(with.left_toe, without.left_toe) +
            spines(with.right_toe, without.right_toe) ==
        24);
}

TEST_CASE("any closed STL file is a foot, moved to stand on z = 0 about the origin") {
  namespace fs = std::filesystem;
  std::string name = (fs::temp_directory_path() / "hoof-foot-XXXXXX").string();
  const fs::path folder = ::mkdtemp(name.data());
  const fs::path file = folder / "block.STL";
  write_stl(make_cuboid({0.3, 0.1, -0.2}, {0.1, 0.05, 0.04}), file);

  const auto overrides = foot_overrides(file.string());
  REQUIRE(overrides.size() == 2);
  CHECK(overrides[0] == "use.foot=\"stl\"");
  Settings run;
  run.merge(Settings::load_file(default_config_dir() / "feet/stl.toml"), "foot");
  run.set(overrides[1]);
  const Foot foot = read_foot(Reader(run).section("foot"));
  CHECK_FALSE(foot.has_toes);
  const MassProperties mass = solid(foot.middle, foot.mass_kg);
  CHECK((mass.com_B_m - Eigen::Vector3d(0.0, 0.0, 0.02)).norm() < 1e-8);

  run.set("foot.mesh_unit=cm");
  CHECK_THROWS_WITH(read_foot(Reader(run).section("foot")),
                    "--set: foot.mesh_unit = \"cm\": must be one of: mm, m");
  fs::remove_all(folder);
  CHECK(foot_overrides("bionic") == std::vector<std::string>{"use.foot=\"bionic\""});
}

TEST_CASE("worn spines are as deep as what is left of them, and the frustum cut off is gone") {
  const Foot fresh = shipped_foot("bionic");
  const SpineGeometry spines = fresh.geometry.spines;
  const double loss_m = GENERATE(0.0, 0.002, 0.0075, 0.02);
  const Foot worn = with_worn_spines(fresh, loss_m);
  const double left_m = std::max(0.0, spines.length_m - loss_m);
  const auto check = [&](const TriangleMesh& part, const TriangleMesh& before, int count) {
    double lowest_m = 0;
    for (const auto& v : part.vertices_m) lowest_m = std::min(lowest_m, v.z());
    CHECK(lowest_m == Approx(-left_m * std::cos(spines.rake_rad)).margin(1e-12));
    CHECK_FALSE(find_mesh_fault(part));
    if (left_m == 0) return;
    // A raked frustum is as high as its axis' cosine.
    const double share = loss_m / spines.length_m, tip_m = spines.tip_m;
    const double end_m = tip_m + share * (spines.base_m - tip_m);
    const double cut_m3 =
        loss_m * std::cos(spines.rake_rad) / 3 * (tip_m * tip_m + tip_m * end_m + end_m * end_m);
    CHECK(volume_m3(before) - volume_m3(part) == Approx(count * cut_m3).margin(1e-14));
  };
  check(worn.middle, fresh.middle, 2 * spines.middle_count_row);
  check(worn.left_toe, fresh.left_toe, spines.toe_count);
  CHECK(worn.geometry.has_spines == (left_m > 0));
  CHECK(worn.mass_kg == fresh.mass_kg);
  if (loss_m == 0) CHECK(worn.middle.vertices_m == fresh.middle.vertices_m);
  CHECK_THROWS_WITH(with_worn_spines(shipped_foot("bionic-plain"), 0.001),
                    Catch::Contains("no spines that could wear"));
}

TEST_CASE("wrong settings of a foot are named") {
  Settings run;
  run.merge(Settings::load_file(default_config_dir() / "feet/bionic.toml"), "foot");
  const Settings good = run;
  const auto error_of = [&run] {
    try {
      read_foot(Reader(run).section("foot"));
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  CHECK(error_of() == "no error");
  run.set("foot.toe.max_opening_deg=120");
  CHECK(error_of() ==
        "--set: foot.toe.max_opening_deg = 120: must be a number from 0.0 to 90.0 deg");
  run = good;
  run.set("foot.spines.lenght_mm=9");
  CHECK(error_of() == "--set: foot.spines.lenght_mm = 9: unknown key, did you mean length_mm?");
  run = good;
  run.set("foot.middle.width_mm=12");
  CHECK_THAT(error_of(), Catch::Contains("foot: middle.edge_radius = 8 mm: must be above 0"));
}
