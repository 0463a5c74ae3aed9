// Bytes as a script for the whole firmware: parameters, then beats, orders, frames of every kind on
// both buses, silent and lying drives, full and broken buses, jumps of the clock. LoopWatch judges
// every poll.
#include <algorithm>
#include <bit>

#include "firmware/protocol/protocol_hash.h"
#include "tests/fuzz/byte_source.h"
#include "tests/fuzz/loop_rig.h"

using namespace hoof::firmware;
using namespace hoof::tests::fuzz;
using hoof::hal::CanFrame;

namespace {

/// Two seconds of firmware time: home, run, stop and start anew fit in.
constexpr int kLongest_ms = 2000;

/// Byte 0: bit 0 no toe, bit 1 no leg, bit 5 calibration left to chance, bits 2 to 4 how many
/// parameters are set anywhere in their range; for each its place in the table and the place in the
/// range.
app::Parameters parameters_from(ByteSource& bytes) {
  app::Parameters parameters;
  const std::uint8_t head = bytes.byte();
  const auto table = app::parameter_table();
  for (int n = head >> 2 & 7; n > 0; --n) {
    const app::ParameterEntry& entry = table[bytes.byte() % table.size()];
    const float share = static_cast<float>(bytes.word()) / 65535.0f;
    const float value = entry.minimum + share * (entry.maximum - entry.minimum);
    set(parameters, entry.name, std::min(value, entry.maximum));
  }
  if ((head & 32u) == 0) {
    for (app::JointCalibration& joint : parameters.calibration) joint.done = 1.0f;
  }
  parameters.toe_present = (head & 1u) != 0 ? 0.0f : 1.0f;
  parameters.leg_present = (head & 2u) != 0 ? 0.0f : 1.0f;
  return parameters;
}

class Script {
 public:
  Script(ByteSource& bytes, LoopRig& rig) : bytes_(bytes), rig_(rig) {}

  void run() {
    while (!bytes_.empty() && left_ms_ > 0) step();
  }

 private:
  enum class Deed : std::uint8_t {
    kBeat,
    kOrder,
    kFrame,
    kReply,
    kSilence,
    kEmergencyStop,
    kDrive,
    kLoad,
    kBus,
    kClock,
    kSync,
    kProgram,
    kHeal,
    kCount,
  };

  void step() {
    switch (static_cast<Deed>(bytes_.byte() % static_cast<std::uint8_t>(Deed::kCount))) {
      case Deed::kBeat:
        return pass([this] { rig_.beat(); });
      case Deed::kOrder:
        return order();
      case Deed::kFrame:
        return frame();
      case Deed::kReply:
        return reply();
      case Deed::kSilence:
        return pass([this] { rig_.silence(); });
      case Deed::kEmergencyStop:
        return emergency_stop();
      case Deed::kDrive:
        return drive();
      case Deed::kLoad:
        return load();
      case Deed::kBus:
        return bus();
      case Deed::kClock:
        rig_.jump_clock(bytes_.long_word());  // up to 4.3 s
        return rig_.poll();
      case Deed::kSync:
        return rig_.send_sync(bytes_.long_word());
      case Deed::kProgram:
        return program();
      case Deed::kHeal:
        return heal();
      case Deed::kCount:
        return;
    }
  }

  template <typename Millisecond>
  void pass(Millisecond&& millisecond) {
    for (int n = bytes_.byte(); n >= 0 && left_ms_ > 0; --n, --left_ms_) millisecond();
  }

  /// Byte of oddities: bits 0 and 1 supervisor, 2 and 3 counter error, 4 wrong CRC.
  void order() {
    protocol::SupervisorOrder order;
    order.order = static_cast<protocol::Order>(bytes_.byte() % 6);  // 5 is none
    order.toe_angle_rad = static_cast<float>(bytes_.byte()) * 4e-3f;
    order.frequency_Hz = static_cast<float>(bytes_.byte()) * 1e-2f;
    const std::uint8_t oddities = bytes_.byte();
    order.supervisor_id = (oddities & 3u) ^ 1u;
    rig_.send_order(order, oddities >> 2 & 3u, (oddities & 16u) != 0);
  }

  /// Any frame; half of the identifiers are of the dictionary, and the CRC may be set right.
  void frame() {
    CanFrame frame;
    const std::uint8_t where = bytes_.byte();
    frame.id = bytes_.word();
    if ((where & 2u) != 0) {
      frame.id = protocol::kMessages[frame.id % protocol::kMessages.size()].id;
    }
    set_flags(frame, bytes_.byte());
    frame.length = bytes_.byte();
    if ((where & 4u) != 0) frame.length = 8;
    bytes_.fill(frame, std::min<std::size_t>(frame.length, 12));
    const bool has_crc = frame.length >= 1 && frame.length <= CanFrame::kMaxClassicLength;
    if ((where & 8u) != 0 && has_crc) frame.data[frame.length - 1u] = protocol::crc8(frame);
    rig_.bus(where & 1u).arriving.push_back(frame);
  }

