#include "tools/diagnose/press_model.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "tests/tools/diagnose/press_data.h"
#include "tools/diagnose/press_recording.h"
#include "tools/run/errors.h"

namespace hoof::tests {
namespace {

using tools::DataSet;
using tools::PressModel;

constexpr auto kFree = tools::Rollout::kFree;

std::vector<double> stated(const PressModel& model) {
  std::vector<double> values;
  for (const auto& doubt : model.doubtful()) values.push_back(doubt.value);
  return values;
}

bool has_effect(const PressModel& model, const std::string& name) {
  const auto& effects = model.effects();
  return std::any_of(effects.begin(), effects.end(),
                     [&](const auto* effect) { return effect->name == name; });
}

std::string reason(const PressModel& model, const std::string& name) {
  for (const auto& hidden : model.hidden_effects()) {
    if (hidden.effect == name) return hidden.reason;
  }
  return "";
}

TEST_CASE("doubtful numbers: shared where stated alike, a recording's own where it differs") {
  DataSet first = sand_set({{.name = "a.csv"}, {.name = "b.csv"}});
  first.recordings[1].setup.values["n"] = {1.4, 0.2};
  first.recordings[1].setup.values["surface_height"] = {-0.008, 0.001};
  DataSet second = sand_set({{.name = "c.csv"}});
  second.name = "second";
  second.setup.values["k_phi"] = second.recordings[0].setup.values["k_phi"] = {5e6, 1e6};
  const PressModel model({first, second});
  std::vector<std::string> names;
  for (const auto& doubt : model.doubtful()) names.push_back(doubt.name);
  CHECK(names == std::vector<std::string>{"k_c", "k_phi", "n", "surface_height@b.csv", "n@b.csv",
                                          "k_phi@second"});
  CHECK(std::isinf(model.doubtful()[0].low));  // k_c
  CHECK(model.doubtful()[1].low == 0);
  CHECK(std::isinf(model.doubtful()[3].low));
  CHECK(model.recordings() == 3);
  CHECK(model.channels(0) == std::vector<std::string>{"force"});
  // Each number acts on the recordings it was stated for, and on no other.
  const auto base = stated(model);
  for (std::size_t doubt = 0; doubt < names.size(); ++doubt) {
    auto moved = base;
    moved[doubt] = moved[doubt] == 0 ? 1e4 : moved[doubt] * 1.1;
    for (int recording = 0; recording < 3; ++recording) {
      const bool acts =
          model.predict(recording, moved, {}, kFree) != model.predict(recording, base, {}, kFree);
      const bool own_b = names[doubt].ends_with("@b.csv");
      const bool expected = own_b                            ? recording == 1
                            : names[doubt] == "k_phi@second" ? recording == 2
                            : names[doubt] == "k_phi"        ? recording != 2
                            : names[doubt] == "n"            ? recording != 1
                                                             : true;
      INFO(names[doubt] << " on recording " << recording);
      CHECK(acts == expected);
    }
  }
}

TEST_CASE("effects that the recordings cannot show are not tried, and it is said why") {
  SECTION("one press of one plate at one speed, nothing drawn back") {
    const PressModel model({sand_set({{.name = "a.csv"}})});
    for (const char* name :
         {"plate_size_law", "packing_change", "rate_dependence", "unload_hysteresis"}) {
      INFO(name);
      CHECK_FALSE(has_effect(model, name));
      CHECK_FALSE(reason(model, name).empty());
    }
    for (const char* name : {"cohesion", "hard_layer", "wall_confinement", "rig_compliance"}) {
      INFO(name);
      CHECK(has_effect(model, name));
      CHECK(reason(model, name).empty());
    }
    CHECK_FALSE(has_effect(model, "slip_sinkage"));
    CHECK_FALSE(has_effect(model, "spine_wear"));
    CHECK_FALSE(has_effect(model, "cogging_torque"));
  }
  SECTION("two of each") {
    const PressModel model({sand_set({{.name = "a.csv", .back_m = 0.01},
                                      {.name = "b.csv", .diameter_m = 0.05, .speed_m_s = 0.012}})});
    CHECK(model.hidden_effects().empty());
    for (const char* name :
         {"plate_size_law", "packing_change", "rate_dependence", "unload_hysteresis"}) {
      INFO(name);
      CHECK(has_effect(model, name));
    }
  }
  SECTION("two presses within one recording") {
    const PressModel model({sand_set({{.name = "a.csv", .cycles = 2}})});
    CHECK(has_effect(model, "packing_change"));
  }
  SECTION("a block shows the rig alone") {
    const PressModel model({block_set(200)});
    for (const auto* effect : model.effects()) {
      CHECK(effect->plug_in == sim::PlugIn::kRig);
    }
    CHECK(has_effect(model, "rig_compliance"));
    CHECK(reason(model, "cohesion") == "no press on sand");
  }
}

TEST_CASE("a rig of another kind is refused by name") {
  DataSet pendulum = sand_set({});
  pendulum.rig = tools::RigKind::kServoPendulum;
  CHECK_THROWS_WITH(PressModel({pendulum}),
                    Catch::Contains("press.toml") && Catch::Contains("servo_pendulum"));
}

TEST_CASE("effects act in the order of the catalogue, whatever that of the hypothesis") {
  const PressModel model({sand_set({{.name = "a.csv"}})});
  const auto cohesion = active("cohesion", {3000});
  const auto rate = active("rate_dependence", {40});
  const auto layer = active("hard_layer", {0.01, 3});
  const auto setup = stated(model);
  const auto forwards = model.predict(0, setup, std::vector{cohesion, layer, rate}, kFree);
  CHECK(model.predict(0, setup, std::vector{rate, layer, cohesion}, kFree) == forwards);
  // A rate multiplies the whole resistance, cohesion included; a layer the nominal strength alone.
  const auto without = model.predict(0, setup, std::vector{layer}, kFree);
  const double area_m2 = 0.0016 * 3.14159265358979;
  CHECK(forwards[0][400] == Approx((without[0][400] + 3000 * area_m2) * 1.12).epsilon(1e-3));
}

TEST_CASE("presses are counted through recordings and within them, a hovering plate is none") {
  std::vector<double> time_s, height_m;
  const std::vector<double> corners_m = {0.001,   -0.02,  0.001, 0.0002,
                                         -0.0005, 0.0005, -0.02, 0.001};
  for (std::size_t corner = 0; corner + 1 < corners_m.size(); ++corner) {
    for (int i = 0; i < 50; ++i) {
      time_s.push_back(0.02 * static_cast<double>(time_s.size()));
      height_m.push_back(corners_m[corner] + (corners_m[corner + 1] - corners_m[corner]) * i / 50);
    }
  }
  sim::PressPath path = tools::press_path(time_s, height_m);
  CHECK(tools::count_presses(path, 0.0, 3) == 5);
  CHECK(path.press.front() == 3);
  CHECK(path.press[49] == 3);
  CHECK(path.press[299] == 4);
  const PressModel model({sand_set({{.name = "a.csv", .cycles = 2}, {.name = "b.csv"}})});
  const auto drifting = active("packing_change", {0.1});
  const auto setup = stated(model);
  const auto ratio = [&](int recording, std::size_t sample) {
    return model.predict(recording, setup, std::vector{drifting}, kFree)[0][sample] /
           model.predict(recording, setup, {}, kFree)[0][sample];
  };
  CHECK(ratio(0, 400) == 1.0);
  CHECK(ratio(0, 1400) == Approx(1.1));
  CHECK(ratio(1, 400) == Approx(1.2));
}

TEST_CASE("height and speed: parabolas exactly, uneven times, missing samples bridged") {
  std::vector<double> time_s, height_m;
  for (int i = 0; i < 200; ++i) {
    time_s.push_back(3 + 0.01 * i + 0.002 * std::sin(1.7 * i));
    const double t = time_s.back() - 4;
    height_m.push_back(0.02 - 0.003 * t - 0.001 * t * t);
  }
  const auto path = tools::press_path(time_s, height_m);
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    const double t = time_s[i] - 4;
    CHECK(path.time_s[i] == time_s[i] - time_s[0]);
    CHECK(path.height_m[i] == Approx(height_m[i]).margin(1e-12));
    // Without noise a line over the neighbours: off by half a step at the ends.
    const bool inner = i > 0 && i + 1 < time_s.size();
    CHECK(path.speed_m_s[i] == Approx(0.003 + 0.002 * t).margin(inner ? 8e-6 : 2e-5));
  }
  auto holed = height_m;
  for (const std::size_t i : {0u, 50u, 51u, 199u}) holed[i] = NAN;
  const auto bridged = tools::press_path(time_s, holed);
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    CHECK(bridged.height_m[i] == Approx(height_m[i]).margin(5e-5));
  }
  const auto dead = tools::press_path(time_s, std::vector<double>(200, NAN));
  CHECK(dead.height_m[100] == 0);
}

