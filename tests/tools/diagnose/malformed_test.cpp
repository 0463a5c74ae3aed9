// Every malformed data set gets one line that names file, place, value and what is allowed.
#include <catch2/catch.hpp>

#include "tests/tools/diagnose/data_files.h"
#include "tools/diagnose/data_set.h"
#include "tools/run/errors.h"

using namespace hoof::tools;
using namespace hoof::tests;

namespace {

/// One replacement in a sound data set, and what must be said of it.
struct Case {
  std::string from, to;
  std::string message;
};

std::string complaint(const DataFolder& folder) {
  try {
    read_data_set(folder.path() / "set.toml");
    return "(read without complaint)";
  } catch (const UserError& error) {
    return folder.shortened(error.what());
  }
}

void check_toml(const std::string& sound, const std::vector<Case>& cases) {
  for (const Case& c : cases) {
    const DataFolder folder;
    folder.write("a.csv", kPendulumCsv);
    folder.write("b.csv", kPendulumCsv);
    folder.write("press.csv", kSandCsv);
    folder.write("set.toml", replaced(sound, c.from, c.to));
    INFO("written: " << c.to);
    CHECK(complaint(folder) == c.message);
  }
}

void check_csv(const std::vector<Case>& cases) {
  for (const Case& c : cases) {
    const DataFolder folder;
    folder.write("a.csv", replaced(kPendulumCsv, c.from, c.to));
    folder.write("b.csv", kPendulumCsv);
    folder.write("set.toml", kPendulumToml);
    INFO("written: " << c.to);
    CHECK(complaint(folder) == c.message);
  }
}

}  // namespace

TEST_CASE("Malformed data sets: the head") {
  check_toml(
      kPendulumToml,
      {{"format = 1\n", "", "set.toml: format: missing; must be 1"},
       {"format = 1", "format = 2", "set.toml:1:1: format = 2: must be 1"},
       {"format = 1", "format = \"1\"", "set.toml:1:1: format = \"1\": must be 1"},
       {"name = \"arm\"\n", "", "set.toml: name: missing; must be a string that is not empty"},
       {"\"arm\"", "\"\"", "set.toml:2:1: name = \"\": must be a string that is not empty"},
       {"rig = \"servo_pendulum\"\n", "",
        "set.toml: rig: missing; must be servo_pendulum, plate_sand, rigid_press or foot_hil"},
       {"\"servo_pendulum\"", "\"servo_pendlum\"",
        "set.toml:3:1: rig = \"servo_pendlum\": must be servo_pendulum, plate_sand, rigid_press or "
        "foot_hil; did you mean servo_pendulum?"},
       {"\"servo_pendulum\"", "3",
        "set.toml:3:1: rig = 3: must be servo_pendulum, plate_sand, rigid_press or foot_hil"},
       {"format = 1", "format = 1\nsetupp = {}",
        "set.toml:2:1: setupp = {a table}: unknown key, did you mean setup?"},
       {"format = 1", "format = ",
        "set.toml:1:10: not TOML: Error while parsing key-value pair: expected value, saw '\\n'"},
       {"format = 1", "format = 1\nformat = 1",
        "set.toml:2:10: not TOML: Error while parsing key-value pair: cannot redefine existing "
        "integer 'format'"},
       {"format = 1", "[[recording",
        "set.toml:1:12: not TOML: Error while parsing table header: expected ']', saw '\\n'"}});
}

TEST_CASE("Malformed data sets: noise") {
  check_toml(kPendulumToml,
             {{"position = 0.001", "position = -0.001",
               "set.toml:4:11: noise.position = -0.001: must be a number, zero or above"},
              {"position = 0.001", "position = nan",
               "set.toml:4:11: noise.position = nan: must be a number, zero or above"},
              {"position = 0.001", "positon = 0.001",
               "set.toml:4:11: noise.positon = 0.001: unknown channel of rig servo_pendulum, did "
               "you mean position?"},
              {"{ position = 0.001 }", "0.001", "set.toml:4:1: noise = 0.001: must be a table"}});
}

