#include <iostream>
#include <map>
#include <memory>

#include "hal/monotonic_clock.h"
#include "hal/socketcan/socketcan_bus.h"
#include "tools/cli/commands.h"
#include "tools/cli/order.h"

namespace hoof::tools {
namespace {

using firmware::protocol::Order;

const std::map<std::string, Order> kOrders = {{"ready", Order::kReady},
                                              {"run", Order::kRun},
                                              {"stop", Order::kStop},
                                              {"reset", Order::kReset},
                                              {"release", Order::kRelease}};
const std::string kEmergencyStop = "estop";

struct CommandOptions {
  std::string word;
  std::string bus;
  double toe_deg = 0;
  double frequency_Hz = 0;
  // Supervisor 1 is that of hoof's own runs.
  int id = 2;
  double timeout_s = 2;
};

OrderRequest request_of(const CommandOptions& options) {
  constexpr double kDegree_rad = 0.017453292519943295;
  OrderRequest request;
  request.order = kOrders.at(options.word);
  request.toe_rad = options.toe_deg * kDegree_rad;
  request.frequency_Hz = options.frequency_Hz;
  request.id = std::uint8_t(options.id);
  request.timeout_ns = std::int64_t(options.timeout_s * 1e9);
  return request;
}

void carry_out(const CommandOptions& options) {
  hal::SocketCanSettings settings;
  settings.interface = options.bus;
  hal::SocketCanBus bus(settings);
  const hal::MonotonicClock clock;
  const auto idle = [&bus] { bus.wait(1'000'000); };
  if (options.word == kEmergencyStop) {
    const auto timeout_ns = std::int64_t(options.timeout_s * 1e9);
    const std::string mode = press_emergency_stop(bus, clock, timeout_ns, idle);
    std::cout << "stopped; mode " << mode << "\n";
  } else {
    const std::string mode = give_order(bus, clock, request_of(options), idle);
    std::cout << "accepted; mode " << mode << "\n";
  }
}

/// Flags that the word has no use for, or that it lacks.
void check_flags(const CLI::App& command, const CommandOptions& options) {
  const bool moves = options.word == "ready" || options.word == "run";
  if (command.count("--toe") > 0 && !moves) {
    throw CLI::ValidationError("--toe", "only ready and run open the toes");
  }
  if (command.count("--frequency") > 0 && options.word != "run") {
    throw CLI::ValidationError("--frequency", "only run has one");
  }
  if (command.count("--frequency") == 0 && options.word == "run") {
    throw CLI::ValidationError("--frequency", "run needs one, e.g. --frequency 0.45");
  }
}

}  // namespace

void add_order_command(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<CommandOptions>();
  CLI::App* command = app.add_subcommand("command", "Give an order to a foot on a CAN bus");
  command
      ->add_option("ORDER", options->word,
                   "ready, run, stop, reset, release, or estop: torque off at once")
      ->required()
      ->check(CLI::IsMember({"ready", "run", "stop", "reset", "release", kEmergencyStop.c_str()}));
  command->add_option("--bus", options->bus, "CAN interface of the foot's bus 0, e.g. vcan0")
      ->type_name("IFACE")
      ->required();
  command->add_option("--toe", options->toe_deg, "Opening of each toe, 0..40 degrees")
      ->type_name("DEG")
      ->check(CLI::Range(0.0, 40.0));
  // The firmware's own bound: gait_largest_frequency_Hz.
  command->add_option("--frequency", options->frequency_Hz, "Of the stance ellipse, up to 2 Hz")
      ->type_name("HZ")
      ->check(CLI::Range(0.01, 2.0));
  command->add_option("--id", options->id, "Of this supervisor, 1..255; a foot obeys one at a time")
      ->type_name("N")
      ->check(CLI::Range(1, 255))
      ->capture_default_str();
  command->add_option("--timeout", options->timeout_s, "Longest wait for the answer")
      ->type_name("S")
      ->check(CLI::Range(0.1, 60.0))
      ->capture_default_str();
  command->footer(
      "Examples:\n"
      "  hoof command ready --bus vcan0 --toe 20\n"
      "  hoof command run --bus can0 --toe 20 --frequency 0.45\n"
      "  hoof command stop --bus can0");
  command->callback([&invocation, command, options] {
    check_flags(*command, *options);
    invocation.run = [options] { carry_out(*options); };
  });
}

}  // namespace hoof::tools
