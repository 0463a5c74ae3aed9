// Any frame into the decoder of every message, and into those of drive commands and replies.
#include <cmath>
#include <tuple>
#include <type_traits>

#include "firmware/protocol/codec.h"
#include "tests/fuzz/byte_source.h"
#include "tests/fuzz/require.h"

using namespace hoof::firmware::protocol;
using hoof::hal::CanFrame;
using hoof::tests::fuzz::ByteSource;
using hoof::tests::fuzz::require;
using hoof::tests::fuzz::set_flags;

namespace {

/// Byte 0: bit 7 repairs the CRC, the lower bits are flags. Then identifier (two bytes), length,
/// payload.
CanFrame frame_from(ByteSource& bytes) {
  CanFrame frame;
  const std::uint8_t how = bytes.byte();
  set_flags(frame, how & 0x7F);
  frame.id = bytes.word();
  frame.length = bytes.byte();
  bytes.fill(frame, CanFrame::kMaxFdLength);
  const bool has_crc = frame.length >= 1 && frame.length <= CanFrame::kMaxClassicLength;
  if ((how & 0x80) != 0 && has_crc) frame.data[frame.length - 1u] = crc8(frame);
  return frame;
}

/// Every number that a decoder hands out lies in the range of its signal.
template <typename M>
void require_in_range(const MessageSpec& spec, const M& message) {
  const Signal* signal = spec.signals.data();
  const auto look = [&](auto value) {
    if constexpr (std::is_floating_point_v<decltype(value)>) {
      // The top code is one rounding of the scale away from the stated end.
      const float slack = 0.5f * signal->scale;
      require(std::isfinite(value), "a decoded value is finite");
      require(value >= signal->minimum - slack && value <= signal->maximum + slack,
              "a decoded value is in its range");
    }
    ++signal;
  };
  std::apply([&](auto... field) { (look(message.*field), ...); }, M::fields());
}

/// A flag is sent as 0 or 1 but taken from any code, so bytes may differ where it is; what is
/// packed again must be read again as the same.
template <typename M>
void try_message(const CanFrame& frame) {
  M message;
  if (decode(frame, message) != DecodeResult::kOk) {
    require(M{}.*std::get<0>(M::fields()) == message.*std::get<0>(M::fields()),
            "a refused frame leaves the struct untouched");
    return;
  }
  require_in_range(spec(M::kMessage), message);
  const CanFrame packed = encode(message);
  M again;
  require(decode(packed, again) == DecodeResult::kOk, "what is packed can be read");
  require(encode(again) == packed, "reading and packing once more changes nothing");
}

template <typename... M>
void try_messages(const CanFrame& frame) {
  (try_message<M>(frame), ...);
}

void try_drive(Drive drive, const CanFrame& frame) {
  DriveOrder order;
  if (decode_command(drive, frame, order) == DecodeResult::kOk) {
    require_in_range(command_spec(drive), order.command);
    const CanFrame packed =
        order.action ? encode_switch(drive, *order.action) : encode_command(drive, order.command);
    require(packed == frame, "a drive command comes back as the same bytes");
  }
  DriveReply reply;
  if (decode_reply(drive, frame, reply) == DecodeResult::kOk) {
    require(reply.drive_id == drive_id(drive), "a reply carries its drive's number");
    require_in_range(reply_spec(drive), reply);
    require(encode_reply(drive, reply) == frame, "a drive reply comes back as the same bytes");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ByteSource bytes({data, size});
  const CanFrame frame = frame_from(bytes);
  try_messages<EmergencyStop, Sync, SupervisorOrder, OrderAcknowledge, Heartbeat, FootToe, FootLeg,
               FootGround, FootGate, FootCounters, FootLoad, FootFrames, SupervisorConnect,
               ParameterWrite, ServiceRequest, ServiceAnswer>(frame);
  for (const Drive drive : kDrives) try_drive(drive, frame);
  return 0;
}