TEST_CASE("Malformed data sets: setup") {
  const std::string value_rule = ", or { value = ..., sigma = ... }";
  check_toml(
      kPendulumToml,
      {{"armature", "armatur",
        "set.toml:11:1: setup.armatur = 0.002: unknown key, did you mean armature?"},
       {"payload_mass = 0.5\n", "",
        "set.toml:23:1: recording: a.csv: setup.payload_mass: missing; needed for rig = "
        "\"servo_pendulum\""},
       {"law = \"duty\"\n", "",
        "set.toml:23:1: recording: a.csv: setup.law: missing; must be duty, impedance or torque"},
       {"\"duty\"", "\"pwm\"",
        "set.toml:7:1: setup.law = \"pwm\": must be duty, impedance or torque"},
       {"\"duty\"", "\"impedance\"",
        "set.toml:24:1: recording: a.csv: setup.kp: missing; needed for law = \"impedance\""},
       {"supply_voltage = 7.4\n", "",
        "set.toml:23:1: recording: a.csv: setup.supply_voltage: missing; needed where no channel "
        "supply_voltage was recorded"},
       {"setup = { kp_duty = 100 }\n", "",
        "set.toml:24:1: recording: a.csv: setup.kp_duty: missing; needed for law = \"duty\""},
       {"armature = 0.002", "armature = \"small\"",
        "set.toml:11:1: setup.armature = \"small\": must be a number, zero or above" + value_rule},
       {"armature = 0.002", "armature = true",
        "set.toml:11:1: setup.armature = true: must be a number, zero or above" + value_rule},
       {"armature = 0.002", "armature = nan",
        "set.toml:11:1: setup.armature = nan: must be a number, zero or above" + value_rule},
       {"armature = 0.002", "armature = inf",
        "set.toml:11:1: setup.armature = inf: must be a number, zero or above" + value_rule},
       {"armature = 0.002", "armature = -0.002",
        "set.toml:11:1: setup.armature = -0.002: must be a number, zero or above" + value_rule},
       {"payload_length = 0.1", "payload_length = 0",
        "set.toml:9:1: setup.payload_length = 0: must be a number above zero" + value_rule},
       {"armature = 0.002", "armature = [0.002, 0.001]",
        "set.toml:11:1: setup.armature = [0.002, 0.001]: must be a number, zero or above" +
            value_rule},
       {"armature = 0.002", "armature = 2026-11-28",
        "set.toml:11:1: setup.armature = a date or time: must be a number, zero or above" +
            value_rule},
       {"sigma = 0.01 }", "sigma = -0.01 }",
        "set.toml:10:28: setup.arm_mass.sigma = -0.01: must be a number, zero or above"},
       {"sigma = 0.01 }", "sigma = nan }",
        "set.toml:10:28: setup.arm_mass.sigma = nan: must be a number, zero or above"},
       {", sigma = 0.01 }", " }",
        "set.toml:10:12: setup.arm_mass.sigma: missing; must be a number, zero or above"},
       {"value = 0.02, ", "",
        "set.toml:10:12: setup.arm_mass.value: missing; must be a number, zero or above"},
       {"value = 0.02", "value = -0.02",
        "set.toml:10:14: setup.arm_mass.value = -0.02: must be a number, zero or above"},
       {"sigma = 0.01 }", "sigm = 0.01 }",
        "set.toml:10:28: setup.arm_mass.sigm = 0.01: unknown key, did you mean sigma?"},
       {"kp_duty = 100 }", "kp_dut = 100 }",
        "set.toml:27:11: recording.setup.kp_dut = 100: unknown key, did you mean kp_duty?"},
       {"setup = { kp_duty = 100 }", "setup = 100",
        "set.toml:27:1: recording.setup = 100: must be a table"}});
}

TEST_CASE("Malformed data sets: plates and the project's own") {
  check_toml(kSandToml,
             {{"width = 0.05", "diameter = 0.05",
               "set.toml:6:1: setup.diameter = 0.05: must stand without width and length"},
              {"length = 0.1\n", "",
               "set.toml:17:1: recording: press.csv: setup.length: missing; needed beside width"},
              {"width = 0.05\nlength = 0.1\n", "",
               "set.toml:16:1: recording: press.csv: setup.diameter: missing; or width and length, "
               "of the plate"},
              {"n = 1.1\n", "",
               "set.toml:17:1: recording: press.csv: setup.n: missing; needed for rig = "
               "\"plate_sand\""},
              {"force = { column = \"fz\", scale = -1 }\n", "",
               "set.toml:17:1: recording: press.csv: channels.force: missing; needed for rig = "
               "\"plate_sand\""}});
}

