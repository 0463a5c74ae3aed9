#include "hal/in_process/in_process_bus.h"

#include <algorithm>
#include <cassert>
#include <stdexcept>
#include <utility>

#include "hal/can_arbitration.h"
#include "hal/can_frame_check.h"

namespace hoof::hal {
namespace {

// ISO 11898-1:2015, 12.1.4: a transmitter's error counts 8; passive from 128, off the bus above
// 255.
constexpr int kTransmitErrorWeight = 8;
constexpr int kErrorPassiveFrom = 128;
constexpr int kBusOffAbove = 255;

constexpr int kMaxMailboxes = 8;

void require(bool holds, const std::string& bus, const char* rule, std::int64_t value) {
  if (!holds) {
    throw std::invalid_argument(bus + ": " + rule + ", but it is " + std::to_string(value));
  }
}

}  // namespace

void InProcessBusSettings::validate() const {
  require(bit_rates.nominal_Hz >= 10'000 && bit_rates.nominal_Hz <= 1'000'000, name,
          "bit_rates.nominal_Hz must be 10000 to 1000000 Hz", bit_rates.nominal_Hz);
  require(bit_rates.data_Hz >= bit_rates.nominal_Hz && bit_rates.data_Hz <= 20'000'000, name,
          "bit_rates.data_Hz must be bit_rates.nominal_Hz to 20000000 Hz", bit_rates.data_Hz);
  require(mailboxes >= 1 && mailboxes <= kMaxMailboxes, name, "mailboxes must be 1 to 8",
          mailboxes);
  require(receive_queue >= 1, name, "receive_queue must be at least 1 frame", receive_queue);
}

// --- InProcessPort
// --------------------------------------------------------------------------------

InProcessPort::InProcessPort(InProcessBus& bus, std::string name, int index)
    : bus_(bus),
      name_(std::move(name)),
      index_(index),
      mailboxes_(static_cast<std::size_t>(bus.settings().mailboxes)),
      queue_(static_cast<std::size_t>(bus.settings().receive_queue)) {}

SendResult InProcessPort::send(const CanFrame& frame) {
  if (!can_exist(frame) || (frame.fd && !bus_.settings_.fd)) return SendResult::kInvalid;
  if (status_.bus_off) return SendResult::kBusOff;
  const auto free = std::find_if(mailboxes_.begin(), mailboxes_.end(),
                                 [](const Mailbox& mailbox) { return !mailbox.used; });
  if (free == mailboxes_.end()) return SendResult::kFull;
  free->used = true;
  free->on_wire = false;
  free->key = arbitration_key(frame);
  free->order = bus_.next_order_++;
  free->bits = frame_bits(frame);
  free->frame = frame;
  ++pending_count_;
  ++bus_.pending_total_;
  return SendResult::kQueued;
}

void InProcessPort::withdraw(std::uint32_t id) {
  for (Mailbox& mailbox : mailboxes_) {
    const bool waits = mailbox.used && !mailbox.on_wire;
    if (waits && mailbox.frame.id == id && !mailbox.frame.extended) give_up(mailbox);
  }
}

bool InProcessPort::receive(CanFrame& frame) {
  if (queue_size_ == 0) return false;
  frame = queue_[queue_head_];
  if (++queue_head_ == queue_.size()) queue_head_ = 0;
  --queue_size_;
  ++status_.received;
  return true;
}

void InProcessPort::set_bus_off(bool off) {
  if (off) {
    leave_bus();
    return;
  }
  transmit_errors_ = 0;
  receive_errors_ = 0;
  status_.bus_off = false;
  update_error_state();
}

void InProcessPort::leave_bus() {
  status_.bus_off = true;
  for (Mailbox& mailbox : mailboxes_) {
    if (mailbox.used && !mailbox.on_wire) give_up(mailbox);
  }
}

void InProcessPort::give_up(Mailbox& mailbox) {
  mailbox.used = false;
  --pending_count_;
  --bus_.pending_total_;
}

bool InProcessPort::accepts(const CanFrame& frame) const {
  if (filters_.empty()) return true;
  return std::any_of(filters_.begin(), filters_.end(),
                     [&](const CanFilter& filter) { return filter.accepts(frame); });
}

void InProcessPort::deliver(const CanFrame& frame) {
  if (status_.bus_off) return;
  if (receive_errors_ > 0) {
    --receive_errors_;
    update_error_state();
  }
  if (!accepts(frame)) return;
  if (queue_size_ == queue_.size()) {
    ++status_.dropped;
    return;
  }
  std::size_t tail = queue_head_ + queue_size_;
  if (tail >= queue_.size()) tail -= queue_.size();
  queue_[tail] = frame;
  ++queue_size_;
}

void InProcessPort::finish_sending() {
  for (Mailbox& mailbox : mailboxes_) {
    if (!mailbox.on_wire) continue;
    mailbox.used = false;
    mailbox.on_wire = false;
    --pending_count_;
    --bus_.pending_total_;
    if (told_of_sent_) told_of_sent_(mailbox.frame);
  }
  ++status_.sent;
  if (transmit_errors_ > 0) {
    --transmit_errors_;
    update_error_state();
  }
}

void InProcessPort::count_transmit_error() {
  transmit_errors_ += kTransmitErrorWeight;
  update_error_state();
  if (transmit_errors_ > kBusOffAbove) leave_bus();
}

void InProcessPort::count_receive_error() {
  receive_errors_ = std::min(receive_errors_ + 1, kBusOffAbove);
  update_error_state();
}

void InProcessPort::update_error_state() {
  status_.transmit_error_count =
      static_cast<std::uint8_t>(std::min(transmit_errors_, kBusOffAbove));
  status_.receive_error_count = static_cast<std::uint8_t>(receive_errors_);
  status_.error_passive =
      transmit_errors_ >= kErrorPassiveFrom || receive_errors_ >= kErrorPassiveFrom;
}

InProcessPort::Mailbox* InProcessPort::best() {
  Mailbox* best = nullptr;
  for (Mailbox& mailbox : mailboxes_) {
    if (!mailbox.used) continue;
    if (best == nullptr || mailbox.key < best->key ||
        (mailbox.key == best->key && mailbox.order < best->order)) {
      best = &mailbox;
    }
  }
  return best;
}

// --- InProcessBus
// ---------------------------------------------------------------------------------

InProcessBus::InProcessBus(InProcessBusSettings settings, Observer observer)
    : settings_(std::move(settings)),
      observer_(std::move(observer)),
      standard_counts_(kMaxStandardId + 1) {
  settings_.validate();
  intermission_ns_ = bit_time_ns({kIntermissionBits, 0}, settings_.bit_rates);
}

InProcessPort& InProcessBus::attach(std::string name) {
  const int index = static_cast<int>(ports_.size());
  ports_.push_back(
      std::unique_ptr<InProcessPort>(new InProcessPort(*this, std::move(name), index)));
  return *ports_.back();
}

void InProcessBus::advance_to(std::int64_t t_ns) {
  assert(t_ns >= now_ns_);
  while (true) {
    if (on_wire_.sender != nullptr) {
      if (on_wire_.end_ns > t_ns) break;
      finish();
    } else {
      // A frame starts only when time moves past its start: until then others may still join.
      if (pending_total_ == 0 || std::max(now_ns_, free_at_ns_) >= t_ns) break;
      start(plan());
    }
  }
  now_ns_ = t_ns;
}

std::int64_t InProcessBus::next_event_ns() const {
  if (on_wire_.sender != nullptr) return on_wire_.end_ns;
  return pending_total_ > 0 ? plan().end_ns : kNever;
}

bool InProcessBus::idle() const {
  return pending_total_ == 0 && free_at_ns_ <= now_ns_;
}

/// Arbitration among everything that is pending. All of it was sent at or before the start: what is
/// pending while the wire is free would have started, had time moved on since it was sent.
InProcessBus::Transmission InProcessBus::plan() const {
  Transmission next;
  next.start_ns = std::max(now_ns_, free_at_ns_);
  for (const auto& port : ports_) {
    if (port->pending_count_ == 0) continue;
    InProcessPort::Mailbox* mailbox = port->best();
    if (next.mailbox != nullptr && mailbox->key == next.mailbox->key) next.contested = true;
    if (next.mailbox != nullptr && mailbox->key >= next.mailbox->key) continue;
    next.sender = port.get();
    next.mailbox = mailbox;
    next.contested = false;
  }
  FrameBits bits = next.mailbox->bits;
  if (next.contested) {
    int bits_until_error = 0;
    settle_contest(next, bits_until_error);
    bits = next.destroyed ? FrameBits{bits_until_error + kErrorFrameBits, 0} : next.mailbox->bits;
  }
  next.free_ns = next.start_ns + bit_time_ns(bits, settings_.bit_rates);
  next.end_ns = next.free_ns - intermission_ns_;
  return next;
}

/// Visits every other node that sends the same arbitration field.
template <typename Visit>
void InProcessBus::for_each_rival(const Transmission& transmission, Visit&& visit) const {
  for (const auto& port : ports_) {
    if (port.get() == transmission.sender || port->pending_count_ == 0) continue;
    InProcessPort::Mailbox* mailbox = port->best();
    if (mailbox->key == transmission.mailbox->key) visit(*port, *mailbox);
  }
}

/// Several nodes send the same arbitration field: finds whose bits the wire shows, and whether one
/// of the others destroys the attempt.
void InProcessBus::settle_contest(Transmission& next, int& bits_until_error) const {
  const Transmission first_found = next;
  for_each_rival(first_found, [&](InProcessPort& port, InProcessPort::Mailbox& mailbox) {
    if (mailbox.frame == next.mailbox->frame) return;
    if (first_difference(mailbox.frame, next.mailbox->frame).first_is_dominant) {
      next.sender = &port;
      next.mailbox = &mailbox;
    }
  });
  for_each_rival(next, [&](InProcessPort& port, InProcessPort::Mailbox& mailbox) {
    if (mailbox.frame == next.mailbox->frame || port.status_.error_passive) return;
    const int bits = first_difference(mailbox.frame, next.mailbox->frame).bits;
    bits_until_error = next.destroyed ? std::min(bits_until_error, bits) : bits;
    next.destroyed = true;
  });
}

void InProcessBus::start(const Transmission& next) {
  on_wire_ = next;
  now_ns_ = next.start_ns;
  free_at_ns_ = next.free_ns;
  load_.add(next.start_ns, next.free_ns);
  next.mailbox->on_wire = true;
  if (!next.contested) return;
  for_each_rival(next, [&](InProcessPort& port, InProcessPort::Mailbox& mailbox) {
    if (next.destroyed || mailbox.frame == next.mailbox->frame) {
      mailbox.on_wire = true;
    } else {
      port.count_transmit_error();  // error-passive: drops out unheard, keeps the frame for later
    }
  });
}

void InProcessBus::finish() {
  const Transmission done = on_wire_;
  on_wire_ = {};
  now_ns_ = done.end_ns;
  if (done.destroyed) {
    finish_error();
  } else {
    finish_frame(done);
  }
}

void InProcessBus::finish_frame(const Transmission& done) {
  CanFrame frame = done.mailbox->frame;
  frame.stamp_ns = done.end_ns;
  ++frames_;
  count(frame);
  int first_sender = done.sender->index_;
  for (const auto& port : ports_) {
    const bool sends =
        port.get() == done.sender ||
        (done.contested && std::any_of(port->mailboxes_.begin(), port->mailboxes_.end(),
                                       [](const auto& mailbox) { return mailbox.on_wire; }));
    if (!sends) {
      port->deliver(frame);
      continue;
    }
    port->finish_sending();
    first_sender = std::min(first_sender, port->index_);
  }
  if (observer_) observer_(WireRecord{frame, first_sender, done.start_ns, done.end_ns});
}

void InProcessBus::finish_error() {
  ++error_frames_;
  for (const auto& port : ports_) {
    if (port->status_.bus_off && port->pending_count_ == 0) continue;
    ++port->status_.error_frames;
    bool sends = false;
    for (auto& mailbox : port->mailboxes_) {
      sends = sends || mailbox.on_wire;
      mailbox.on_wire = false;
    }
    if (sends) {
      port->count_transmit_error();
      // Left the bus meanwhile: a destroyed frame is not tried again.
      if (port->status_.bus_off) port->leave_bus();
    } else {
      port->count_receive_error();
    }
  }
}

void InProcessBus::count(const CanFrame& frame) {
  if (frame.extended) {
    ++extended_counts_[frame.id];
  } else {
    ++standard_counts_[frame.id];
  }
}

std::uint64_t InProcessBus::frames_of(std::uint32_t id, bool extended) const {
  if (!extended) return id < standard_counts_.size() ? standard_counts_[id] : 0;
  const auto found = extended_counts_.find(id);
  return found == extended_counts_.end() ? 0 : found->second;
}

}  // namespace hoof::hal