TEST_CASE("a steady speed does not tremble, and a ramp of it is not cut") {
  // Rest, half a second of speeding up, four seconds at 8 mm/s. A neighbour on each side alone
  // would leave 4 um / (20 ms sqrt 2), 0.14 mm/s.
  for (const std::uint64_t seed : {5, 6, 7}) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    constexpr double kNoise_m = 4e-6, kSteady_m_s = 0.008;
    std::vector<double> time_s, height_m, speed_m_s;
    double depth_m = 0;
    for (int i = 0; i < 300; ++i) {
      const double t = 0.02 * i;
      time_s.push_back(t);
      speed_m_s.push_back(kSteady_m_s * std::clamp((t - 1) / 0.5, 0.0, 1.0));
      if (i > 0) depth_m += 0.01 * (speed_m_s[speed_m_s.size() - 2] + speed_m_s.back());
      height_m.push_back(-depth_m + kNoise_m * normal(random));
    }
    const auto path = tools::press_path(time_s, height_m);
    double steady = 0, ramp = 0;
    for (std::size_t i = 90; i < 290; ++i) {
      steady += std::pow(path.speed_m_s[i] - speed_m_s[i], 2) / 200;
    }
    for (std::size_t i = 48; i < 78; ++i) ramp += (path.speed_m_s[i] - speed_m_s[i]) / 30;
    // Seven neighbours leave 0.5 % of the speed, three 1.8 %; most samples are to have the seven.
    CHECK(std::sqrt(steady) < 0.01 * kSteady_m_s);
    CHECK(std::abs(ramp) < 0.01 * kSteady_m_s);
  }
}