TEST_CASE("Malformed data sets: recordings and channels") {
  check_toml(
      kPendulumToml,
      {{"data = \"a.csv\"\n", "",
        "set.toml:24:1: recording.data: missing; must be a string that is not empty"},
       {"\"a.csv\"", "\"c.csv\"", "set.toml:25:1: recording.data = \"c.csv\": no such file"},
       {"\"a.csv\"", "\".\"", "set.toml:25:1: recording.data = \".\": no such file"},
       {"role = \"fit\"\n", "", "set.toml:24:1: recording.role: missing; must be fit or holdout"},
       {"\"fit\"", "\"train\"",
        "set.toml:26:1: recording.role = \"train\": must be fit or holdout"},
       {"role = \"fit\"", "role = \"fit\"\nrol = 1",
        "set.toml:27:1: recording.rol = 1: unknown key, did you mean role?"},
       {"[0.15, 0.35]", "[0.35, 0.15]",
        "set.toml:33:1: recording.window = [0.35, 0.15]: its start must be before its end"},
       {"[0.15, 0.35]", "[2, 3]",
        "set.toml:33:1: recording.window = [2, 3]: must hold at least 2 samples; the file "
        "runs from 0 to 0.4 s"},
       {"[0.15, 0.35]", "[0.15, nan]",
        "set.toml:33:1: recording.window = [0.15, nan]: must be a list of 2 finite numbers"},
       {"[0.15, 0.35]", "[0.15]",
        "set.toml:33:1: recording.window = [0.15]: must be a list of 2 finite numbers"},
       {"[0.15, 0.35]", "0.15",
        "set.toml:33:1: recording.window = 0.15: must be a list of 2 finite numbers"},
       {"time = \"t_s\"\n", "",
        "set.toml:23:1: recording: a.csv: channels.time: missing; needed for rig = "
        "\"servo_pendulum\""},
       {"position_goal = \"goal\"\n", "",
        "set.toml:23:1: recording: a.csv: channels.position_goal: missing; needed for rig = "
        "\"servo_pendulum\", law = \"duty\""},
       {"position_goal = \"goal\"", "position_gaol = \"goal\"",
        "set.toml:21:1: channels.position_gaol = \"goal\": unknown channel of rig servo_pendulum, "
        "did you mean position_goal?"},
       {"position_goal = \"goal\"", "position_goal = \"gaol\"",
        "set.toml:21:1: channels.position_goal = \"gaol\": a.csv has no column gaol, did you mean "
        "goal?"},
       {"position_goal = \"goal\"", "position_goal = \"demand\"",
        "set.toml:21:1: channels.position_goal = \"demand\": a.csv has no column demand; its "
        "columns: "
        "t_s, goal, pos, pos_deg"},
       {"position_goal = \"goal\"", "position_goal = 2",
        "set.toml:21:1: channels.position_goal = 2: must be the name of a column, or { column = "
        "..., scale = ..., offset = ... }"},
       {"scale = 0.5", "scale = 0",
        "set.toml:35:34: recording.channels.position.scale = 0: must be a finite number other than "
        "zero"},
       {"scale = 0.5", "scale = inf",
        "set.toml:35:34: recording.channels.position.scale = inf: must be a finite number"},
       {"scale = 0.5", "factor = 0.5",
        "set.toml:35:34: recording.channels.position.factor = 0.5: unknown key; allowed: "
        "column, scale, offset"},
       {"column = \"pos_deg\", ", "",
        "set.toml:35:12: recording.channels.position.column: missing; must be a string that is not "
        "empty"}});
  const std::string head = kPendulumToml.substr(0, kPendulumToml.find("[[recording]]"));
  check_toml(head, {{"[channels]", "[channels]",
                     "set.toml: recording: missing; must be one [[recording]] or more"},
                    {"[channels]", "[recording]\ndata = \"a.csv\"\n[channels]",
                     "set.toml:19:2: recording = {a table}: must be a list of tables, "
                     "[[recording]]"}});
}

