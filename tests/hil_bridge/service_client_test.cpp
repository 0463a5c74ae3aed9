#include "hil_bridge/service_client.h"

#include <catch2/catch.hpp>

#include "firmware/protocol/codec.h"
#include "firmware/protocol/protocol_hash.h"
#include "tests/hil_bridge/service_foot.h"

using namespace hoof;
using namespace firmware::protocol;
using bridge::ServiceError;
using tests::ServiceFoot;

namespace {

std::uint8_t index_of(std::string_view name) {
  const auto table = firmware::app::parameter_table();
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table[i].name == name) return static_cast<std::uint8_t>(i);
  }
  FAIL("no parameter " << name);
  return 0;
}

}  // namespace

TEST_CASE("Parameters are read, written, stored and set back") {
  ServiceFoot foot;
  const std::uint8_t kp = index_of("toe_kp_Nm_rad");
  foot.client.connect();
  CHECK(foot.client.read_parameter(kp) == 250.0f);
  foot.client.write_parameter(kp, 200.0f);
  CHECK(foot.client.read_parameter(kp) == 200.0f);
  CHECK(foot.client.store_parameters() == 1);
  CHECK(foot.client.store_parameters() == 2);
  foot.client.default_parameters();
  CHECK(foot.client.read_parameter(kp) == 250.0f);
  firmware::app::Parameters stored;
  foot.storage.load(stored);
  CHECK(stored.control.toe.kp_Nm_rad == 200.0f);
}

TEST_CASE("A refusal says what was refused and why") {
  ServiceFoot foot;
  foot.client.connect();
  CHECK_THROWS_WITH(foot.client.write_parameter(index_of("toe_kp_Nm_rad"), 501.0f),
                    "the foot refused 'write_parameter': out_of_range");
  CHECK_THROWS_WITH(foot.client.read_parameter(250),
                    "the foot refused 'read_parameter': no_such_index");
  CHECK_THROWS_WITH(foot.client.calibrate_zero(1),
                    "the foot refused 'calibrate_zero': nothing_there");  // no drive answers
  foot.board.pressed = true;
  foot.millisecond();
  CHECK_THROWS_WITH(foot.client.write_parameter(index_of("toe_kp_Nm_rad"), 1.0f),
                    "the foot refused 'write_parameter': wrong_mode");
}

TEST_CASE("A lapsed connection and a counter that others moved on are mended unseen") {
  ServiceFoot foot;
  foot.client.connect();
  const std::uint8_t kp = index_of("toe_kp_Nm_rad");
  for (int i = 0; i < 1200; ++i) foot.millisecond();
  CHECK(foot.client.read_parameter(kp) == 250.0f);
  for (int i = 0; i < 1200; ++i) foot.millisecond();
  foot.client.write_parameter(kp, 210.0f);
  // Somebody stops the foot, which counts.
  foot.desk.send(encode(SupervisorOrder{9, Order::kStop, 0, 0, 1}));
  for (int i = 0; i < 5; ++i) foot.millisecond();
  foot.client.write_parameter(kp, 220.0f);
  CHECK(foot.client.read_parameter(kp) == 220.0f);
}

TEST_CASE("Nobody there, and a foot that falls silent, are told apart from a refusal") {
  ServiceFoot foot;
  foot.foot_runs = false;
  CHECK_THROWS_WITH(foot.client.connect(), Catch::Contains("nobody answers within 2000 ms"));
  foot.foot_runs = true;
  foot.client.connect();
  foot.foot_runs = false;
  CHECK_THROWS_WITH(foot.client.read_parameter(0),
                    Catch::Contains("did not answer 'read_parameter' within 2000 ms"));
}

TEST_CASE("The fault log is read record by record and erased") {
  ServiceFoot foot;
  foot.client.connect();
  CHECK(foot.client.stored_status(Status::kLogUsed) == 0u);
  for (int i = 0; i < 30; ++i) foot.millisecond();
  foot.board.pressed = true;
  for (int i = 0; i < 300; ++i) foot.millisecond();
  CHECK(foot.client.stored_status(Status::kLogUsed) == 1u);
  const auto record = foot.client.read_fault(0);
  REQUIRE(record.has_value());
  CHECK(record->faults == firmware::control::fault::kEmergencyStop);
  CHECK(record->mode == firmware::control::Mode::kOff);
  CHECK(record->trace_count == firmware::app::TraceRing::kTicks);
  CHECK_THROWS_AS(foot.client.read_fault(1), ServiceError);
  CHECK_THROWS_WITH(foot.client.erase_fault_log(),
                    "the foot refused 'erase_fault_log': wrong_mode");
}

TEST_CASE("A foot without storage is told from a log that is empty") {
  ServiceFoot foot(false);
  foot.client.connect();
  CHECK_FALSE(foot.client.stored_status(Status::kLogUsed).has_value());
  CHECK_THROWS_WITH(foot.client.store_parameters(),
                    "the foot refused 'store_parameters': no_storage");
}