TEST_CASE("a noisy height is smoothed along the path and not across its corner") {
  std::mt19937_64 random(3);  // noise seed
  std::normal_distribution<double> normal;
  for (const double noise_m : {0.0, 2e-5}) {
    std::vector<double> time_s, true_m, height_m;
    for (int i = -300; i <= 300; ++i) {
      time_s.push_back(0.02 * i);
      true_m.push_back(-0.02 + 0.01 * std::abs(0.02 * i));  // 10 mm/s down, then up
      height_m.push_back(true_m.back() + noise_m * normal(random));
    }
    const auto path = tools::press_path(time_s, height_m);
    double square_m2 = 0;
    for (std::size_t i = 0; i < 601; ++i) {
      square_m2 += std::pow(path.height_m[i] - true_m[i], 2) / 601;
      CHECK(std::abs(path.height_m[i] - true_m[i]) <= 4.5 * noise_m + 1e-15);
      const double blurred_s = noise_m > 0 ? 0.1 : 0.02;
      if (std::abs(time_s[i]) > blurred_s + 1e-9) {
        CHECK(path.speed_m_s[i] == Approx(time_s[i] < 0 ? 0.01 : -0.01).margin(noise_m * 50));
      }
    }
    // Seven points of a parabola leave the root of 3/7 of the noise.
    CHECK(std::sqrt(square_m2) <= 0.75 * noise_m + 1e-15);
  }
}

TEST_CASE("samples without height or force are not compared; the rest is not disturbed") {
  DataSet set = sand_set({{.name = "a.csv"}});
  set.recordings[0].channels["force"][100] = NAN;
  DataSet holed = set;
  holed.recordings[0].channels["position"][300] = NAN;
  const PressModel whole({set}), model({holed});
  const auto expected = whole.predict(0, stated(whole), {}, kFree)[0];
  const auto values = model.predict(0, stated(model), {}, kFree)[0];
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i == 100 || i == 300) {
      CHECK(std::isnan(values[i]));
    } else {
      CHECK(values[i] == Approx(expected[i]).epsilon(1e-6).margin(1e-9));
    }
  }
}

TEST_CASE(
    "a block: nominal stays at its height of contact, found from the lightly loaded samples") {
  std::vector<DataSet> sets = {block_set(200)};
  simulate_into(sets, {}, {active("rig_compliance", {5e-6})}, 0, 0, 1);
  // In the air before contact: not compared.
  sets[0].recordings[0].channels["position"][0] += 0.01;
  const PressModel model(sets);
  CHECK(model.channels(0) == std::vector<std::string>{"position"});
  const auto nominal = model.predict(0, {}, {}, kFree)[0];
  CHECK(std::isnan(nominal[0]));
  CHECK(nominal[200] == Approx(0.05).margin(0.03 * 0.001));
  for (std::size_t i = 1; i < nominal.size(); ++i) CHECK(nominal[i] == nominal[1]);
  const auto bent = model.predict(0, {}, std::vector{active("rig_compliance", {5e-6})}, kFree)[0];
  const auto& measured = sets[0].recordings[0].channels["position"];
  for (std::size_t i = 1; i < bent.size(); ++i) {
    CHECK(bent[i] == Approx(measured[i]).margin(1e-9));
  }
}

