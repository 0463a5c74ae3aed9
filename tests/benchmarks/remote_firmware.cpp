#include "tests/benchmarks/remote_firmware.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>

namespace hoof::benchmarks {
namespace {

constexpr std::int64_t kPatience_ns = 5'000'000'000;

}  // namespace

RemoteFirmware::RemoteFirmware(const tools::RunSettings& run, const std::string& interface,
                               const std::string& words) {
  child_ = fork();
  if (child_ < 0) throw std::runtime_error("cannot fork");
  if (child_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (!words.empty()) {
      dup2(open(words.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0644), STDERR_FILENO);
    }
    execl(HOOF_FIRMWARE, HOOF_FIRMWARE, "--bus", interface.c_str(), "--clock", "lock-step",
          static_cast<char*>(nullptr));
    _exit(127);
  }
  try {
    line_ = std::make_unique<bridge::RemoteLine>(interface);
    line_->await_heartbeat(kPatience_ns);
    line_->pass_parameters(run.parameters, kPatience_ns);
  } catch (...) {
    end();
    throw;
  }
}

RemoteFirmware::~RemoteFirmware() {
  end();
}

bridge::FirmwareMaker RemoteFirmware::maker(bridge::Wires& wires) {
  return [this, &wires](hal::CanBus& bus0, hal::CanBus& bus1, const hal::Clock& clock) {
    const std::array<hal::CanBus*, bridge::kBusCount> visitors = {&wires.attach(0, "visitor"),
                                                                  &wires.attach(1, "visitor")};
    return std::make_unique<bridge::RemoteFoot>(*line_, std::array{&bus0, &bus1}, visitors, clock,
                                                kPatience_ns);
  };
}

void RemoteFirmware::end() {
  if (child_ < 0) return;
  kill(child_, SIGTERM);
  waitpid(child_, nullptr, 0);
  child_ = -1;
}

}  // namespace hoof::benchmarks
