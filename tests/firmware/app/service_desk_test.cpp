// Parameters, calibration and fault log over the bus, through the whole loop.
#include <bit>
#include <catch2/catch.hpp>
#include <limits>

#include "hal/in_process/ram_flash.h"
#include "tests/firmware/app/loop_bench.h"

using namespace hoof::firmware;
using app::test::calibrated;
using app::test::LoopBench;
using control::Mode;
using protocol::Order;
using protocol::OrderResult;
using protocol::ParameterWrite;
using protocol::Service;
using protocol::ServiceRequest;
using protocol::ServiceResult;
using protocol::Status;
namespace fault = control::fault;

namespace {

constexpr std::size_t kSectorWords = 4096;

/// A foot with flash, connected to supervisor 1.
struct Shop {
  hoof::hal::RamFlash flash;
  app::Storage storage;
  LoopBench bench;

  explicit Shop(hoof::hal::RamFlash memory = hoof::hal::RamFlash({kSectorWords, kSectorWords,
                                                                  kSectorWords}),
                hoof::hal::ResetCause cause = hoof::hal::ResetCause::kPowerOn)
      : flash(std::move(memory)), storage(flash), bench(loaded(), &storage, cause) {
    bench.run(2);
    bench.connect();
    bench.run(2);
  }

  /// What a board does at its start; where nothing was stored, a rig with calibrated encoders.
  app::Parameters loaded() {
    app::Parameters parameters;
    const app::LoadReport& report = storage.load(parameters);
    return report.result == app::LoadResult::kEmpty ? calibrated(parameters) : parameters;
  }

  protocol::ServiceAnswer write(const char* name, float value, std::uint8_t who = 1) {
    return write_at(index_of(name), std::bit_cast<std::uint32_t>(value), who);
  }
  protocol::ServiceAnswer write_at(std::uint8_t index, std::uint32_t bits, std::uint8_t who = 1) {
    const auto answer = bench.ask(ParameterWrite{who, index, bits, bench.counter});
    follow(answer);
    return answer;
  }
  protocol::ServiceAnswer ask(Service service, std::uint8_t index = 0, std::uint16_t offset = 0,
                              std::uint8_t who = 1) {
    const auto answer = bench.ask(ServiceRequest{who, service, index, offset, 0, bench.counter});
    if (service != Service::kReadParameter && service != Service::kReadStatus &&
        service != Service::kReadFaultLog) {
      follow(answer);
    }
    return answer;
  }
  float read(const char* name) {
    const auto answer = ask(Service::kReadParameter, index_of(name));
    REQUIRE(answer.result == ServiceResult::kDone);
    return std::bit_cast<float>(answer.value);
  }
  std::uint32_t status(Status what) {
    const auto answer = ask(Service::kReadStatus, static_cast<std::uint8_t>(what));
    REQUIRE(answer.result == ServiceResult::kDone);
    return answer.value;
  }
  static std::uint8_t index_of(const char* name) {
    const auto table = app::parameter_table();
    for (std::size_t i = 0; i < table.size(); ++i) {
      if (table[i].name == name) return static_cast<std::uint8_t>(i);
    }
    FAIL("no parameter " << name);
    return 0;
  }

 private:
  void follow(const protocol::ServiceAnswer& answer) {
    switch (answer.result) {
      case ServiceResult::kBadCounter:
        bench.counter = static_cast<std::uint8_t>(answer.value);
        break;
      case ServiceResult::kNotConnected:
      case ServiceResult::kNotOwner:
      case ServiceResult::kUnknownService:
        break;
      default:
        ++bench.counter;
    }
  }
};

}  // namespace

