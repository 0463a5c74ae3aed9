#include "firmware/board/host/options.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>
#include <vector>

namespace hoof::firmware::board {
namespace {

std::string range_text(const app::ParameterEntry& entry) {
  std::ostringstream text;
  text << entry.name << " must be from " << entry.minimum << " to " << entry.maximum << ' '
       << entry.unit;
  return text.str();
}

}  // namespace

std::string apply_setting(app::Parameters& parameters, std::string_view setting) {
  const std::string quoted = "--set " + std::string(setting) + ": ";
  const std::size_t equals = setting.find('=');
  if (equals == std::string_view::npos) return quoted + "expected name=value";
  const std::string_view name = setting.substr(0, equals);
  const std::string_view text = setting.substr(equals + 1);
  float value = 0.0f;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return quoted + "not a number";
  switch (app::set(parameters, name, value)) {
    case app::SetResult::kOk:
      return {};
    case app::SetResult::kUnknownName:
      return quoted + "no such parameter";
    case app::SetResult::kOutOfRange:
      return quoted + range_text(*app::find_parameter(name));
  }
  return {};
}

Options read_options(int argc, char** argv) {
  Options options;
  std::string buses;
  CLI::App app{"Foot control firmware on Linux, over SocketCAN", "hoof-firmware"};
  app.add_option("--bus", buses, "interface of bus 0, or of bus 0 and bus 1: can0 or can0,can1")
      ->required();
  app.add_option("--set", options.settings, "parameter as name=value; may be repeated");
  std::string clock = "real-time";
  app.add_option("--clock", clock,
                 "real-time: this machine's; lock-step: that of hoof-bridge on the same bus")
      ->check(CLI::IsMember({"real-time", "lock-step"}));
  app.add_option("--patience", options.patience_s,
                 "in lock-step: seconds without a word of the bridge until time runs on by itself")
      ->check(CLI::Range(0.1, 1e6));
  app.add_option("--slow-down", options.slow_down,
                 "wall seconds per control second, for a plant simulated slower than real time")
      ->check(CLI::Range(1.0, 1e6));
  app.add_option("--flash", options.flash,
                 "file that holds parameters and fault log, made where it is missing");
  app.footer(
      "Example:\n"
      "  hoof-firmware --bus can0,can1 --flash foot.flash --set hip_calibrated=1\n"
      "  hoof-firmware --bus vcan0 --clock lock-step     then hoof-bridge --bus vcan0");
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    options.help = app.help();
    return options;
  }
  options.lock_step = clock == "lock-step";
  if (options.lock_step && options.slow_down != 1.0) {
    throw CLI::ValidationError("--slow-down", "has no meaning with --clock lock-step");
  }

  const std::size_t comma = buses.find(',');
  options.bus0 = buses.substr(0, comma);
  options.bus1 = comma == std::string::npos ? options.bus0 : buses.substr(comma + 1);
  app::Parameters trial;
  for (const std::string& setting : options.settings) {
    const std::string problem = apply_setting(trial, setting);
    if (!problem.empty()) throw CLI::ValidationError(problem);
  }
  return options;
}

void apply_settings(const Options& options, app::Parameters& parameters) {
  for (const std::string& setting : options.settings) apply_setting(parameters, setting);
}

}  // namespace hoof::firmware::board
