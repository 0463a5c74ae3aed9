#include "tools/experiment/run_bus.h"

#include <cstdio>

#include "hil_bridge/remote_foot.h"
#include "tools/emulator/emulated_firmware.h"
#include "tools/qemu/qemu_firmware.h"
#include "tools/run/errors.h"

namespace hoof::tools {
namespace {

using Json = nlohmann::ordered_json;

std::int64_t nanoseconds(double seconds) {
  return std::int64_t(seconds * 1e9);
}

/// Frames of others on the interface come onto the simulated wires by connections of their own.
std::array<hal::CanBus*, bridge::kBusCount> visitors(bridge::Wires& wires) {
  return {&wires.attach(0, "visitor"), &wires.attach(1, "visitor")};
}

Json histogram_json(const bridge::DurationHistogram& histogram) {
  Json counts = Json::array();
  for (const auto& [upper_us, count] : histogram.octaves()) {
    counts.push_back({{"up_to_us", upper_us}, {"count", count}});
  }
  return {{"p50_us", histogram.percentile_ns(0.5) / 1000},
          {"p99_us", histogram.percentile_ns(0.99) / 1000},
          {"max_us", double(histogram.max_ns()) * 1e-3},
          {"histogram", counts}};
}

std::string histogram_text(const char* name, const bridge::DurationHistogram& histogram) {
  char text[120];
  std::snprintf(text, sizeof text, "%s: p50 %lld us, p99 %lld us, max %.0f us\n", name,
                static_cast<long long>(histogram.percentile_ns(0.5) / 1000),
                static_cast<long long>(histogram.percentile_ns(0.99) / 1000),
                double(histogram.max_ns()) * 1e-3);
  std::string all = text;
  for (const auto& [upper_us, count] : histogram.octaves()) {
    std::snprintf(text, sizeof text, "  up to %6lld us %8llu\n", static_cast<long long>(upper_us),
                  static_cast<unsigned long long>(count));
    all += text;
  }
  return all;
}

}  // namespace

void check_bus_choice(const RunSettings& run, const BusChoice& choice) {
  if (!run.image.empty() && run.bus != kInProcess) {
    throw UserError("--firmware " + run.firmware +
                    ": the emulated board is on the simulated wires of this process; leave out "
                    "--bus");
  }
  if (run.in_qemu()) qemu::find_qemu();
  if (!choice.real_time) return;
  if (run.bus == kInProcess) {
    throw UserError(
        "--clock real-time needs a CAN interface with a firmware on it, e.g. --bus vcan0");
  }
  if (run.on_grains()) {
    throw UserError(
        "--clock real-time: grains take seconds of computing for a second of sand; only ground "
        "that keeps up with the wall's clock can be used: add --terrain rft or --terrain rigid");
  }
}

RunBus::RunBus(const RunSettings& run, const BusChoice& choice,
               const std::function<bool()>& stopped)
    : run_(run), choice_(choice) {
  check_bus_choice(run, choice);
  if (run.bus == kInProcess) return;
  line_ = std::make_unique<bridge::RemoteLine>(run.bus);
  line_->await_heartbeat(nanoseconds(choice.patience_s), stopped);
}

bridge::Wires& RunBus::start(bridge::Wires::Observer observer) {
  if (remote()) {
    parameters_changed_ = line_->pass_parameters(run_.parameters, nanoseconds(choice_.patience_s));
    if (choice_.real_time) {
      require_presence();
      line_.reset();  // nobody would read it any more
    }
  }
  wires_ = remote() && choice_.real_time ? bridge::socketcan_wires(run_.bus, std::move(observer))
                                         : bridge::in_process_wires(std::move(observer));
  if (remote() && choice_.real_time) {
    pace_ = std::make_unique<bridge::RealTimePace>(bridge::LockStep::kTick_ns);
    refused_ = bridge::become_real_time();
  }
  return *wires_;
}

/// Which drives there are counts from the firmware's next start, which in lock-step the bridge
/// makes.
void RunBus::require_presence() const {
  for (const std::string& name : parameters_changed_) {
    if (!name.ends_with("_present")) continue;
    throw CannotFinish(run_.bus + ": the foot had been told of another rig (" + name +
                       "); that is set now and counts from its next start: start hoof-firmware "
                       "with --set " +
                       name + "=..., or `hoof param` store and restart the board");
  }
}

bridge::FirmwareMaker RunBus::firmware() {
  if (run_.in_qemu()) {
    return qemu::qemu_firmware(run_.image, run_.parameters, *wires_,
                               nanoseconds(choice_.patience_s));
  }
  if (!run_.image.empty()) return emulator::emulated_firmware(run_.image, run_.parameters, *wires_);
  if (!remote()) return bridge::local_firmware(run_.parameters);
  if (!choice_.real_time) {
    return [this](hal::CanBus& bus0, hal::CanBus& bus1, const hal::Clock& clock) {
      return std::make_unique<bridge::RemoteFoot>(*line_, std::array{&bus0, &bus1},
                                                  visitors(*wires_), clock,
                                                  nanoseconds(choice_.patience_s));
    };
  }
  return [this](hal::CanBus& bus0, hal::CanBus& bus1, const hal::Clock& clock) {
    for (hal::CanBus* bus : {&bus0, &bus1}) {
      if (const auto* socket = dynamic_cast<hal::SocketCanBus*>(bus)) pace_->watch(socket->fd());
    }
    return std::make_unique<bridge::BusFoot>(bus0, bus1, clock, run_.bus);
  };
}

Json RunBus::report() const {
  if (!remote()) return {};
  Json j = {{"interface", run_.bus},
            {"clock", choice_.real_time ? "real-time" : "lock-step"},
            {"parameters_changed", parameters_changed_},
            {"frames_lost_by_kernel", choice_.real_time ? wires_->dropped() : line_->dropped()}};
  if (pace_ && pace_->schedule()) {
    const bridge::DeadlineSchedule& s = *pace_->schedule();
    j["real_time"] = {{"refused", refused_},
                      {"ticks", s.ticks()},
                      {"overruns", s.overruns()},
                      {"ticks_missed", s.missed()},
                      {"wake_latency", histogram_json(s.latency())},
                      {"wake_jitter", histogram_json(s.jitter())}};
  }
  return j;
}

std::string RunBus::text() const {
  if (!pace_ || !pace_->schedule()) return "";
  std::string all;
  for (const std::string& what : refused_) all += "not granted: " + what + "\n";
  const bridge::DeadlineSchedule& s = *pace_->schedule();
  char line[120];
  std::snprintf(line, sizeof line, "real time: %llu ticks, %llu overruns, %llu ticks missed\n",
                static_cast<unsigned long long>(s.ticks()),
                static_cast<unsigned long long>(s.overruns()),
                static_cast<unsigned long long>(s.missed()));
  return all + line + histogram_text("wake latency", s.latency()) +
         histogram_text("wake jitter", s.jitter());
}

}  // namespace hoof::tools
