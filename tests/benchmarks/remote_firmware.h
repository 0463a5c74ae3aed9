// hoof-firmware as a child process, in lock-step with this one over a CAN interface.
#pragma once

#include <sys/types.h>

#include <string>

#include "hil_bridge/lock_step.h"
#include "hil_bridge/remote_foot.h"
#include "hil_bridge/remote_line.h"
#include "tools/experiment/run_settings.h"

namespace hoof::benchmarks {

class RemoteFirmware {
 public:
  /// Starts it and passes the run's parameters.
  /// @param words file for what it says at its end; empty: this program's own standard error
  /// @throws std::runtime_error where it does not come up
  RemoteFirmware(const tools::RunSettings& run, const std::string& interface,
                 const std::string& words = "");
  ~RemoteFirmware();
  RemoteFirmware(const RemoteFirmware&) = delete;
  RemoteFirmware& operator=(const RemoteFirmware&) = delete;

  /// For LockStep; the wires must outlive what it makes.
  bridge::FirmwareMaker maker(bridge::Wires& wires);

  pid_t id() const { return child_; }
  bridge::RemoteLine& line() { return *line_; }
  /// Tells it to end, and waits until it has.
  void end();

 private:
  pid_t child_ = -1;
  std::unique_ptr<bridge::RemoteLine> line_;
};

}  // namespace hoof::benchmarks
