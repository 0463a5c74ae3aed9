// The whole firmware on two simulated buses with three plain drives, a SYNC master and a
// supervisor.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "firmware/app/control_loop.h"
#include "firmware/protocol/codec.h"
#include "firmware/protocol/protocol_hash.h"
#include "hal/in_process/in_process_bus.h"
#include "hal/in_process/soft_board.h"
#include "hal/stepped_clock.h"
#include "tests/firmware/control/joint_plant.h"

namespace hoof::firmware::app::test {

/// A drive as the bus sees it: the plain joint of the control tests behind the codec.
class TestDrive {
 public:
  TestDrive(hal::InProcessPort& port, protocol::Drive which) : port_(port), which_(which) {}

  control::test::JointPlant plant;
  double zero_rad = 0.0;  // drive reading = plant angle - zero
  bool silent = false;    // does not answer
  std::uint8_t error = 0;
  float temperature_C = 25.0f;
  bool entered = false;
  protocol::DriveOrder last;
  int commands = 0;

  void poll() {
    hal::CanFrame frame;
    while (port_.receive(frame)) {
      if (decode_command(which_, frame, last) != protocol::DecodeResult::kOk) continue;
      ++commands;
      age_ms_ = 0;
      if (last.action == protocol::DriveSwitch::kEnter) entered = true;
      if (last.action == protocol::DriveSwitch::kExit) entered = false;
      if (!silent) port_.send(encode_reply(which_, reading()));
    }
  }

  /// A millisecond; the torque ends 20 ms after the last command.
  void run() {
    ++age_ms_;
    control::JointCommand c;
    if (entered && !last.action && age_ms_ <= 20) {
      const protocol::DriveCommand& w = last.command;
      c = {w.position_rad + static_cast<float>(zero_rad), w.velocity_rad_s, w.kp_Nm_rad,
           w.kd_Nm_s_rad, w.torque_Nm};
    }
    plant.run(c);
  }

 private:
  protocol::DriveReply reading() const {
    protocol::DriveReply reply;
    reply.position_rad = static_cast<float>(plant.q_rad - zero_rad);
    reply.velocity_rad_s = static_cast<float>(plant.v_rad_s);
    reply.torque_Nm = static_cast<float>(plant.motor_Nm);
    reply.temperature_C = temperature_C;
    reply.error = error;
    return reply;
  }

  hal::InProcessPort& port_;
  protocol::Drive which_;
  int age_ms_ = 1000;
};

/// Parameters of a rig whose leg's encoders read joint angles; its toe is homed.
inline Parameters calibrated(Parameters parameters = {}) {
  parameters.calibration[index(control::Joint::kHip)].done = 1.0f;
  parameters.calibration[index(control::Joint::kKnee)].done = 1.0f;
  return parameters;
}

struct LoopBench {
  static constexpr std::int64_t kMillisecond_ns = 1'000'000;

  hal::InProcessBus bus0{{.name = "bus0", .bit_rates = {}}};
  hal::InProcessBus bus1{{.name = "bus1", .bit_rates = {}}};
  hal::SteppedClock clock;
  hal::SoftBoard board;
  hal::InProcessPort& foot0 = bus0.attach("foot");
  hal::InProcessPort& foot1 = bus1.attach("foot");
  hal::InProcessPort& master0 = bus0.attach("sync");
  hal::InProcessPort& master1 = bus1.attach("sync");
  hal::InProcessPort& supervisor = bus0.attach("supervisor");
  TestDrive toe{bus0.attach("toe"), protocol::Drive::kToe};
  TestDrive hip{bus1.attach("hip"), protocol::Drive::kHip};
  TestDrive knee{bus1.attach("knee"), protocol::Drive::kKnee};
  std::array<TestDrive*, 3> drives{&toe, &hip, &knee};
  std::unique_ptr<ControlLoop> loop;

  bool sync = true;    // the master beats
  bool polled = true;  // the loop is called
  std::uint32_t tick = 0;
  std::uint8_t counter = 0;  // of the next order
  std::vector<protocol::OrderAcknowledge> answers;
  std::vector<protocol::Heartbeat> heartbeats;
  std::vector<protocol::ServiceAnswer> service_answers;

