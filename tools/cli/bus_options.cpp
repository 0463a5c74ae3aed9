#include "tools/cli/bus_options.h"

namespace hoof::tools {
namespace {

constexpr char kRealTime[] = "real-time";
constexpr char kLockStep[] = "lock-step";

}  // namespace

CLI::Option* add_bus_options(CLI::App& command, BusOptions& options) {
  command
      .add_option("--clock", options.clock,
                  "lock-step: time waits for plant and firmware; real-time: the wall's clock")
      ->type_name("lock-step|real-time")
      ->check(CLI::IsMember({kLockStep, kRealTime}))
      ->capture_default_str();
  command
      .add_option("--patience", options.patience_s,
                  "Longest wait for an answer of the firmware, by the wall's clock")
      ->type_name("S")
      ->check(CLI::Range(0.01, 3600.0))
      ->capture_default_str();
  return command
      .add_option("--bus", options.bus,
                  "CAN interface of both buses, or one for each: vcan0 or can0,can1")
      ->type_name("IFACE");
}

BusChoice bus_choice(const BusOptions& options) {
  return {options.clock == kRealTime, options.patience_s};
}

}  // namespace hoof::tools