TEST_CASE("Malformed recordings") {
  const std::string number_rule =
      ": must be a finite number, or NaN or nothing where a sample is missing";
  check_csv(
      {{kPendulumCsv, "", "a.csv: empty; the first line must name the columns"},
       {kPendulumCsv, "# only a comment\n\n", "a.csv: empty; the first line must name the columns"},
       {kPendulumCsv, "t_s,goal,pos\n", "a.csv: 0 row(s) of numbers; at least 2 are needed"},
       {kPendulumCsv, "t_s,goal,pos\n0,0,0\n", "a.csv: 1 row(s) of numbers; at least 2 are needed"},
       {kPendulumCsv, "0,0,0\n1,0,0\n",
        "a.csv:1: begins with 0; the first line must name the columns"},
       {kPendulumCsv, "t_s;goal;pos\n0;0;0\n",
        "a.csv:1: columns are separated by semicolons; they must be separated by commas"},
       {kPendulumCsv, "t_s\tgoal\tpos\n0\t0\t0\n",
        "a.csv:1: columns are separated by tabs; they must be separated by commas"},
       {kPendulumCsv, std::string("t_s\0", 4),
        "a.csv: holds bytes of zero: not a CSV file in UTF-8 or ASCII"},
       {kPendulumCsv, "t_s,goal,pos\r0,0,0\r1,1,1\r",
        "a.csv:1: a carriage return inside the line; lines must end in LF or CR LF"},
       {"pos_deg", "pos", "a.csv:2: two columns are named pos: 3 and 4"},
       {"0.1,0.1,0.05,2", "0.1,0.1,0.05", "a.csv:4: 3 cells for 4 columns"},
       {"0.1,0.1,0.05,2", "0.1,0.1,0.05,2,", "a.csv:4: 5 cells for 4 columns"},
       {"0.4,0.4,0.30,5\n", "0.4,0.", "a.csv:7: 2 cells for 4 columns"},
       {"0.1,0.1,0.05,2", "0.1,fast,0.05,2", "a.csv:4: goal = \"fast\"" + number_rule},
       {"0.1,0.1,0.05,2", "0.1,inf,0.05,2", "a.csv:4: goal = \"inf\"" + number_rule},
       {"0.1,0.1,0.05,2", "0.1,1e999,0.05,2", "a.csv:4: goal = \"1e999\"" + number_rule},
       {"0.1,0.1,0.05,2", "0.1,0x10,0.05,2", "a.csv:4: goal = \"0x10\"" + number_rule},
       {"0.1,0.1,0.05,2", "0.1,0.1 rad,0.05,2", "a.csv:4: goal = \"0.1 rad\"" + number_rule},
       {"0.1,0.1,0.05,2", "0.1,\"0,1\",0.05,2", "a.csv:4: goal = \"0,1\"" + number_rule},
       {"0.1,0.1,0.05,2", "0.1,\"0.1,0.05,2", "a.csv:4: a quote that is not closed in its line"},
       {"0.1,0.1,0.05,2", "0.1,\"0.1\"x,0.05,2", "a.csv:4: text after a closing quote"},
       {"0.1,0.1,0.05,2", ",0.1,0.05,2", "a.csv:4: t_s: time is missing; every row needs it"},
       {"0.1,0.1,0.05,2", "NaN,0.1,0.05,2", "a.csv:4: t_s: time is missing; every row needs it"},
       {"0.2,0.2,NaN,3", "0.1,0.2,NaN,3",
        "a.csv:5: t_s: time 0.1 s follows 0.1 s of line 4; it must increase"},
       {"0.2,0.2,NaN,3", "0.05,0.2,NaN,3",
        "a.csv:5: t_s: time 0.05 s follows 0.1 s of line 4; it must increase"}});
}

TEST_CASE("Malformed data sets: files and folders that are not there") {
  const DataFolder folder;
  CHECK(complaint(folder) == "set.toml: cannot read: No such file or directory");
  folder.write("set.toml", "");
  CHECK(complaint(folder) == "set.toml: format: missing; must be 1");
  const std::string own =
      "format = 1\nname = \"toes\"\nrig = \"foot_hil\"\n"
      "[[recording]]\nsession = \"runs/one\"\nrole = \"fit\"\n";
  folder.write("set.toml", own);
  CHECK(complaint(folder) == "set.toml:5:1: recording.session = \"runs/one\": no such folder");
  std::filesystem::create_directories(folder.path() / "runs/one");
  CHECK(complaint(folder) ==
        "set.toml:5:1: recording.session = \"runs/one\": must be a folder that hoof wrote, with "
        "recording.json");
  folder.write("runs/one/recording.json", "{}");
  folder.write("set.toml", replaced(own, "session", "data"));
  CHECK(complaint(folder) ==
        "set.toml:5:1: recording.data = \"runs/one\": unknown key; allowed: session, role, "
        "setup");
  folder.write("set.toml", own + "setup = { kt = 1 }\n");
  CHECK(complaint(folder) ==
        "set.toml:7:11: recording.setup.kt = 1: unknown key; allowed: load, soil_stiffness, "
        "soil_yield, soil_friction, toe_coulomb, toe_viscous, hip_coulomb, hip_viscous, "
        "knee_coulomb, knee_viscous");
}
