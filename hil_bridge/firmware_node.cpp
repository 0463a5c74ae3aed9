#include "hil_bridge/firmware_node.h"

#include "firmware/app/control_loop.h"
#include "hal/in_process/soft_board.h"

namespace hoof::bridge {
namespace {

class InProcessFirmware final : public FirmwareNode {
 public:
  InProcessFirmware(Wires& wires, const hal::Clock& clock,
                    const firmware::app::Parameters& parameters)
      : loop_({&wires.attach(0, "foot"), &wires.attach(1, "foot")}, clock, board_, parameters) {}

  void poll(std::int64_t) override { loop_.poll(); }
  const firmware::app::Telemetry& telemetry() const override { return loop_.telemetry(); }

 private:
  hal::SoftBoard board_;
  firmware::app::ControlLoop loop_;
};

}  // namespace

FirmwareFactory firmware_in_process(const firmware::app::Parameters& parameters) {
  return [parameters](Wires& wires, const hal::Clock& clock) {
    return std::make_unique<InProcessFirmware>(wires, clock, parameters);
  };
}

}  // namespace hoof::bridge
