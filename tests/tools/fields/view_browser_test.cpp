// Opens the report of a run with fields in a headless browser without a network: the view in three
// dimensions draws what it was given, and its controls do something. Where no chromium is installed
// CTest lists this as skipped.

#include <catch2/catch.hpp>
#include <string>

#include "tests/tools/fields/made_scene.h"
#include "tests/tools/report/browser.h"
#include "tests/tools/report/synthetic_run.h"
#include "tests/tools/run/scratch_folder.h"
#include "tools/fields/field_map.h"
#include "tools/fields/field_measures.h"
#include "tools/fields/field_view.h"
#include "tools/report/report.h"
#include "tools/run/output_file.h"
#include "tools/run/result_json.h"

using namespace hoof;
using namespace hoof::tests;
using namespace hoof::tools;

namespace {

/// Layers of grains under a box, the upper ones pressed; `moved_m` to the rear.
Made layers(double moved_m) {
  Made made({box_mesh({-0.03, -0.02, 0}, {0.03, 0.02, 0.01})});
  for (int i = -8; i <= 8; ++i) {
    for (int j = -5; j <= 5; ++j) {
      for (int k = 0; k < 4; ++k) {
        made.grain({3.998e-3 * i - moved_m * (4 - k), 3.998e-3 * j + 1e-3, -1.999e-3 - 3.99e-3 * k},
                   2e-3, {-0.1 * moved_m / 1e-3, 0, 0});
      }
    }
  }
  made.touch_all();
  const auto& grains = made.moment.sand.grains;
  for (std::uint32_t i = 0; i < grains.size(); i += 4) {
    const Eigen::Vector3d p = grains[i].p_m;
    if (std::abs(p.x()) < 0.03 && std::abs(p.y()) < 0.02) {
      made.press(i, 0, p.x() > 0 ? 0 : 1, {p.x(), p.y(), 0}, 1 + 0.01 * i);
    }
  }
  return made;
}

void write_fields(const std::filesystem::path& folder) {
  std::filesystem::create_directory(folder / "fields");
  Made contact = layers(0), peak = layers(3e-4);
  contact.moment.name = "contact";
  peak.moment.name = "peak Fx";
  peak.moment.time_s = 0.25;
  const FieldScene before(contact.setting, contact.moment), scene(peak.setting, peak.moment);
  FieldView view(contact.setting);
  view.add(before, contact.moment);
  view.add(scene, contact.moment);
  write_file(folder / "fields/view.json", view.finish().dump());
  const auto measured = measure_fields(scene, before);
  nlohmann::ordered_json all;
  all["maps"] = nlohmann::ordered_json::array();
  for (const FieldMap& map : field_maps(scene, contact.moment, measured, 0.002)) {
    const std::string file = "fields/" + map.key + ".svg";
    write_file(folder / file, map.svg);
    all["maps"].push_back(
        {{"moment", "peak Fx"}, {"file", file}, {"title", map.title}, {"number", map.number}});
  }
  all["moments"] = {measure_fields(before, before), measured};
  write_result_json(folder / "fields.json", all);
}

}  // namespace

TEST_CASE("the view of the sand draws in a browser, offline, and follows its controls") {
  if (browser_is_missing()) return;
  const ScratchFolder scratch;
  write_synthetic_run(scratch.path(), 100);
  write_fields(scratch.path());
  const std::filesystem::path page = write_report(scratch.path());
  CHECK(count_of(read_file(page), "<figcaption>") == 7);

  const Opened opened = open_in_browser(page, scratch.path());
  CHECK(opened.messages == "");
  CHECK_THAT(opened.page, Catch::Contains("data-grains=\"408\""));
  CHECK_THAT(opened.page, Catch::Contains("data-moment=\"peak Fx\""));
  CHECK_THAT(opened.page, Catch::Contains("peak Fx, 250 ms after first contact"));
  // Of 17 x 11 x 4 grains six rows of eleven are behind the cut, of 180 triangles each; chains and
  // foot more.
  const auto triangles = [](const std::string& text, const std::string& before) {
    const std::size_t at = text.find(before);
    return at == std::string::npos ? -1 : std::stoi(text.substr(at + before.size()));
  };
  CHECK(triangles(opened.page, "data-triangles=\"") > 408 * 180);

  // The same page with a hand on its controls.
  const std::filesystem::path moved = scratch.path() / "moved.html";
  write_file(moved, read_file(page) +
                        "<script>const form = document.querySelector('#view form');"
                        "form.elements.moment.value = 0; form.elements.grains.checked = false;"
                        "form.elements.colour.value = 'force';"
                        "form.dispatchEvent(new Event('input'));</script>");
  const Opened after = open_in_browser(moved, scratch.path());
  CHECK(after.messages == "");
  CHECK_THAT(after.page, Catch::Contains("data-moment=\"contact\""));
  CHECK_THAT(after.page, Catch::Contains("N, largest contact"));
  CHECK(triangles(after.page, "data-triangles=\"") < 408 * 20);
  CHECK(triangles(after.page, "data-triangles=\"") > 0);
}

TEST_CASE("each map is saved as a PNG by the page itself") {
  if (browser_is_missing()) return;
  const ScratchFolder scratch;
  write_synthetic_run(scratch.path(), 100);
  write_fields(scratch.path());
  const std::filesystem::path page = write_report(scratch.path()),
                              asked = scratch.path() / "a.html";
  // What the button saves, read back: its size and a pixel of the first grain that is drawn.
  write_file(asked, read_file(page) + R"(<script>(async () => {
    const figure = document.querySelector(".maps figure");
    const box = figure.querySelector("svg").viewBox.baseVal;
    const grain = [...figure.querySelectorAll("circle")].pop();
    const image = new Image();
    image.src = await figureAsPng(figure);
    await image.decode();
    const canvas = document.createElement("canvas");
    canvas.width = image.naturalWidth, canvas.height = image.naturalHeight;
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const scale = canvas.width / box.width;
    const at = context.getImageData(scale * grain.getAttribute("cx"), scale * grain.getAttribute("cy"), 1, 1).data;
    const hex = "#" + [...at].slice(0, 3).map((v) => v.toString(16).padStart(2, "0")).join("");
    document.body.dataset.png = image.src.slice(0, 22) + " " + canvas.width + " " +
      (Math.abs(canvas.height / canvas.width - box.height / box.width) < 0.001) + " " +
      (hex === grain.getAttribute("fill"));
  })();</script>)");
  const Opened opened = open_in_browser(asked, scratch.path(), "--virtual-time-budget=5000");
  CHECK(opened.messages == "");
  CHECK_THAT(opened.page, Catch::Contains("data-png=\"data:image/png;base64, 1800 true true\""));
  CHECK(count_of(opened.page, ">PNG</button>") == count_of(opened.page, "<figure"));
}
