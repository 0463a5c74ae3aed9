// The frames for ParaView as VTK's own reader (package python3-vtk9) reads them, and the numbers of
// the view. Where VTK is not installed CTest lists the first as skipped.

#include <catch2/catch.hpp>

#include "tests/tools/bed/vtk_reading.h"
#include "tests/tools/fields/made_scene.h"
#include "tests/tools/run/scratch_folder.h"
#include "tools/fields/field_export.h"
#include "tools/fields/field_map.h"
#include "tools/fields/field_measures.h"
#include "tools/fields/field_view.h"

using namespace hoof;
using namespace hoof::tests;
using namespace hoof::tools;

namespace {

/// One grain on the sole, one below it that it touches, both moved since the contact.
struct Pressed {
  Made made{{box_mesh({-0.01, -0.02, 0}, {0.01, 0.02, 0.01})}};
  Made contact = made;

  Pressed() {
    for (Made* m : {&contact, &made}) {
      const double down_m = m == &made ? 1e-3 : 0;
      m->grain({0.004, -0.001, -1.999e-3 - down_m}, 2e-3, {0.1, 0, -0.2});
      m->grain({0.004, -0.001, -5.995e-3 - down_m}, 2e-3);
      m->contact(0, 1);
      m->moment.poses[0].p_WB_m.z() = -down_m;
    }
    made.press(0, 0, 0, {0.004, -0.001, -1e-3}, 3);
    made.moment.time_s = 0.5;
  }
};

}  // namespace

TEST_CASE("VTK reads displacement, the foot's forces and the pressure of its triangles") {
  const ScratchFolder scratch;
  const Pressed p;
  VtkSeries series(scratch.path() / "fields", "fields");
  add_frame(series, FieldScene(p.made.setting, p.made.moment), p.contact.moment);
  const auto [status, text] = read_with_vtk(series.collection());
  if (status == 77) return;
  REQUIRE(status == 0);
  REQUIRE(text.find("at 0.5 foot-contacts foot-contacts-00000.vtp") != std::string::npos);
  const std::string foot = text.substr(text.find("at 0.5 foot foot-00000.vtp"));
  const std::string spots = text.substr(text.find("at 0.5 foot-contacts"));
  require_near(numbers_below(text, "point array id int 1"), {0, 1});
  require_near(numbers_below(text, "point array v float 3"), {0.1, 0, -0.2, 0, 0, 0});
  require_near(numbers_below(text, "point array displacement float 3"), {0, 0, -1e-3, 0, 0, -1e-3});
  require_near(numbers_below(text, "point array f_foot float 3"), {0, 0, -3, 0, 0, 0});
  require_near(numbers_below(spots, "cell array force_normal float 3"), {0, 0, -3});
  require_near(numbers_below(spots, "cell array part int 1"), {1});
  std::vector<double> pressure(12);
  pressure[0] = 3 / 4e-4;
  require_near(numbers_below(foot, "cell array pressure float 1"), pressure);
  CHECK(numbers_below(foot, "points 36")[2] == Approx(-1e-3));
}

TEST_CASE("the view holds places, values and pressure to 16 bits") {
  const Pressed p;
  FieldView view(p.made.setting);
  view.add(FieldScene(p.made.setting, p.made.moment), p.contact.moment);
  const auto j = view.finish();
  CHECK(j["speed_m_s"] == Approx(0.0).margin(1));
  CHECK(j["displacement_m"] == Approx(1e-3));
  CHECK(j["radius_m"] == 2e-3);
  CHECK(j["pressure_Pa"] == Approx(3 / 4e-4));
  const auto& moment = j["moments"][0];
  // Two grains of seven numbers of two bytes: 28 bytes are 40 letters; two chains likewise.
  CHECK(moment["grains"].get<std::string>().size() == 40);
  CHECK(moment["chains"].get<std::string>().size() == 40);
  CHECK(moment["pressure"].get<std::string>().starts_with("//8A"));  // 0xffff, then zero
  CHECK(j["bodies"][0]["triangles"].size() == 36);
  CHECK(moment["poses"][0][2] == -1e-3);
}

TEST_CASE("base64 is that of RFC 4648") {
  CHECK(base64("") == "");
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foo") == "Zm9v");
  CHECK(base64("foobar") == "Zm9vYmFy");
  CHECK(base64("\xff\xfe\xfd") == "//79");
}

TEST_CASE("each map has a bar, a unit and a number, and shows the grains that are cut") {
  const Pressed p;
  const FieldScene scene(p.made.setting, p.made.moment);
  const FieldScene contact(p.contact.setting, p.contact.moment);
  const auto maps = field_maps(scene, p.contact.moment, measure_fields(scene, contact), -0.001);
  REQUIRE(maps.size() == 7);
  for (const FieldMap& map : maps) {
    CAPTURE(map.key);
    CHECK(map.svg.find(">50 mm</text>") != std::string::npos);
    CHECK_FALSE(map.number.empty());
    CHECK(map.svg.find("nan") == std::string::npos);
  }
  const auto circles = [](const std::string& svg) {
    int count = 0;
    for (std::size_t at = svg.find("<circle"); at != std::string::npos;
         at = svg.find("<circle", at + 1)) {
      ++count;
    }
    return count;
  };
  CHECK(circles(maps[0].svg) == 2);
  const auto beside = field_maps(scene, p.contact.moment, measure_fields(scene, contact), 0.01);
  CHECK(circles(beside[0].svg) == 0);
  CHECK(viridis(0) == "#440154");
  CHECK(viridis(1) == "#fde725");
  CHECK(viridis(-3) == "#440154");
  CHECK(viridis(0.5) == "#23908c");
}
