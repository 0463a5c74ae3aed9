// Wires on which frames get lost, late, doubled or altered, nodes fall silent, and strangers talk.
#pragma once

#include <memory>
#include <vector>

#include "hil_bridge/effects/frame_effect.h"
#include "hil_bridge/wires.h"

namespace hoof::bridge {

/// A node that sends one frame as often as the wire takes it, or at a rate.
struct Flood {
  int bus = 0;
  hal::CanFrame frame;
  std::int64_t period_ns = 0;  // 0: whenever a mailbox is free

  bool active = false;
  std::uint64_t sent = 0;
  std::int64_t next_ns = 0;
  hal::CanBus* port = nullptr;  // set by the wires
};

/// Acts on what nodes send, so that the log of the inner wires shows what really was on them. A
/// node whose frame was lost is told that it was sent. Effects and floods must outlive the wires.
class FaultyWires final : public Wires {
 public:
  explicit FaultyWires(Wires& inner);
  ~FaultyWires() override;

  /// At any time; acts on nodes attached before and later.
  void add(FrameEffect& effect);
  void add(Flood& flood);

  hal::CanBus& attach(int bus, const std::string& node) override;
  void advance_to(std::int64_t t_ns) override;
  double load_ratio(int bus) const override { return inner_.load_ratio(bus); }
  double worst_load_ratio(int bus) const override { return inner_.worst_load_ratio(bus); }
  std::uint64_t frames() const override { return inner_.frames(); }
  std::uint64_t dropped() const override { return inner_.dropped(); }
  bool one_wire() const override { return inner_.one_wire(); }

  /// SYNC frames that found the master's mailboxes full.
  std::uint64_t lost_syncs() const { return lost_syncs_; }

 private:
  class Port;
  friend class Port;

  Wires& inner_;
  std::vector<FrameEffect*> effects_;
  std::vector<Flood*> floods_;
  std::vector<std::unique_ptr<Port>> ports_;
  std::int64_t now_ns_ = 0;
  std::uint64_t lost_syncs_ = 0;
};

}  // namespace hoof::bridge