  explicit LoopBench(const Parameters& parameters = calibrated(), Storage* storage = nullptr,
                     hal::ResetCause cause = hal::ResetCause::kPowerOn) {
    board.cause = cause;
    toe.zero_rad = -1.5;  // its count starts anywhere
    toe.plant.stop_rad = 0.0;
    toe.plant.q_rad = 0.1;
    hip.plant.q_rad = 0.5;
    knee.plant.q_rad = -1.4;
    for (TestDrive* leg : {&hip, &knee}) {
      leg->plant.inertia_kg_m2 = 0.5;
      leg->plant.friction_Nm = 2.0;
      leg->plant.torque_limit_Nm = 400.0;
    }
    // Nodes that nobody reads would only fill their queues.
    master0.set_filters({{.id = 0x7FF, .mask = 0x7FF}});
    master1.set_filters({{.id = 0x7FF, .mask = 0x7FF}});
    loop = std::make_unique<ControlLoop>(ControlLoop::Buses{&foot0, &foot1}, clock, board,
                                         parameters, storage);
  }

  /// One millisecond, seen in steps of 50 microseconds.
  void millisecond() {
    if (sync) {
      master0.send(encode(protocol::Sync{tick}));
      master1.send(encode(protocol::Sync{tick}));
      ++tick;
    }
    for (int i = 0; i < 20; ++i) {
      const std::int64_t t_ns = clock.now_ns() + 50'000;
      bus0.advance_to(t_ns);
      bus1.advance_to(t_ns);
      clock.advance_to(t_ns);
      for (TestDrive* drive : drives) drive->poll();
      if (polled) loop->poll();
    }
    for (TestDrive* drive : drives) drive->run();
    listen();
  }

  void run(int milliseconds) {
    for (int i = 0; i < milliseconds; ++i) millisecond();
  }

  /// @return milliseconds it took, or -1
  int run_until(control::Mode mode, int longest = 8000) {
    for (int i = 0; i < longest; ++i) {
      if (loop->mode() == mode) return i;
      millisecond();
    }
    return -1;
  }

  void connect(std::uint8_t who = 1, std::uint32_t hash = protocol::kProtocolHash) {
    supervisor.send(encode(protocol::SupervisorConnect{who, hash, 0}));
  }

  /// As a supervisor does it: connected first.
  void send_order(protocol::Order order, float toe_angle_rad = 0.0f, float frequency_Hz = 0.0f,
                  std::uint8_t who = 1) {
    connect(who);
    millisecond();  // an order has the smaller identifier: it would overtake
    supervisor.send(
        encode(protocol::SupervisorOrder{who, order, toe_angle_rad, frequency_Hz, counter}));
  }

  /// Sends an order and waits for its answer.
  protocol::OrderResult order(protocol::Order order, float toe_angle_rad = 0.0f,
                              float frequency_Hz = 0.0f, std::uint8_t who = 1) {
    const std::size_t before = answers.size();
    send_order(order, toe_angle_rad, frequency_Hz, who);
    for (int i = 0; i < 10 && answers.size() < before + 2; ++i) millisecond();
    counter = answers.back().expected_counter;
    return answers.back().result;
  }

  /// Sends a frame that asks for something and waits for its answer.
  template <typename M>
  protocol::ServiceAnswer ask(const M& request) {
    const std::size_t before = service_answers.size();
    supervisor.send(encode(request));
    for (int i = 0; i < 10 && service_answers.size() == before; ++i) millisecond();
    return service_answers.back();
  }

  void listen() {
    hal::CanFrame frame;
    while (supervisor.receive(frame)) {
      protocol::OrderAcknowledge answer;
      protocol::Heartbeat heartbeat;
      protocol::ServiceAnswer service;
      if (decode(frame, service) == protocol::DecodeResult::kOk) service_answers.push_back(service);
      if (decode(frame, answer) == protocol::DecodeResult::kOk) answers.push_back(answer);
      if (decode(frame, heartbeat) == protocol::DecodeResult::kOk) heartbeats.push_back(heartbeat);
    }
  }

  bool drives_free() const { return !toe.entered && !hip.entered && !knee.entered; }
};

}  // namespace hoof::firmware::app::test