TEST_CASE("Every parameter is read and written over the bus") {
  Shop shop;
  const auto table = app::parameter_table();
  CHECK(shop.status(Status::kParameterCount) == table.size());
  CHECK(shop.status(Status::kParameterTableHash) == app::parameter_table_hash());
  for (std::uint8_t i = 0; i < table.size(); ++i) {
    INFO(table[i].name);
    for (const float value : {table[i].maximum, table[i].minimum, table[i].default_value()}) {
      const auto bits = std::bit_cast<std::uint32_t>(value);
      const auto answer = shop.write_at(i, bits);
      REQUIRE(answer.result == ServiceResult::kDone);
      CHECK(answer.index == i);
      CHECK(shop.ask(Service::kReadParameter, i).value == bits);
    }
  }
  CHECK(shop.ask(Service::kReadParameter, static_cast<std::uint8_t>(table.size())).result ==
        ServiceResult::kNoSuchIndex);
  CHECK(shop.write_at(static_cast<std::uint8_t>(table.size()), 0).result ==
        ServiceResult::kNoSuchIndex);
  CHECK(shop.bench.loop->faults() == 0);
}

TEST_CASE("A value out of range, infinite or not a number is refused and changes nothing") {
  Shop shop;
  const float before = shop.read("toe_kp_Nm_rad");
  for (const float bad :
       {-1.0f, 500.1f, std::numeric_limits<float>::infinity(),
        -std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    CHECK(shop.write("toe_kp_Nm_rad", bad).result == ServiceResult::kOutOfRange);
  }
  CHECK(shop.read("toe_kp_Nm_rad") == before);
}

TEST_CASE("A written parameter acts: half the stiffness gives way twice as far") {
  double deflection_rad[2] = {};
  for (int half = 0; half < 2; ++half) {
    Shop shop;
    if (half == 1) CHECK(shop.write("toe_kp_Nm_rad", 125.0f).result == ServiceResult::kDone);
    REQUIRE(shop.bench.order(Order::kReady, 0.3f) == OrderResult::kAccepted);
    REQUIRE(shop.bench.run_until(Mode::kReady) > 0);
    shop.bench.run(1500);
    const double before_rad = shop.bench.toe.plant.q_rad;
    shop.bench.toe.plant.load_Nm = -1.5;
    shop.bench.run(400);
    deflection_rad[half] = shop.bench.toe.plant.q_rad - before_rad;
  }
  // As in the test of the gain by parameter: friction takes a share of both.
  CHECK(deflection_rad[1] / deflection_rad[0] == Approx(2.0).epsilon(0.1));
}

TEST_CASE("What changes something is done in mode off only; reading at any time") {
  Shop shop;
  REQUIRE(shop.bench.order(Order::kReady, 0.1f) == OrderResult::kAccepted);
  REQUIRE(shop.bench.run_until(Mode::kReady) > 0);
  const std::size_t before = shop.flash.operations();
  CHECK(shop.write("toe_kp_Nm_rad", 100.0f).result == ServiceResult::kWrongMode);
  for (const Service service : {Service::kStoreParameters, Service::kDefaultParameters,
                                Service::kEraseFaultLog, Service::kCalibrateZero}) {
    CHECK(shop.ask(service, 1).result == ServiceResult::kWrongMode);
  }
  CHECK(shop.read("toe_kp_Nm_rad") == 250.0f);
  CHECK(shop.flash.operations() == before);
  CHECK(shop.bench.loop->mode() == Mode::kReady);
}

TEST_CASE("Services keep to connection, ownership and counter, and replays do nothing") {
  Shop shop;
  CHECK(shop.ask(Service::kReadParameter, 0, 0, 7).result == ServiceResult::kNotConnected);
  CHECK(shop.write("toe_kp_Nm_rad", 100.0f, 7).result == ServiceResult::kNotConnected);
  REQUIRE(shop.write("toe_kp_Nm_rad", 100.0f).result == ServiceResult::kDone);
  shop.bench.connect(7);
  shop.bench.run(2);
  CHECK(shop.write("toe_kp_Nm_rad", 90.0f, 7).result == ServiceResult::kNotOwner);
  // The frame of before once more: it carries an old counter.
  const auto replayed = shop.bench.ask(
      ParameterWrite{1, Shop::index_of("toe_kp_Nm_rad"), std::bit_cast<std::uint32_t>(90.0f),
                     static_cast<std::uint8_t>(shop.bench.counter - 1)});
  CHECK(replayed.result == ServiceResult::kBadCounter);
  CHECK(replayed.value == shop.bench.counter);
  CHECK(shop.read("toe_kp_Nm_rad") == 100.0f);
  CHECK(shop.ask(static_cast<Service>(9)).result == ServiceResult::kUnknownService);
  CHECK(shop.ask(Service::kWriteParameter).result == ServiceResult::kUnknownService);
  CHECK(shop.ask(Service::kReadStatus, 77).result == ServiceResult::kNoSuchIndex);
}

TEST_CASE("Stored parameters are there after a restart; defaults come back by order") {
  Shop first;
  CHECK(first.status(Status::kLoadResult) == static_cast<std::uint32_t>(app::LoadResult::kEmpty));
  first.write("toe_kp_Nm_rad", 123.0f);
  const auto stored = first.ask(Service::kStoreParameters);
  REQUIRE(stored.result == ServiceResult::kDone);
  CHECK(stored.value == 1);
  first.write("toe_kp_Nm_rad", 77.0f);  // not stored

  Shop second(first.flash);
  CHECK(second.read("toe_kp_Nm_rad") == 123.0f);
  CHECK(second.status(Status::kStoredSequence) == 1);
  CHECK(second.status(Status::kLoadResult) == static_cast<std::uint32_t>(app::LoadResult::kOk));
  CHECK(second.bench.loop->faults() == 0);
  CHECK(second.ask(Service::kDefaultParameters).result == ServiceResult::kDone);
  CHECK(second.read("toe_kp_Nm_rad") == 250.0f);
  CHECK(second.read("hip_calibrated") == 0.0f);
  CHECK(Shop(second.flash).read("toe_kp_Nm_rad") == 123.0f);
}

TEST_CASE("Parameters that cannot be read are a fault: nothing moves by defaults unnoticed") {
  Shop first;
  REQUIRE(first.ask(Service::kStoreParameters).result == ServiceResult::kDone);
  hoof::hal::RamFlash damaged = first.flash;
  REQUIRE(damaged.program(0, 20, 0) == hoof::hal::FlashResult::kOk);
  Shop second(damaged);
  CHECK(second.bench.loop->mode() == Mode::kFault);
  CHECK(second.bench.loop->faults() == fault::kStorage);
  CHECK(second.bench.order(Order::kReady, 0.1f) == OrderResult::kWrongMode);
  // A person resets, and then still has to calibrate: the defaults do not know the zeros.
  CHECK(second.bench.order(Order::kReset) == OrderResult::kAccepted);
  CHECK(second.bench.order(Order::kReady, 0.1f) == OrderResult::kNotCalibrated);
}

TEST_CASE("A leg that is not calibrated is not moved; calibrated at its mark it is, rightly") {
  Shop shop;
  REQUIRE(shop.ask(Service::kDefaultParameters).result == ServiceResult::kDone);
  CHECK(shop.bench.order(Order::kReady, 0.1f) == OrderResult::kNotCalibrated);
  CHECK(shop.bench.order(Order::kRun, 0.1f, 1.0f) == OrderResult::kNotCalibrated);
  CHECK(shop.bench.loop->mode() == Mode::kOff);
  // The encoders are mounted anyhow; a person puts the leg to its marks.
  shop.bench.hip.zero_rad = -0.7;
  shop.bench.knee.zero_rad = 0.4;
  shop.bench.hip.plant.q_rad = 0.5;
  shop.bench.knee.plant.q_rad = -1.4;
  REQUIRE(shop.write("hip_mark_rad", 0.5f).result == ServiceResult::kDone);
  REQUIRE(shop.write("knee_mark_rad", -1.4f).result == ServiceResult::kDone);
  const auto hip = shop.ask(Service::kCalibrateZero, 1);
  REQUIRE(hip.result == ServiceResult::kDone);
  CHECK(std::bit_cast<float>(hip.value) == Approx(0.7).margin(1e-4));  // reading = angle - zero
  CHECK(shop.bench.order(Order::kReady, 0.1f) == OrderResult::kNotCalibrated);  // the knee
  REQUIRE(shop.ask(Service::kCalibrateZero, 2).result == ServiceResult::kDone);
  shop.bench.run(1);
  CHECK(shop.bench.loop->telemetry().state[1].position_rad == Approx(0.5).margin(2e-4));
  CHECK(shop.bench.loop->telemetry().state[2].position_rad == Approx(-1.4).margin(2e-4));
  REQUIRE(shop.ask(Service::kStoreParameters).result == ServiceResult::kDone);

  // After the next start it moves at once, and to the right place.
  Shop next(shop.flash);
  next.bench.hip.zero_rad = -0.7;
  next.bench.knee.zero_rad = 0.4;
  next.bench.run(5);
  REQUIRE(next.bench.order(Order::kReady, 0.1f) == OrderResult::kAccepted);
  REQUIRE(next.bench.run_until(Mode::kReady) > 0);
  next.bench.run(3000);
  CHECK(next.bench.loop->faults() == 0);
  const auto& t = next.bench.loop->telemetry();
  CHECK(next.bench.hip.plant.q_rad == Approx(double{t.leg_set_point_rad.hip_rad}).margin(0.01));
  CHECK(next.bench.knee.plant.q_rad == Approx(double{t.leg_set_point_rad.knee_rad}).margin(0.01));
}

TEST_CASE("A joint that moves, is silent, not there or homes is not calibrated") {
  Shop shop;
  CHECK(shop.ask(Service::kCalibrateZero, 0).result == ServiceResult::kNoSuchIndex);  // homes
  CHECK(shop.ask(Service::kCalibrateZero, 3).result == ServiceResult::kNoSuchIndex);
  shop.bench.hip.plant.v_rad_s = 5.0;
  shop.bench.run(1);
  CHECK(shop.ask(Service::kCalibrateZero, 1).result == ServiceResult::kBusy);
  shop.bench.run(2000);
  shop.bench.hip.silent = true;
  shop.bench.connect();  // the connection has lapsed
  shop.bench.run(25);
  CHECK(shop.ask(Service::kCalibrateZero, 1).result == ServiceResult::kNothingThere);
}

TEST_CASE("A toe with an absolute encoder needs no homing, but its zero") {
  Shop shop;
  REQUIRE(shop.write("toe_absolute_encoder", 1.0f).result == ServiceResult::kDone);
  CHECK(shop.bench.order(Order::kReady, 0.3f) == OrderResult::kNotCalibrated);
  shop.bench.toe.plant.q_rad = 0.2;
  REQUIRE(shop.write("toe_mark_rad", 0.2f).result == ServiceResult::kDone);
  REQUIRE(shop.ask(Service::kCalibrateZero, 0).result == ServiceResult::kDone);
  REQUIRE(shop.bench.order(Order::kReady, 0.3f) == OrderResult::kAccepted);
  REQUIRE(shop.bench.run_until(Mode::kReady, 20) > 0);  // no search
  CHECK(shop.bench.toe.plant.q_rad > 0.15);
  shop.bench.run(1000);
  CHECK(shop.bench.toe.plant.q_rad == Approx(0.3).margin(0.005));
  CHECK(shop.bench.loop->faults() == 0);
}

TEST_CASE("A foot without storage says so") {
  LoopBench bench;
  bench.run(2);
  bench.connect();
  bench.run(2);
  const auto ask = [&](Service service, Status what = Status::kParameterCount) {
    const auto answer =
        bench.ask(ServiceRequest{1, service, static_cast<std::uint8_t>(what), 0, 0, bench.counter});
    if (service == Service::kStoreParameters || service == Service::kEraseFaultLog) {
      ++bench.counter;
    }
    return answer.result;
  };
  CHECK(ask(Service::kReadStatus) == ServiceResult::kDone);
  for (const Status what : {Status::kStoredSequence, Status::kLoadResult, Status::kLogState,
                            Status::kLogUsed, Status::kLogCapacity, Status::kLogLost}) {
    CHECK(ask(Service::kReadStatus, what) == ServiceResult::kNoStorage);
  }
  CHECK(ask(Service::kStoreParameters) == ServiceResult::kNoStorage);
  CHECK(ask(Service::kEraseFaultLog) == ServiceResult::kNoStorage);
  CHECK(ask(Service::kReadFaultLog) == ServiceResult::kNoStorage);
}

TEST_CASE("A fault is kept with the ticks before it, and is read over the bus after a restart") {
  Shop shop;
  CHECK(shop.status(Status::kLogUsed) == 0);
  REQUIRE(shop.bench.order(Order::kReady, 0.3f) == OrderResult::kAccepted);
  REQUIRE(shop.bench.run_until(Mode::kReady) > 0);
  shop.bench.run(500);
  shop.bench.knee.silent = true;
  REQUIRE(shop.bench.run_until(Mode::kFault, 3000) > 0);
  CHECK(shop.bench.loop->faults() == fault::kDriveLost);
  const std::uint32_t tick = shop.bench.tick;
  shop.bench.run(300);  // 148 ticks to write it

  Shop next(shop.flash, hoof::hal::ResetCause::kWatchdog);
  CHECK(next.bench.loop->faults() == fault::kUnexpectedReset);
  next.bench.run(300);
  CHECK(next.status(Status::kResetCause) ==
        static_cast<std::uint32_t>(hoof::hal::ResetCause::kWatchdog));
  CHECK(next.status(Status::kLogUsed) == 2);
  CHECK(next.status(Status::kLogLost) == 0);
  REQUIRE(next.status(Status::kWordsPerRecord) == app::kFaultRecordWords);
  app::FaultRecordWords words;
  for (std::size_t slot = 0; slot < 2; ++slot) {
    for (std::size_t i = 0; i < words.size(); ++i) {
      next.bench.connect();  // the connection lapses after a second of nothing else
      const auto answer = next.ask(Service::kReadFaultLog, static_cast<std::uint8_t>(slot),
                                   static_cast<std::uint16_t>(i));
      REQUIRE(answer.result == ServiceResult::kDone);
      words[i] = answer.value;
    }
    const auto record = app::decode(words);
    REQUIRE(record.has_value());
    if (slot == 1) {
      CHECK(record->faults == fault::kUnexpectedReset);
      continue;
    }
    CHECK(record->faults == fault::kDriveLost);
    CHECK(record->mode == Mode::kReady);
    CHECK(record->trace_count == app::TraceRing::kTicks);
    CHECK(record->trace[0].tick == record->tick);
    CHECK(record->tick < tick);
    CHECK(record->trace[23].faults == 0);
    CHECK(record->trace[0].position_rad[1] ==
          Approx(shop.bench.loop->telemetry().state[1].position_rad).margin(0.05));
  }
  CHECK(next.ask(Service::kReadFaultLog, 2).result == ServiceResult::kNothingThere);
  CHECK(next.ask(Service::kReadFaultLog, 0, app::kFaultRecordWords).result ==
        ServiceResult::kNoSuchIndex);
  REQUIRE(next.bench.order(Order::kReset) == OrderResult::kAccepted);
  CHECK(next.ask(Service::kEraseFaultLog).result == ServiceResult::kDone);
  CHECK(next.status(Status::kLogUsed) == 0);
}

TEST_CASE("A button pressed often leaves half of the log to faults") {
  Shop shop;
  for (int i = 0; i < 20; ++i) {
    shop.bench.supervisor.send(encode(protocol::EmergencyStop{}));
    shop.bench.run(200);
    REQUIRE(shop.bench.order(Order::kReset) == OrderResult::kAccepted);
  }
  CHECK(shop.status(Status::kLogUsed) == 7);  // of 13
  shop.bench.supervisor.send(encode(protocol::EmergencyStop{}));
  shop.bench.run(2);
  shop.bench.foot1.set_bus_off(true);
  shop.bench.run(300);
  CHECK(shop.status(Status::kLogUsed) == 8);
}
