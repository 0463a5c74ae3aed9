#include "tools/replay/replay_bus.h"

#include "hal/can_arbitration.h"

namespace hoof::tools {

const ReplayBus::Waiting* ReplayBus::next(std::int64_t start_ns) const {
  const Waiting* best = nullptr;
  for (const Waiting& w : waiting_) {
    if (w.sent_ns > start_ns) continue;
    if (!best || hal::arbitration_key(w.frame) < hal::arbitration_key(best->frame)) best = &w;
  }
  return best;
}

const ReplayBus::Waiting* ReplayBus::find(std::uint32_t id) const {
  for (const Waiting& w : waiting_) {
    if (w.frame.id == id) return &w;
  }
  return nullptr;
}

void ReplayBus::remove(const Waiting& waiting) {
  waiting_.erase(waiting_.begin() + (&waiting - waiting_.data()));
  ++status_.sent;
}

hal::SendResult ReplayBus::send(const hal::CanFrame& frame) {
  if (waiting_.size() >= std::size_t(mailboxes_)) return hal::SendResult::kFull;
  waiting_.push_back({frame, now_ns_});
  return hal::SendResult::kQueued;
}

bool ReplayBus::receive(hal::CanFrame& frame) {
  if (received_.empty()) return false;
  frame = received_.front();
  received_.pop_front();
  ++status_.received;
  return true;
}

}  // namespace hoof::tools
