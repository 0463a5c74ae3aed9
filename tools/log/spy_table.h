// What a live view shows: the last frame of each message on the bus, or the last event of each LCM
// channel, and how often it comes.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "hal/can_frame.h"
#include "hil_bridge/lcm_event.h"
#include "tools/log/decoded_frame.h"

namespace hoof::tools {

class SpyTable {
 public:
  /// Rates are those of the last second before the newest frame.
  static constexpr std::int64_t kRateWindow_ns = 1'000'000'000;

  /// @param stamp_ns on any clock, the same for all
  void add(const std::string& interface, const hal::CanFrame& frame, std::int64_t stamp_ns);

  void add(const bridge::LcmEvent& event);

  /// Frames, or events.
  std::uint64_t frames() const { return frames_; }
  int messages() const { return int(rows_.size()); }

  /// The view as lines of at most `width` columns, `height` in all: the messages around the
  /// selected one, and below them its signals. A height of 0 is no bound and shows all signals.
  std::string render(const std::string& title, int selected, int width, int height) const;

 private:
  struct Row {
    std::variant<hal::CanFrame, bridge::LcmEvent> last;
    std::uint64_t count = 0;
    std::deque<std::int64_t> recent_ns;
  };
  /// Of a frame its interface and identifier, of an event its channel and 0.
  using Key = std::pair<std::string, std::uint64_t>;

  void count(Row& row, std::int64_t stamp_ns);
  double rate_Hz(const Row& row) const;
  std::string line_of(const Key& key, const Row& row) const;
  static std::vector<std::string> details_of(const Row& row);

  std::map<Key, Row> rows_;
  std::uint64_t frames_ = 0;
  std::int64_t newest_ns_ = 0;
};

}  // namespace hoof::tools
