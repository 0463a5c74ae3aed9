#include "hil_bridge/lcm_event.h"

#include <array>
#include <cstdio>
#include <hoof/run_t.hpp>
#include <hoof/sample_t.hpp>
#include <lcm/lcm-cpp.hpp>
#include <stdexcept>

namespace hoof::bridge {
namespace {

using Fields = std::vector<std::pair<std::string, std::string>>;

std::string text_of(const std::string& value) {
  return value;
}
std::string text_of(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}
std::string text_of(std::int64_t value) {
  return std::to_string(value);
}
std::string text_of(std::int32_t value) {
  return std::to_string(value);
}
std::string text_of(const double (&values)[3]) {
  return text_of(values[0]) + "  " + text_of(values[1]) + "  " + text_of(values[2]);
}

Fields fields_of(const hoof::run_t& m) {
  return {{"utime", text_of(m.utime)},
          {"experiment", text_of(m.experiment)},
          {"foot", text_of(m.foot)},
          {"code_version", text_of(m.code_version)},
          {"firmware_hash", text_of(m.firmware_hash)},
          {"control_period_s", text_of(m.control_period_s)}};
}

Fields fields_of(const hoof::sample_t& m) {
  return {{"utime", text_of(m.utime)},
          {"tick", text_of(m.tick)},
          {"time_s", text_of(m.time_s)},
          {"depth_m", text_of(m.depth_m)},
          {"sink_speed_m_s", text_of(m.sink_speed_m_s)},
          {"foot_force_N", text_of(m.foot_force_N)},
          {"foot_torque_Nm", text_of(m.foot_torque_Nm)},
          {"desired_position_rad", text_of(m.desired_position_rad)},
          {"desired_velocity_rad_s", text_of(m.desired_velocity_rad_s)},
          {"desired_torque_Nm", text_of(m.desired_torque_Nm)},
          {"measured_position_rad", text_of(m.measured_position_rad)},
          {"measured_velocity_rad_s", text_of(m.measured_velocity_rad_s)},
          {"measured_torque_Nm", text_of(m.measured_torque_Nm)},
          {"mode", text_of(m.mode)},
          {"fault_bits", text_of(m.fault_bits)},
          {"limit_bits", text_of(m.limit_bits)}};
}

/// decode() refuses every other type by its fingerprint.
template <typename Message>
bool read_as(const LcmEvent& event, LcmFields& fields) {
  Message message{};
  if (message.decode(event.data.data(), 0, unsigned(event.data.size())) < 0) return false;
  fields = {std::string("hoof.") + Message::getTypeName(), fields_of(message)};
  return true;
}

}  // namespace

std::optional<LcmFields> read_fields(const LcmEvent& event) {
  LcmFields fields;
  if (read_as<hoof::sample_t>(event, fields) || read_as<hoof::run_t>(event, fields)) return fields;
  return {};
}

/// Keeps LCM out of the header.
class LcmListener::Socket {
 public:
  explicit Socket(const std::string& url) : lcm_(url) {
    if (!lcm_.good()) {
      throw std::runtime_error("LCM cannot use the address '" + url + "'" +
                               (url.empty() ? " (LCM_DEFAULT_URL, or its own default)" : ""));
    }
    // Enough for a tenth of a second of telemetry between two looks.
    lcm_.subscribe(".*", &Socket::take, this)->setQueueCapacity(1000);
  }

  void drain(const std::function<void(LcmEvent)>& take) {
    take_ = &take;
    while (lcm_.handleTimeout(0) > 0) {
    }
    take_ = nullptr;
  }

 private:
  void take(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    const auto* data = static_cast<const std::uint8_t*>(buffer->data);
    (*take_)({channel, buffer->recv_utime * 1'000, {data, data + buffer->data_size}});
  }

  lcm::LCM lcm_;
  const std::function<void(LcmEvent)>* take_ = nullptr;
};

LcmListener::LcmListener(const std::string& url) : socket_(std::make_unique<Socket>(url)) {}

LcmListener::~LcmListener() = default;

void LcmListener::drain(const std::function<void(LcmEvent)>& take) {
  socket_->drain(take);
}

}  // namespace hoof::bridge