TEST_CASE("the way down to a block is not compared, its noisy first contact is") {
  std::mt19937_64 random(12);  // noise seed
  std::normal_distribution<double> normal;
  std::vector<double> time_s, height_m, force_N;
  for (int i = 0; i < 400; ++i) {
    time_s.push_back(0.02 * i);
    force_N.push_back(i < 50 ? 0.0 : 250 * std::sin(3.14159 * (i - 50) / 350));
    height_m.push_back(0.05 + (i < 25 ? 0.004 * (25 - i) / 25 : 0.0) - 4e-6 * force_N.back() +
                       8e-6 * normal(random));
    force_N.back() += 0.5 * normal(random);
  }
  const auto bears = tools::on_block(time_s, height_m, force_N);
  for (std::size_t i = 0; i < 400; ++i) {
    INFO(i);
    if (i < 24) CHECK_FALSE(bears[i]);
    if (i >= 25) CHECK(bears[i]);
  }
}

TEST_CASE("a block's stated height is used where it can be the block's, else not") {
  for (const double stated_m : {0.05, -0.009}) {
    DataSet set = block_set(200);
    set.setup.values["surface_height"] = {stated_m, 0.0005};
    set.recordings[0].setup = set.setup;
    std::vector<DataSet> sets = {set};
    const PressModel model(sets);
    CHECK(model.doubtful().size() == (stated_m > 0 ? 1u : 0u));
  }
}

TEST_CASE("notes: what cannot show, and how far presses that should be alike differ") {
  std::vector<DataSet> sets = {sand_set({{.name = "a.csv", .back_m = 0.01},
                                         {.name = "b.csv", .deepest_m = 0.02},
                                         {.name = "c.csv", .diameter_m = 0.05}})};
  simulate_into(sets, {0, 3e6, 1}, {}, 0, 0, 1);
  {
    const PressModel model(sets);
    CHECK(model.repeat_scatter_N(0.04) < 0.05);
    CHECK(std::isnan(model.repeat_scatter_N(0.025)));  // one press alone
  }
  // Linear in depth: a press that is 10 % stronger is off by 10 % of a force whose rms is
  // its largest over the root of three; the other one's mean is over the shallower range alone.
  for (double& force : sets[0].recordings[0].channels["force"]) force *= 1.1;
  const PressModel model(sets);
  const double rms_N = 3e6 * 5.0265e-3 * 0.02 / std::sqrt(3.0);
  CHECK(model.repeat_scatter_N(0.04) == Approx(0.1 * rms_N).epsilon(0.01));
  std::vector<std::string> texts;
  for (const auto& note : model.notes()) texts.push_back(note.text);
  REQUIRE(texts.size() == 2);
  CHECK_THAT(texts[0], Catch::Contains("rate_dependence cannot show here: one speed"));
  CHECK_THAT(texts[1], Catch::Contains("b = 0.04 m differ from each other by"));
}

TEST_CASE("regions: depth, drawn back, fast; each sample of loading or unloading in one of them") {
  const PressModel model({sand_set({{.name = "a.csv", .back_m = 0.01}})});
  const auto conditions = model.conditions(0);
  std::vector<bool> loading, unloading;
  bool deep = false;
  for (const auto& condition : conditions) {
    REQUIRE(condition.holds.size() == model.recording(0).time_s.size());
    if (condition.text.starts_with("unloading")) unloading = condition.holds;
    if (condition.text.starts_with("loading")) loading = condition.holds;
    if (condition.text == "surface_height - position > 0.015") deep = true;
  }
  CHECK(deep);
  REQUIRE(!loading.empty());
  REQUIRE(!unloading.empty());
  const auto& heights = model.recording(0).channels.at("position");
  for (std::size_t i = 0; i < heights.size(); ++i) {
    CHECK(int(loading[i]) + int(unloading[i]) == int(-0.009 - heights[i] > 1e-6));
  }
  CHECK(std::count(unloading.begin(), unloading.end(), true) > 100);
  for (const auto& condition : PressModel({block_set(200)}).conditions(0)) {
    CHECK(condition.text.starts_with("force > "));
  }
}

}  // namespace
}  // namespace hoof::tests
