// Parameters that outlive the power: two copies in flash, one of which is always whole.
//
// A record, in words from the start of its sector:
//   0 magic | 1 layout | 2 sequence | 3 entries n | n times: CRC-32 of the name, value (binary32)
//   4 + 2 n  CRC-32 of all words before
//   5 + 2 n  mark: erased until all before it was read back; then 0
// This frame is the same in all layouts; the layout says what the entries mean.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "firmware/app/parameters.h"
#include "firmware/control/types.h"
#include "hal/nonvolatile.h"

namespace hoof::firmware::app {

enum class LoadResult : std::uint8_t {
  kOk = 0,
  kEmpty,        // nothing was ever stored: defaults
  kDamaged,      // something is there, but no whole record: defaults
  kOtherLayout,  // the newest record is of a firmware that stores otherwise: defaults
};

struct LoadReport {
  LoadResult result = LoadResult::kEmpty;
  std::uint32_t sequence = 0;      // of the record; counts stores
  std::uint32_t layout = 0;        // of the record
  std::uint16_t unknown = 0;       // stored names that this firmware does not have: left out
  std::uint16_t missing = 0;       // names that the record does not have: at their defaults
  std::uint16_t out_of_range = 0;  // values beyond today's bounds: at their defaults

  /// Every parameter came back, and nothing was left over.
  bool complete() const {
    return result == LoadResult::kOk && unknown == 0 && missing == 0 && out_of_range == 0;
  }
};

enum class StoreResult : std::uint8_t {
  kOk = 0,
  kWrongMode,   // erasing stalls the core: mode off only
  kOutOfRange,  // a value that load() would not take; nothing was written
  kTooLarge,    // the table does not fit a record or the sector; nothing was written
  kFlashFailed  // did not read back as written; the former set is still there
};

/// A store writes the sector that does not hold the present record. Whenever the power fails, the
/// next load() finds the former set or the new one, and every load() after it the same.
class ParameterStore {
 public:
  using Word = hal::Nonvolatile::Word;
  static constexpr std::uint32_t kLayout = 1;
  static constexpr std::size_t kMaxEntries =
      128;  // 2 KB of stack for two records; today's table has 44

  /// @param sectors two different ones, used for nothing else
  ParameterStore(hal::Nonvolatile& flash, std::array<std::size_t, 2> sectors,
                 std::span<const ParameterEntry> table = parameter_table())
      : flash_(flash), sectors_(sectors), table_(table) {}

  /// Sets all parameters: what was stored, defaults for the rest. Programs up to two words, to
  /// settle what a power cut left in doubt; for the start, before the drives are entered.
  LoadReport load(Parameters& parameters);

  /// Erases a sector and writes it: stalls the core for up to half a second.
  StoreResult store(const Parameters& parameters, control::Mode mode);

 private:
  static constexpr std::size_t kHeaderWords = 4;
  static constexpr std::size_t kMaxWords = kHeaderWords + 2 * kMaxEntries + 1;

  /// Copied out of the flash once: a word that was cut may read otherwise the next time.
  struct Record {
    std::array<Word, kMaxWords> words;
    std::size_t count = 0;  // CRC included, mark not
    std::size_t copy = 0;   // which of the two sectors
    Word mark = hal::Nonvolatile::kErased;

    std::uint32_t layout() const { return words[1]; }
    std::uint32_t sequence() const { return words[2]; }
    std::size_t entries() const { return words[3]; }
    bool marked() const { return mark != hal::Nonvolatile::kErased; }
  };

  bool read_copy(std::size_t copy, Record& record) const;
  bool read_newest(Record& newest, std::optional<std::size_t>& refused) const;
  void settle(const Record& newest, std::optional<std::size_t> refused);
  void apply(const Record& record, Parameters& parameters, LoadReport& report) const;
  bool encode(const Parameters& parameters, Record& record) const;
  bool write(const Record& record);
  bool blank() const;

  hal::Nonvolatile& flash_;
  std::array<std::size_t, 2> sectors_;
  std::span<const ParameterEntry> table_;
};

}  // namespace hoof::firmware::app
