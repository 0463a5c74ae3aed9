// LCM events as plain values: heard live, and read by the types of hil_bridge/messages.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace hoof::bridge {

struct LcmEvent {
  std::string channel;
  std::int64_t stamp_ns = 0;  // of its arrival, Unix time
  std::vector<std::uint8_t> data;
};

struct LcmFields {
  std::string type;                                         // "hoof.sample_t"
  std::vector<std::pair<std::string, std::string>> fields;  // name, value; arrays in one value
};

/// By the fingerprint at the event's beginning, not by its channel.
/// @return nothing for a type of others, or an event that is cut off
std::optional<LcmFields> read_fields(const LcmEvent& event);

/// Hears every channel of one LCM address.
class LcmListener {
 public:
  /// @param url LCM provider; empty: LCM_DEFAULT_URL, else UDP multicast on this machine
  /// @throws std::runtime_error naming the address that cannot be used
  explicit LcmListener(const std::string& url);
  ~LcmListener();
  LcmListener(const LcmListener&) = delete;
  LcmListener& operator=(const LcmListener&) = delete;

  /// Hands over what has come, in order, without waiting.
  void drain(const std::function<void(LcmEvent)>& take);

 private:
  class Socket;
  std::unique_ptr<Socket> socket_;
};

}  // namespace hoof::bridge
