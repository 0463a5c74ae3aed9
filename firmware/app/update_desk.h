// A new image, word by word, into the slot that does not run; and the trial of one that does.
#pragma once

#include <cstdint>
#include <optional>

#include "firmware/app/crc32.h"
#include "firmware/protocol/messages.h"
#include "firmware/protocol/protocol_hash.h"
#include "firmware/update/image_slot.h"
#include "hal/image_slots.h"

namespace hoof::firmware::app {

/// Of this image: stands in its header.
inline constexpr std::uint32_t kSpokenDictionary = protocol::kProtocolHash;

/// How the loop fares, for the judgement of an image on trial.
struct Health {
  bool idle = false;    // no drive is under torque, nor will be without an order
  bool faulty = false;  // a latched fault, or a bus that is off
  std::uint32_t ticks = 0;
  std::uint32_t overruns = 0;
};

/// Each object is written by a ParameterWrite, so what holds for parameters holds here: owner,
/// expected counter, mode off. The counter makes each word come once and in order; the receiver
/// tells which it expects next, and whoever sends goes on from there.
///
///   open      starts a transfer; the next words are the header's
///   word      the next word: 32 of the header, then those of the image
///   erase     once the header was found good: empties the spare slot, up to 2 s
///   finish    once all words came and their CRC-32 is the header's: the slot is complete
///   restart   to the boot loader, which looks at the signature
///   confirm   the image that runs on trial does what it should
///
/// The former image stays as it is all the time. An image on trial is healthy where it has run for
/// two seconds without a fault, without an overrun, and, if there is a SYNC, for 1000 ticks; the
/// host's word that confirms it came over the bus and its answer goes there, which is the rest of
/// the proof. Not confirmed within a minute it refuses itself and restarts.
class UpdateDesk {
 public:
  static constexpr std::int64_t kTrial_ns = 60'000'000'000;
  static constexpr std::int64_t kHealthyAfter_ns = 2'000'000'000;
  static constexpr std::uint32_t kHealthyTicks = 1000;

  /// @param board null where there are no slots: then everything is refused
  explicit UpdateDesk(hal::ImageSlots* board);

  /// Whether a ParameterWrite of this index is for this desk.
  static constexpr bool owns(std::uint8_t index) {
    return index >= static_cast<std::uint8_t>(protocol::UpdateObject::kOpen);
  }

  protocol::ServiceResult write(std::uint8_t object, std::uint32_t value);

  /// Nothing where it is not of the update's.
  std::optional<std::uint32_t> status(protocol::Status what) const;

  /// Whether poll() has anything to do.
  bool watches() const { return trial_ || restart_; }
  /// At every poll: the trial's time, a restart that is due.
  void poll(std::int64_t now_ns, const Health& health);
  bool restart_pending() const { return restart_; }

 private:
  using Result = protocol::ServiceResult;
  using Problem = update::Problem;
  enum class State : std::uint8_t { kIdle = 0, kHeader, kChecked, kReceiving, kComplete };

  update::ImageSlot running() const { return {board_->flash(), board_->running()}; }
  update::ImageSlot spare() const { return {board_->flash(), 1 - board_->running()}; }
  bool on_trial() const;
  bool healthy() const;

  Result open();
  Result take_word(std::uint32_t word);
  Result take_header_word(std::uint32_t word);
  Result program(std::size_t place, std::uint32_t word);
  Result erase();
  Result finish();
  Result restart();
  Result confirm(std::uint32_t version);
  Result fail(Problem problem, Result result);
  std::uint32_t words() const { return update::ImageHeader::kWords + header_.bytes() / 4; }

  hal::ImageSlots* board_;
  State state_ = State::kIdle;
  Problem problem_ = Problem::kNone;
  update::ImageHeader header_;
  Crc32 crc_;
  std::uint32_t next_ = 0;  // word that is expected
  bool restart_ = false;
  bool trial_ = false;
  std::int64_t started_ns_ = -1;
  std::int64_t now_ns_ = 0;
  std::int64_t restart_ns_ = -1;  // not yet known
  Health health_;
};

}  // namespace hoof::firmware::app
