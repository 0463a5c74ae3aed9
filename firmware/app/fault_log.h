// Faults that outlive the power, each with the ticks that led to it.
//
// The sector, in words: 0 magic (0 as soon as an erase begins) | 1 layout | 2 CRC-32 of both | then
// slots of one record each, filled in order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "firmware/app/fault_record.h"
#include "firmware/app/trace_ring.h"
#include "firmware/control/types.h"
#include "hal/nonvolatile.h"

namespace hoof::firmware::app {

enum class LogState : std::uint8_t {
  kReady = 0,
  kFull,         // readable; takes no more until erased
  kUnformatted,  // never erased by erase(), or an erase was cut: what is whole can be read
  kOtherLayout,  // of a firmware that stores otherwise: nothing can be read
};

enum class AppendResult : std::uint8_t {
  kAccepted = 0,
  kBusy,          // another record is being written; that one is the cause, this one is lost
  kFull,          // no slot is left; lost
  kNotFormatted,  // lost
};

enum class EraseResult : std::uint8_t {
  kOk = 0,
  kWrongMode,    // erasing stalls the core: mode off only
  kBusy,         // a record is being written
  kFlashFailed,  // the log is not ready afterwards
};

/// Never erases by itself: while the foot moves, records go to words erased beforehand, a few words
/// a tick, and when they are used up the log stops and says so. A record cut by the power failing
/// is known by its CRC; the next one goes behind it.
class FaultLog {
 public:
  using Word = hal::Nonvolatile::Word;
  static constexpr std::uint32_t kLayout = 2;
  /// 200 us of a tick at the flash's worst, 32 as a rule: a record takes 148 ticks.
  static constexpr std::size_t kWordsPerStep = 2;

  /// @param sector used for nothing else; 16 KB hold 13 records
  FaultLog(hal::Nonvolatile& flash, std::size_t sector);

  LogState state() const { return state_; }
  std::size_t capacity() const;
  /// Slots in use, those of cut records included.
  std::size_t used() const { return used_; }
  /// Faults since start that found no room, or flash that would not take them.
  std::uint32_t lost() const { return lost_; }
  bool writing() const { return writing_; }

  /// Oldest first. Nothing for a cut record, and beyond used().
  std::optional<FaultRecord> read(std::size_t slot) const;
  /// One word of a record as it stands in the flash, for a reader elsewhere that decodes it.
  Word word(std::size_t slot, std::size_t index) const;

  /// Once per tick, whatever the mode.
  void trace(const TraceSample& sample) { ring_.put(sample); }

  /// Takes the fault and the trace up to the last trace(); step() writes them.
  AppendResult append(control::FaultBits faults, control::Mode mode, std::uint32_t tick,
                      std::int64_t time_ns);

  /// Once per tick: programs up to kWordsPerStep words of the record under way.
  void step();

  /// Empties the log: stalls the core for up to half a second.
  EraseResult erase(control::Mode mode);

 private:
  void open();
  LogState read_header() const;
  bool write_header();
  bool blank(std::size_t slot) const;
  bool program_next_word();
  void leave_slot();

  hal::Nonvolatile& flash_;
  std::size_t sector_;
  LogState state_ = LogState::kUnformatted;
  std::size_t used_ = 0;
  std::uint32_t lost_ = 0;
  TraceRing ring_;
  FaultRecordWords pending_{};
  std::size_t written_ = 0;  // words of `pending_`
  bool writing_ = false;
};

}  // namespace hoof::firmware::app