  /// A drive's reply with any content, before or instead of the true one.
  void reply() {
    const protocol::Drive which = protocol::kDrives[bytes_.byte() % protocol::kDriveCount];
    CanFrame frame = encode_reply(which, {});
    for (std::size_t i = 1; i < 8; ++i) frame.data[i] = bytes_.byte();
    rig_.bus(which == protocol::Drive::kToe ? 0 : 1).arriving.push_back(frame);
  }

  void emergency_stop() {
    CanFrame frame = encode(protocol::EmergencyStop{});
    const std::uint8_t how = bytes_.byte();
    set_flags(frame, how >> 1 & 0x3F);
    frame.length = bytes_.byte();
    rig_.bus(how & 1u).arriving.push_back(frame);
  }

  void drive() {
    RigDrive& drive = rig_.drive(bytes_.byte());
    const std::uint8_t how = bytes_.byte();
    drive.silent = (how & 1u) != 0;
    drive.error = how >> 4;
    drive.temperature_C = (how & 2u) != 0 ? 101.0f : 25.0f;
    if ((how & 4u) != 0) drive.zero_rad = (bytes_.word() - 32768) * 4e-4;  // +-13 rad
  }

  /// Up to 25 Nm on the toe, 640 Nm on the leg.
  void load() {
    const std::uint8_t which = bytes_.byte();
    const double largest_Nm = which % protocol::kDriveCount == 0 ? 25.0 : 640.0;
    rig_.drive(which).plant.load_Nm = largest_Nm * (bytes_.byte() - 128) / 128.0;
  }

  void bus() {
    const std::uint8_t how = bytes_.byte();
    FuzzBus& bus = rig_.bus(how & 1u);
    bus.bus_off = (how & 2u) != 0;
    bus.room = (how & 4u) != 0 ? how >> 4 : FuzzBus::kEndless;
  }

  void program() {
    switch (bytes_.byte() % 8) {
      case 0:
        return rig_.loop().request_stop();
      case 1:
        rig_.loop().emergency_stop();
        return rig_.watch().stopped_by_program();
      case 2:
        return rig_.loop().release_drives();
      case 3:
        return connect();
      case 4:
        return write();
      case 5:
        return service();
      default:
        return board();
    }
  }

  void connect() {
    const std::uint8_t how = bytes_.byte();
    rig_.connect(how & 7u, protocol::kProtocolHash ^ ((how & 8u) != 0 ? bytes_.long_word() : 0u));
  }

  /// A value anywhere in the range of its parameter, or any bits at all.
  void write() {
    const auto table = app::parameter_table();
    const std::uint8_t how = bytes_.byte();
    const std::uint8_t index = bytes_.byte();
    std::uint32_t bits = bytes_.long_word();
    if ((how & 16u) == 0) {
      const app::ParameterEntry& entry = table[index % table.size()];
      const float share = static_cast<float>(bits >> 8) * 0x1p-24f;
      bits = std::bit_cast<std::uint32_t>(entry.minimum + share * (entry.maximum - entry.minimum));
    }
    rig_.send_service(
        protocol::ParameterWrite{static_cast<std::uint8_t>((how & 3u) ^ 1u), index, bits, 0},
        how >> 2 & 3u);
  }

  void service() {
    const std::uint8_t how = bytes_.byte();
    protocol::ServiceRequest request;
    request.supervisor_id = (how & 3u) ^ 1u;
    request.service = static_cast<protocol::Service>(how >> 4);
    request.index = bytes_.byte();
    request.offset = bytes_.word();
    rig_.send_service(request, how >> 2 & 3u);
  }

  void board() {
    const std::uint8_t how = bytes_.byte();
    rig_.board().pressed = (how & 1u) != 0;
    rig_.board().low = (how & 2u) != 0;
    rig_.board().volts = (how & 4u) != 0 ? static_cast<float>(how >> 3) * 2.0f : 0.0f;
  }

  /// Drives and buses as at the start.
  void heal() {
    for (std::size_t i = 0; i < protocol::kDriveCount; ++i) {
      rig_.drive(i).silent = false;
      rig_.drive(i).error = 0;
      rig_.drive(i).temperature_C = 25.0f;
      rig_.drive(i).plant.load_Nm = 0.0;
    }
    rig_.board().pressed = rig_.board().low = false;
    rig_.board().volts = 0.0f;
    for (std::size_t i = 0; i < protocol::kBusCount; ++i) {
      rig_.bus(i).bus_off = false;
      rig_.bus(i).room = FuzzBus::kEndless;
    }
  }

  ByteSource& bytes_;
  LoopRig& rig_;
  int left_ms_ = kLongest_ms;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ByteSource bytes({data, size});
  LoopRig rig(parameters_from(bytes));
  Script(bytes, rig).run();
  rig.poll();
  return 0;
}
