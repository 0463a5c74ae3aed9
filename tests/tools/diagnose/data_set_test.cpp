#include "tools/diagnose/data_set.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/tools/diagnose/data_files.h"

using namespace hoof::tools;
using namespace hoof::tests;

namespace {

DataSet read_pendulum(const std::string& toml, const std::string& csv) {
  const DataFolder folder;
  folder.write("a.csv", csv);
  folder.write("b.csv", csv);
  return read_data_set(folder.write("set.toml", toml));
}

}  // namespace

TEST_CASE("A data set is read as it is written") {
  const DataSet set = read_pendulum(kPendulumToml, kPendulumCsv);
  CHECK(set.name == "arm");
  CHECK(set.rig == RigKind::kServoPendulum);
  CHECK(set.noise == std::map<std::string, double>{{"position", 0.001}});
  CHECK(set.setup.law == DriveLaw::kDuty);
  CHECK(set.setup.find("kp_duty") == nullptr);
  CHECK(set.setup.value_or("payload_mass", -1) == 0.5);
  CHECK(set.setup.find("arm_mass")->sigma == 0.01);
  CHECK(set.setup.value_or("gravity", -1) == 9.81);
  REQUIRE(set.recordings.size() == 2);

  const Recording& a = set.recordings[0];
  CHECK(a.name == "a.csv");
  CHECK_FALSE(a.holdout);
  CHECK(a.setup.value_or("kp_duty", -1) == 100);
  CHECK(a.setup.find("coulomb")->sigma == 0.03);
  CHECK(a.time_s == std::vector<double>{0, 0.1, 0.2, 0.3, 0.4});
  CHECK(a.channels.size() == 2);
  CHECK(a.channels.at("position_goal") == std::vector<double>{0, 0.1, 0.2, 0.3, 0.4});
  CHECK(a.channels.at("position")[1] == 0.05);
  CHECK(std::isnan(a.channels.at("position")[2]));
  CHECK(std::isnan(a.channels.at("position")[3]));

  // An override states the value whole: its doubt is not that of [setup].
  const Recording& b = set.recordings[1];
  CHECK(b.holdout);
  CHECK(b.setup.value_or("kp_duty", -1) == 400);
  CHECK(b.setup.value_or("coulomb", -1) == 0.05);
  CHECK(b.setup.find("coulomb")->sigma == 0);
  CHECK(b.time_s == std::vector<double>{0.2, 0.3});
  CHECK(b.channels.at("position") == std::vector<double>{1.25, 1.75});
  CHECK(b.channels.at("position_goal") == std::vector<double>{0.2, 0.3});
}

TEST_CASE("How a CSV file is written does not matter") {
  const std::vector<double> time_s = {0, 0.1, 0.2, 0.3, 0.4};
  const std::string windows = [] {
    std::string text;
    for (const char c : kPendulumCsv) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
    return text;
  }();
  CHECK(read_pendulum(kPendulumToml, windows).recordings[0].time_s == time_s);
  CHECK(read_pendulum(kPendulumToml, "\xEF\xBB\xBF" + kPendulumCsv).recordings[0].time_s == time_s);
  // Comments and empty lines anywhere, no line break at the end.
  std::string text = replaced(kPendulumCsv, "0.2,0.2", "\n  # a pause\n0.2,0.2");
  text.pop_back();
  CHECK(read_pendulum(kPendulumToml, text).recordings[0].time_s == time_s);
  // Quotes, blanks, signs, exponents; text in a column nobody asked for.
  const std::string loose =
      "\"t_s\", goal ,\"pos\",pos_deg,\"a \"\"note\"\", long\"\n"
      "-1e-1,\t+0.5,\"2.5e-3\", 1,\"x, y\"\n+.5,NAN,-nan,2,\n";
  const DataSet set = read_pendulum(replaced(kPendulumToml, "[0.15, 0.35]", "[-1, 1]"), loose);
  CHECK(set.recordings[0].time_s == std::vector<double>{-0.1, 0.5});
  CHECK(set.recordings[0].channels.at("position_goal")[0] == 0.5);
  CHECK(set.recordings[0].channels.at("position")[0] == 0.0025);
  CHECK(std::isnan(set.recordings[0].channels.at("position_goal")[1]));
  CHECK(std::isnan(set.recordings[0].channels.at("position")[1]));
}

TEST_CASE("Numbers of a data set do not depend on the locale") {
  const char* const comma_locales[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE", "nl_NL.UTF-8"};
  for (const char* name : comma_locales) {
    if (std::setlocale(LC_ALL, name) != nullptr) break;
  }
  const DataSet set = read_pendulum(kPendulumToml, kPendulumCsv);
  std::setlocale(LC_ALL, "C");
  CHECK(set.recordings[0].channels.at("position")[1] == 0.05);
}

TEST_CASE("A plate is a disc or a rectangle, whichever was said last") {
  const DataFolder folder;
  folder.write("press.csv", kSandCsv);
  const DataSet set = read_data_set(folder.write(
      "set.toml", kSandToml + "[[recording]]\ndata = \"press.csv\"\nrole = \"holdout\"\n"
                              "setup = { diameter = 0.08 }\n"));
  CHECK(set.rig == RigKind::kPlateSand);
  CHECK(set.recordings[0].channels.at("position") == std::vector<double>{0.01, 0, -0.01});
  CHECK(set.recordings[0].channels.at("force") == std::vector<double>{0, 1.5, 20});
  CHECK(set.recordings[0].setup.find("k_c")->value == -10);
  CHECK(set.recordings[0].setup.find("diameter") == nullptr);
  CHECK(set.recordings[1].setup.find("width") == nullptr);
  CHECK(set.recordings[1].setup.find("length") == nullptr);
  CHECK(set.recordings[1].setup.value_or("diameter", -1) == 0.08);
}

TEST_CASE("The press on a rigid block needs no soil") {
  const DataFolder folder;
  folder.write("press.csv", kSandCsv);
  const DataSet set = read_data_set(folder.write("set.toml", R"(format = 1
name = "block"
rig = "rigid_press"
channels = { time = "t", position = "z_mm", force = "fz" }
recording = [ { data = "press.csv", role = "fit" } ]
)"));
  CHECK(set.rig == RigKind::kRigidPress);
  CHECK(set.recordings.at(0).channels.at("force").size() == 3);
}

TEST_CASE("A recording of the project's own is a folder") {
  const DataFolder folder;
  folder.write("runs/one/recording.json", "{}");
  const DataSet set = read_data_set(folder.write("set.toml", R"(format = 1
name = "toes"
rig = "foot_hil"
[[recording]]
session = "runs/one"
role = "fit"
)"));
  CHECK(set.rig == RigKind::kFootHil);
  CHECK(set.recordings.at(0).path == folder.path() / "runs/one");
  CHECK(set.recordings.at(0).channels.empty());
}

TEST_CASE("Other laws need other keys") {
  const std::string impedance =
      replaced(replaced(replaced(kPendulumToml, "\"duty\"", "\"impedance\""),
                        "counts_per_rad = 651.9\n", "kp = 5\nkd = 0\ntorque_limit = 2\n"),
               "supply_voltage = 7.4\n", "");
  CHECK(read_pendulum(impedance, kPendulumCsv).setup.law == DriveLaw::kImpedance);
  const std::string torque = replaced(replaced(kPendulumToml, "\"duty\"", "\"torque\""),
                                      "position_goal = \"goal\"", "torque = \"goal\"");
  const DataSet set = read_pendulum(torque, kPendulumCsv);
  CHECK(set.setup.law == DriveLaw::kTorque);
  CHECK(set.recordings[0].has("torque"));
}
