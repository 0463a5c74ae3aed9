#include "tests/tools/diagnose/data_files.h"

#include <catch2/catch.hpp>

#include "tools/run/output_file.h"

namespace hoof::tests {

namespace fs = std::filesystem;

fs::path DataFolder::write(const std::string& name, const std::string& text) const {
  fs::create_directories((path() / name).parent_path());
  tools::write_file(path() / name, text);
  return path() / name;
}

std::string DataFolder::shortened(std::string text) const {
  const std::string prefix = path().string() + "/";
  for (std::size_t at = 0; (at = text.find(prefix)) != std::string::npos;) {
    text.erase(at, prefix.size());
  }
  return text;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  INFO("looked for: " << from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

const std::string kPendulumToml = R"(format = 1
name = "arm"
rig = "servo_pendulum"
noise = { position = 0.001 }

[setup]
law = "duty"
payload_mass = 0.5
payload_length = 0.1
arm_mass = { value = 0.02, sigma = 0.01 }
armature = 0.002
coulomb = { value = 0.03, sigma = 0.03 }
viscous = 0.01
counts_per_rad = 651.9
kt = 0.35
resistance = 3.4
supply_voltage = 7.4

[channels]
time = "t_s"
position_goal = "goal"
position = "pos"

[[recording]]
data = "a.csv"
role = "fit"
setup = { kp_duty = 100 }

[[recording]]
data = "b.csv"
role = "holdout"
setup = { kp_duty = 400.0, coulomb = 0.05 }
window = [0.15, 0.35]
[recording.channels]
position = { column = "pos_deg", scale = 0.5, offset = -0.25 }
)";

const std::string kPendulumCsv = R"(# recorded on a bench
t_s,goal,pos,pos_deg
0.0,0.0,0.00,1
0.1,0.1,0.05,2
0.2,0.2,NaN,3
0.3,0.3,,4
0.4,0.4,0.30,5
)";

const std::string kSandToml = R"(format = 1
name = "sand"
rig = "plate_sand"

[setup]
width = 0.05
length = 0.1
surface_height = 0.0
k_c = { value = -10.0, sigma = 2e4 }
k_phi = 4e6
n = 1.1

[channels]
time = "t"
position = { column = "z_mm", scale = 0.001 }
force = { column = "fz", scale = -1 }

[[recording]]
data = "press.csv"
role = "fit"
)";

const std::string kSandCsv = "t,z_mm,fz\n0,10,-0\n1,0,-1.5\n2,-10,-20\n";

}  // namespace hoof::tests
