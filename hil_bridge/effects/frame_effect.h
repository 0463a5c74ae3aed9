// One thing that goes wrong with frames on their way from a node to the wire. Off until started.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "hal/can_frame.h"

namespace hoof::bridge {

enum class FrameEffectKind {
  kDrop,       // a frame is lost, with a probability
  kDelay,      // each frame waits
  kJitter,     // each frame waits for a random time, evenly from 0 to the delay
  kReorder,    // of two frames the second goes first
  kDuplicate,  // each frame goes out so often more
  kCorrupt,    // so many bits of the payload are flipped; the frame's own CRC fits them
  kSilent,     // the node sends nothing and notices nothing
  kDead,       // the node sends nothing and hears nothing
  kBusOff,     // the node's controller left the bus, and the node can know
};

/// Which frames: of one node, of one bus, under one identifier; what is not set is any.
struct FrameTarget {
  std::optional<std::string> node;
  std::optional<int> bus;
  std::optional<std::uint32_t> id;

  bool has_node(const std::string& name, int on_bus) const {
    return (!node || *node == name) && (!bus || *bus == on_bus);
  }
};

/// A frame on its way, and how long it is still held back.
struct Passing {
  hal::CanFrame frame;
  std::int64_t hold_ns = 0;
};

struct FrameEffectSettings {
  FrameEffectKind kind = FrameEffectKind::kDrop;
  FrameTarget target;
  double probability = 1;
  std::int64_t delay_ns = 0;
  int count = 1;  // copies, or bits
  std::uint64_t seed = 1;
};

class FrameEffect {
 public:
  explicit FrameEffect(FrameEffectSettings settings)
      : settings_(std::move(settings)), random_(settings_.seed) {}

  void start() { active_ = true; }
  void stop() { active_ = false; }
  bool active() const { return active_; }
  const FrameEffectSettings& settings() const { return settings_; }

  /// All frames that leave one port at once, changed to what really leaves.
  /// @param port any number that stands for it
  void pass(int port, std::vector<Passing>& frames);

  /// True where the node's frames do not get out, do not get in, or it can know why.
  bool mutes() const { return active_ && settings_.kind >= FrameEffectKind::kSilent; }
  bool deafens() const { return active_ && settings_.kind >= FrameEffectKind::kDead; }
  bool bus_off() const { return active_ && settings_.kind == FrameEffectKind::kBusOff; }

  void count() { ++changed_; }
  /// Frames that were lost, late, doubled or altered.
  std::uint64_t changed() const { return changed_; }
  /// False once it is stopped and holds no frame back.
  bool concerns_frames() const { return active_ || !held_.empty(); }

 private:
  bool concerns(const hal::CanFrame& frame) const;
  void pass_one(int port, const Passing& passing, std::vector<Passing>& out);
  void reorder(int port, const Passing& passing, std::vector<Passing>& out);
  void corrupt(hal::CanFrame& frame);
  double uniform() { return double(random_() >> 11) * 0x1p-53; }

  FrameEffectSettings settings_;
  std::mt19937_64 random_;
  bool active_ = false;
  std::map<int, Passing> held_;  // by port, the frame that is to be overtaken
  std::uint64_t changed_ = 0;
};

}  // namespace hoof::bridge
