#include "tools/cli/foot_connection.h"

#include "hal/monotonic_clock.h"
#include "hal/socketcan/socketcan_bus.h"
#include "tools/run/errors.h"

namespace hoof::tools {

CLI::Option* add_foot_flags(CLI::App& command, FootFlags& flags) {
  command.add_option("--id", flags.id, "Of this supervisor, 1..255; a foot obeys one at a time")
      ->type_name("N")
      ->check(CLI::Range(1, 255))
      ->capture_default_str();
  command.add_option("--timeout", flags.timeout_s, "Longest wait for an answer")
      ->type_name("S")
      ->check(CLI::Range(0.1, 60.0))
      ->capture_default_str();
  return command.add_option("--bus", flags.bus, "CAN interface of the foot's bus 0, e.g. vcan0")
      ->type_name("IFACE")
      ->required();
}

void with_any_foot(const FootFlags& flags,
                   const std::function<void(bridge::ServiceClient&)>& work) {
  hal::SocketCanSettings settings;
  settings.interface = flags.bus;
  hal::SocketCanBus bus(settings);
  const hal::MonotonicClock clock;
  bridge::ServiceClient client(
      bus, clock, [&bus] { bus.wait(1'000'000); }, std::uint8_t(flags.id),
      std::int64_t(flags.timeout_s * 1e9));
  try {
    client.greet();
    work(client);
  } catch (const bridge::ServiceError& error) {
    throw CannotFinish(error.what());
  }
}

void with_foot(const FootFlags& flags, const std::function<void(bridge::ServiceClient&)>& work) {
  with_any_foot(flags, [&work](bridge::ServiceClient& client) {
    client.connect();
    work(client);
  });
}

}  // namespace hoof::tools
