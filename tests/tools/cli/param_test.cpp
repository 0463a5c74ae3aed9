// hoof param and hoof faults, against a whole foot on a simulated bus.
#include "tools/cli/param.h"

#include <catch2/catch.hpp>
#include <sstream>

#include "tests/hil_bridge/service_foot.h"
#include "tools/cli/faults.h"
#include "tools/run/errors.h"

using namespace hoof;
using tests::ServiceFoot;

TEST_CASE("The list names every parameter with range and meaning; with a foot, its values") {
  std::ostringstream alone;
  tools::list_parameters(nullptr, alone);
  for (const auto& entry : firmware::app::parameter_table()) {
    CHECK_THAT(alone.str(), Catch::Contains(std::string(entry.name)));
    CHECK_THAT(alone.str(), Catch::Contains(std::string(entry.description)));
  }
  ServiceFoot foot;
  foot.client.connect();
  foot.client.write_parameter(0, 123.5f);
  std::ostringstream with_foot;
  tools::list_parameters(&foot.client, with_foot);
  CHECK_THAT(with_foot.str(), Catch::Contains("123.5"));
}

TEST_CASE("Setting checks all before it writes any") {
  ServiceFoot foot;
  foot.client.connect();
  std::ostringstream out;
  tools::set_parameters(
      foot.client, tools::parse_assignments({"toe_kp_Nm_rad=200", "toe_kd_Nm_s_rad=2.5"}), out);
  CHECK(out.str() == "toe_kp_Nm_rad = 200 Nm/rad\ntoe_kd_Nm_s_rad = 2.5 Nm s/rad\n");
  CHECK_THROWS_WITH(tools::parse_assignments({"toe_kp_Nm_rad=1", "toe_kd_Nm_s_rad=5.5"}),
                    "toe_kd_Nm_s_rad = 5.5: must be from 0 to 5 Nm s/rad");
  CHECK_THROWS_WITH(tools::parse_assignments({"toe_kp_Nm_rad"}),
                    "'toe_kp_Nm_rad': expected NAME=VALUE");
  CHECK_THROWS_WITH(tools::parse_assignments({"toe_kp_Nm_rad=x"}),
                    "'toe_kp_Nm_rad=x': the value is not a number");
  CHECK_THROWS_WITH(tools::parse_assignments({"toe_kp=1"}),
                    Catch::Contains("no parameter 'toe_kp'") && Catch::Contains("toe_kp_Nm_rad"));
  std::ostringstream got;
  tools::get_parameters(foot.client, {"toe_kp_Nm_rad"}, got);
  CHECK(got.str() == "toe_kp_Nm_rad = 200 Nm/rad\n");
  CHECK_THROWS_AS(tools::get_parameters(foot.client, {"nonsense"}, got), tools::UserError);
}

TEST_CASE("The fault log is printed with names, and with the ticks before on request") {
  ServiceFoot foot;
  foot.client.connect();
  for (int i = 0; i < 40; ++i) foot.millisecond();
  foot.board.pressed = true;
  for (int i = 0; i < 300; ++i) foot.millisecond();
  std::ostringstream brief;
  tools::print_fault_log(foot.client, false, brief);
  CHECK_THAT(brief.str(), Catch::Contains("last start: power on"));
  CHECK_THAT(brief.str(), Catch::Contains("1 of 13 places used, 0 faults lost"));
  CHECK_THAT(brief.str(), Catch::Contains("   0  emergency_stop in mode off, tick "));
  CHECK_THAT(brief.str(), !Catch::Contains("position, rad"));
  std::ostringstream full;
  tools::print_fault_log(foot.client, true, full);
  CHECK_THAT(full.str(), Catch::Contains("position, rad"));
  ServiceFoot forgetful(false);
  forgetful.client.connect();
  CHECK_THROWS_WITH(tools::print_fault_log(forgetful.client, false, brief),
                    "this foot has no storage, so it keeps no faults");
}
