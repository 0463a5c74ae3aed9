#include "hil_bridge/effects/frame_effect.h"

namespace hoof::bridge {

bool FrameEffect::concerns(const hal::CanFrame& frame) const {
  return !settings_.target.id || (*settings_.target.id == frame.id && !frame.extended);
}

void FrameEffect::pass(int port, std::vector<Passing>& frames) {
  std::vector<Passing> out;
  for (const Passing& passing : frames) {
    if (concerns(passing.frame)) {
      pass_one(port, passing, out);
    } else {
      out.push_back(passing);
    }
  }
  frames = std::move(out);
}

void FrameEffect::pass_one(int port, const Passing& passing, std::vector<Passing>& out) {
  if (settings_.kind == FrameEffectKind::kReorder) return reorder(port, passing, out);
  const bool hit = settings_.probability >= 1 || uniform() < settings_.probability;
  out.push_back(passing);
  if (!active_ || !hit) return;
  switch (settings_.kind) {
    case FrameEffectKind::kDrop:
      out.pop_back();
      break;
    case FrameEffectKind::kDelay:
      out.back().hold_ns += settings_.delay_ns;
      break;
    case FrameEffectKind::kJitter:
      out.back().hold_ns += std::int64_t(uniform() * double(settings_.delay_ns));
      break;
    case FrameEffectKind::kDuplicate:
      out.insert(out.end(), std::size_t(settings_.count), passing);
      break;
    case FrameEffectKind::kCorrupt:
      if (passing.frame.length == 0) return;
      corrupt(out.back().frame);
      break;
    case FrameEffectKind::kReorder:
    case FrameEffectKind::kSilent:
    case FrameEffectKind::kDead:
    case FrameEffectKind::kBusOff:
      return;
  }
  ++changed_;
}

/// Frame 1 waits for frame 2 and follows it, 3 waits for 4, and so on. One that still waits at the
/// end goes out behind the next.
void FrameEffect::reorder(int port, const Passing& passing, std::vector<Passing>& out) {
  const auto kept = held_.find(port);
  if (kept == held_.end()) {
    if (active_) {
      held_.emplace(port, passing);
    } else {
      out.push_back(passing);
    }
    return;
  }
  out.push_back(passing);
  out.push_back(kept->second);
  held_.erase(kept);
  ++changed_;
}

/// Different bits, so that an even number of flips cannot undo itself.
void FrameEffect::corrupt(hal::CanFrame& frame) {
  const std::uint64_t bits = 8u * frame.length;
  std::vector<std::uint64_t> flipped;
  while (flipped.size() < std::uint64_t(settings_.count) && flipped.size() < bits) {
    const std::uint64_t bit = random_() % bits;
    bool again = false;
    for (const std::uint64_t b : flipped) again = again || b == bit;
    if (again) continue;
    flipped.push_back(bit);
    frame.data[bit / 8] = std::uint8_t(frame.data[bit / 8] ^ (1u << bit % 8));
  }
}

}  // namespace hoof::bridge
