#include "tools/bed/grain_export.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <charconv>

#include "tests/sim/terrain/small_bed.h"
#include "tests/tools/run/scratch_folder.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

using namespace hoof;
using namespace hoof::tools;
using hoof::tests::ScratchFolder;

namespace {

sim::DemSettings settings() {
  return sim::dem_settings(sim::test::small_bed(), sim::test::shipped_materials(), 1);
}

/// Four grains in a row along x that touch, and the floor under none.
sim::BedState row_of_four() {
  sim::BedState state;
  for (std::uint32_t i = 0; i < 4; ++i) {
    state.grains.push_back({i, 2e-3, {3.99e-3 * i, 0, -0.01}, {0, 0, 0}, {0, 0, 0}});
    if (i > 0) state.contacts.push_back({i - 1, i, Eigen::Vector3d::Zero()});
  }
  return state;
}

std::vector<std::int32_t> integers(const std::vector<VtkArray>& arrays, const char* name) {
  const auto at =
      std::find_if(arrays.begin(), arrays.end(), [&](const VtkArray& a) { return a.name == name; });
  REQUIRE(at != arrays.end());
  return std::get<std::vector<std::int32_t>>(at->values);
}

using Ids = std::vector<std::int32_t>;

}  // namespace

TEST_CASE("a region keeps the grains with their centres in it, and the contacts between them") {
  GrainSelection selection;
  selection.region = {Eigen::Vector3d(3.99e-3, -1e-6, -0.02), Eigen::Vector3d(9e-3, 1e-6, 0)};
  const PolyData grains = grain_points(settings(), row_of_four(), selection);
  CHECK(integers(grains.point_arrays, "id") == Ids{1, 2});
  const PolyData contacts = contact_lines(settings(), row_of_four(), selection);
  CHECK(integers(contacts.cell_arrays, "id1") == Ids{1});
  CHECK(integers(contacts.cell_arrays, "id2") == Ids{2});
}

TEST_CASE("every second grain is shown with its force from all of its neighbours") {
  GrainSelection selection;
  selection.every = 2;
  const PolyData grains = grain_points(settings(), row_of_four(), selection);
  CHECK(integers(grains.point_arrays, "id") == Ids{0, 2});
  const auto f = std::get<std::vector<float>>(grains.point_arrays.back().values);
  CHECK(grains.point_arrays.back().name == "f");
  CHECK(f[0] < -0.01f);                            // pushed by grain 1 alone
  CHECK(std::abs(f[3]) < 1e-3f * std::abs(f[0]));  // grain 2 from both sides
  CHECK(contact_lines(settings(), row_of_four(), selection).cell_count() == 0);
}

TEST_CASE("the table of the grains has units, and numbers that read back exactly") {
  const ScratchFolder scratch;
  const sim::BedState state = row_of_four();
  write_grain_csv(scratch.path() / "grains.csv", settings(), state, {});
  const std::string text = read_file(scratch.path() / "grains.csv");
  CHECK(
      text.starts_with("id,radius_m,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,wx_rad_s,wy_rad_s,wz_rad_s,"
                       "fx_N,fy_N,fz_N\n0,0.002,0,0,-0.01,0,"));
  CHECK(std::count(text.begin(), text.end(), '\n') == 5);
  const std::size_t at = text.find("\n3,0.002,") + 9;
  double x = 0;
  std::from_chars(text.data() + at, text.data() + text.size(), x);
  CHECK(x == state.grains[3].p_m.x());
  CHECK(std::distance(std::filesystem::directory_iterator(scratch.path()), {}) == 1);
}

TEST_CASE("arrays of another length than their points are refused, and leave no file") {
  const ScratchFolder scratch;
  PolyData data = grain_points(settings(), row_of_four(), {});
  std::get<std::vector<float>>(data.point_arrays.back().values).pop_back();
  CHECK_THROWS_WITH(write_vtp(scratch.path() / "a.vtp", data),
                    "VTK array f has 11 values for 4 places");
  CHECK(std::filesystem::is_empty(scratch.path()));
}

TEST_CASE("a place that cannot be written is named") {
  const ScratchFolder scratch;
  write_file(scratch.path() / "file", "x");
  CHECK_THROWS_WITH(
      VtkSeries(scratch.path() / "file" / "vtk", "bed"),
      Catch::StartsWith((scratch.path() / "file" / "vtk").string() + ": cannot make"));
  CHECK_THROWS_AS(write_vtp(scratch.path() / "absent" / "a.vtp", {}), UserError);
}
