// Moments as bytes, and the measures of a scene and of its mirror image.

#include "tools/fields/field_moment.h"

#include <catch2/catch.hpp>

#include "sim/terrain/random.h"
#include "tests/tools/fields/made_scene.h"
#include "tools/fields/field_measures.h"

using namespace hoof;
using namespace hoof::tests;
using namespace hoof::tools;

namespace {

std::string bytes_of(const FieldMoment& moment) {
  sim::ByteWriter out;
  put(out, moment);
  return out.take();
}

/// Grains at random under two boxes, in part pressed.
Made random_scene(std::uint64_t seed) {
  Made made({box_mesh({-0.03, -0.03, 0}, {0.03, -0.005, 0.01}),
             box_mesh({-0.03, 0.005, 0}, {0.03, 0.03, 0.01})});
  sim::Random random(seed);
  const auto within = [&](double half) { return random.between(-half, half); };
  for (int k = 0; k < 400; ++k) {
    made.grain({within(0.035), within(0.035), random.between(-0.028, -0.002)},
               random.between(1.5e-3, 2.2e-3), {within(0.1), within(0.1), within(0.1)});
  }
  // Overlaps of a tenth of a radius and less, as a bed has at most.
  for (std::uint32_t i = 0; i < 400; ++i) {
    for (std::uint32_t j = i + 1; j < 400; ++j) {
      const sim::Grain &a = made.moment.sand.grains[i], &b = made.moment.sand.grains[j];
      const double overlap_m = a.radius_m + b.radius_m - (a.p_m - b.p_m).norm();
      if (overlap_m > 0 && overlap_m < 1e-4) made.contact(i, j);
    }
  }
  for (std::uint32_t i = 0; i < 400; i += 7) {
    const Eigen::Vector3d spot_m = made.moment.sand.grains[i].p_m + Eigen::Vector3d(0, 0, 1.4e-3);
    made.press(i, spot_m.y() > 0, i % 2, spot_m, 2);
  }
  return made;
}

/// The scene in a mirror at x = 0 (axis 0) or y = 0 (axis 1).
Made mirrored(Made made, int axis) {
  const auto flip = [axis](Eigen::Vector3d& v) { v[axis] = -v[axis]; };
  for (sim::Grain& g : made.moment.sand.grains) flip(g.p_m), flip(g.v_m_s);
  for (sim::MeshTouch& t : made.moment.touches) {
    flip(t.p_W_m), flip(t.to_grain_m), flip(t.f_normal_N), flip(t.f_tangential_N);
  }
  for (sim::TriangleMesh& mesh : made.setting.shape.meshes) {
    for (Eigen::Vector3d& v : mesh.vertices_m) flip(v);
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  }
  return made;
}

}  // namespace

TEST_CASE("a moment comes back from its bytes, and half of them are refused") {
  FieldMoment moment = random_scene(1).moment;
  moment.name = "after 20 ms";
  moment.time_s = 1.25, moment.depth_m = -0.003;
  moment.foot_m = {1, 2, 3}, moment.ground_N = {4, 5, 6};
  const std::string bytes = bytes_of(moment);
  sim::ByteReader in(bytes);
  const FieldMoment again = get_moment(in);
  CHECK(in.at_end());
  CHECK(bytes_of(again) == bytes);
  CHECK(again.name == moment.name);
  CHECK(again.touches.size() == moment.touches.size());
  sim::ByteReader half(std::string_view(bytes).substr(0, bytes.size() / 2));
  CHECK_THROWS_WITH(get_moment(half), "is truncated");
}

TEST_CASE("a mirror changes no measure but the sign of what goes forward") {
  const int axis = GENERATE(0, 1);
  const std::uint64_t seed = GENERATE(11u, 12u);
  CAPTURE(axis, seed);
  const Made made = random_scene(seed), image = mirrored(made, axis);
  const FieldScene scene(made.setting, made.moment), other(image.setting, image.moment);
  Made before = made, image_before = image;
  before.moment.touches.clear(), image_before.moment.touches.clear();
  const FieldScene contact(before.setting, before.moment),
      image_contact(image_before.setting, image_before.moment);
  const auto a = measure_fields(scene, contact).flatten();
  const auto b = measure_fields(other, image_contact).flatten();
  REQUIRE(a.size() == b.size());
  int compared = 0;
  for (const auto& [key, value] : a.items()) {
    // The largest against x is the smallest along it.
    if (!value.is_number() || key.find("at_spines_max") != std::string::npos) continue;
    const bool turns = axis == 0 && (key.find("rearward") != std::string::npos ||
                                     key.find("box_xz") != std::string::npos);
    INFO(key);
    const double wanted = value.get<double>(), got = b[key].get<double>();
    // Sums in another order, cells whose middle lies on a border of the other image.
    CHECK(got == Approx(turns ? -wanted : wanted).epsilon(1e-6).margin(1e-12));
    ++compared;
  }
  CHECK(compared > 60);
  CHECK(a["/arch/gap_mean_width_m"] == Approx(0.010));
  CHECK(a["/arch/gap_area_m2"] == Approx(0.060 * 0.010));
}

TEST_CASE("the measures of a moment have no value that is not a number") {
  Made empty({box_mesh({-0.03, -0.03, 0}, {0.03, 0.03, 0.01})});
  const FieldScene scene(empty.setting, empty.moment);
  const auto j = measure_fields(scene, scene);
  CHECK(j["pressure"]["spine_load_share_ratio"].is_null());
  CHECK(j["stress"]["bulb_depth_m"].is_null());
  CHECK(j["packing"]["dilation_ratio"].is_null());
  CHECK_FALSE(field_headline(j).empty());
}
