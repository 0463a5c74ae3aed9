#include "tools/terrain/push_table.h"

#include <catch2/catch.hpp>

#include "tests/tools/run/scratch_folder.h"
#include "tests/tools/terrain/synthetic_pushes.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"
#include "tools/terrain/soil_text.h"

using namespace hoof::tools;
using hoof::tests::ScratchFolder;
namespace fs = std::filesystem;

namespace {

const std::string kHeader =
    "case_name,set_name,phase_name,length_m,width_m,thickness_m,beta_rad,psi_rad,gamma_rad,"
    "insert_m,push_m,back_m,way_m,fx_N,fy_N,fz_N\n";

}  // namespace

TEST_CASE("pushes come back from their file to the bit") {
  const ScratchFolder scratch;
  const fs::path file = scratch.path() / "pushes.csv";
  const auto pushes =
      hoof::tests::synthetic_pushes(hoof::tests::planted(hoof::sim::PressureLaw::kLinear), 0.1, 5);
  write_pushes(file, pushes);
  const auto back = read_pushes(file);
  REQUIRE(back.size() == pushes.size());
  for (std::size_t i = 0; i < back.size(); ++i) {
    CHECK(back[i].plate.name == pushes[i].plate.name);
    CHECK(back[i].plate.held_out == pushes[i].plate.held_out);
    CHECK(back[i].plate.beta_rad == pushes[i].plate.beta_rad);
    REQUIRE(back[i].samples.size() == pushes[i].samples.size());
    CHECK(back[i].samples[7].force_N == pushes[i].samples[7].force_N);
    CHECK(back[i].samples.back().phase == pushes[i].samples.back().phase);
  }
  const std::string bytes = read_file(file);
  write_pushes(file, back);
  CHECK(read_file(file) == bytes);
  CHECK_FALSE(fs::exists(scratch.path() / "pushes.csv.partial"));
}

TEST_CASE("a bad table of pushes is named by file, line, column, value and bound") {
  const ScratchFolder scratch;
  const fs::path file = scratch.path() / "bad.csv";
  struct Case {
    std::string text, complaint;
  };
  const std::string good = "a,fitted,push,0.1,0.06,0.01,0,0,1.5,0,0.02,0,0.0005,0,0,3\n";
  for (const Case& c : {
           Case{"case_name\na\n", ":1: no column "},
           Case{kHeader, ": holds no pushes"},
           Case{kHeader + good + "a,fitted,push,0.1,-6,0.01,0,0,1.5,0,0.02,0,0.001,0,0,3\n",
                ":3: width_m = -6: must be in 1e-04 ... 10"},
           Case{kHeader + good + "a,fitted,push,0.1,0.05,0.01,0,0,1.5,0,0.02,0,0.001,0,0,3\n",
                ":3: width_m = 0.05: must be 0.06 as in the first row of 'a'"},
           Case{kHeader + good + "b,fitted,push,0.1,0.06,0.01,9,0,1.5,0,0.02,0,0.001,0,0,3\n",
                ":3: beta_rad = 9: must be in "},
           Case{kHeader + "a,fitted,push,0.1,0.06,0.01,0,0,1.5,0,0.02,0,0.0005,0,0,nan\n",
                ":2: fz_N = nan: must be a finite number"},
           Case{kHeader + "a,all,push,0.1,0.06,0.01,0,0,1.5,0,0.02,0,0.0005,0,0,3\n",
                ":2: set_name = all: must be fitted or held_out"},
           Case{kHeader + "a,fitted,down,0.1,0.06,0.01,0,0,1.5,0,0.02,0,0.0005,0,0,3\n",
                ":2: phase_name = down: must be push or back"},
       }) {
    CAPTURE(c.text);
    write_file(file, c.text);
    CHECK_THROWS_WITH(read_pushes(file), Catch::Contains(file.string() + c.complaint));
    CHECK_THROWS_AS(read_pushes(file), UserError);
  }
}

TEST_CASE("a soil's file reads back as the same soil") {
  const ScratchFolder scratch;
  const fs::path file = scratch.path() / "soil.toml";
  auto soil = hoof::tests::planted(hoof::sim::PressureLaw::kBekker);
  soil.xi_n_N_m3 = {123456.78901234567, 321.5, "a \"test\""};
  write_file(file, soil_toml(soil, "hoof terrain fit"));
  const auto back = load_soil(file.string());
  CHECK(back.xi_n_N_m3.value == soil.xi_n_N_m3.value);
  CHECK(back.xi_n_N_m3.sigma == soil.xi_n_N_m3.sigma);
  CHECK(back.bekker_exponent == soil.bekker_exponent);
  CHECK(back.yield_displacement_m.value == Approx(soil.yield_displacement_m.value).epsilon(1e-14));
  CHECK(back.pressure_law == soil.pressure_law);
  CHECK(soil_toml(back, "hoof terrain fit") ==
        soil_toml(load_soil(file.string()), "hoof terrain fit"));
}
