#include "firmware/app/parameter_store.h"

#include <bit>

#include "firmware/app/crc32.h"

namespace hoof::firmware::app {
namespace {

using hal::FlashResult;
using hal::Nonvolatile;

constexpr Nonvolatile::Word kMagic = 0x4846'5052;  // "HFPR"
constexpr Nonvolatile::Word kMarked = 0;

bool in_range(const ParameterEntry& entry, float value) {
  return value >= entry.minimum && value <= entry.maximum;  // false for not-a-number
}

std::uint32_t name_hash(const ParameterEntry& entry) {
  return Crc32().add(entry.name).value();
}

}  // namespace

LoadReport ParameterStore::load(Parameters& parameters) {
  parameters = Parameters{};
  LoadReport report;
  Record record;
  std::optional<std::size_t> refused;
  if (!read_newest(record, refused)) {
    report.result = blank() ? LoadResult::kEmpty : LoadResult::kDamaged;
    return report;
  }
  settle(record, refused);
  report.layout = record.layout();
  report.sequence = record.sequence();
  report.result = record.layout() == kLayout ? LoadResult::kOk : LoadResult::kOtherLayout;
  if (report.result == LoadResult::kOk) apply(record, parameters, report);
  return report;
}

StoreResult ParameterStore::store(const Parameters& parameters, control::Mode mode) {
  if (mode != control::Mode::kOff) return StoreResult::kWrongMode;
  if (table_.size() > kMaxEntries) return StoreResult::kTooLarge;
  Record record;
  std::optional<std::size_t> refused;
  const bool have_former = read_newest(record, refused);
  const std::uint32_t sequence = have_former ? record.sequence() + 1 : 1;
  record.copy = have_former ? 1 - record.copy : 0;
  record.words[2] = sequence;
  if (!encode(parameters, record)) return StoreResult::kOutOfRange;
  if (record.count + 1 > flash_.sector_words(sectors_[record.copy])) return StoreResult::kTooLarge;
  return write(record) ? StoreResult::kOk : StoreResult::kFlashFailed;
}

/// @return whether the copy is whole, marked or not
bool ParameterStore::read_copy(std::size_t copy, Record& record) const {
  const std::size_t sector = sectors_[copy];
  const auto read = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) record.words[i] = flash_.read(sector, i);
  };
  read(0, kHeaderWords);
  if (record.words[0] != kMagic || record.entries() > kMaxEntries) return false;
  record.copy = copy;
  record.count = kHeaderWords + 2 * record.entries() + 1;
  read(kHeaderWords, record.count);
  record.mark = flash_.read(sector, record.count);
  const std::span<const Word> words(record.words);
  return Crc32().add(words.first(record.count - 1)).value() == record.words[record.count - 1];
}

/// The newest marked record. A record without mark was cut right at its end: its last words may be
/// unstable, so it counts only where there is no other.
/// @param refused the copy with a whole record that was not chosen although it is newer
bool ParameterStore::read_newest(Record& newest, std::optional<std::size_t>& refused) const {
  Record other;
  const bool first = read_copy(0, newest);
  const bool second = read_copy(1, other);
  if (!second) return first;
  if (first) {
    const bool newer = other.sequence() > newest.sequence();  // 10,000 erases: it never wraps
    const bool take_other = other.marked() != newest.marked() ? other.marked() : newer;
    if (take_other != newer) refused = take_other ? newest.copy : other.copy;
    if (!take_other) return true;
  }
  newest = other;
  return true;
}

/// A cut word may read otherwise at the next start; after this the choice stays the same. Zero may
/// be programmed over anything.
void ParameterStore::settle(const Record& newest, std::optional<std::size_t> refused) {
  if (newest.marked() && newest.mark != kMarked) {
    flash_.program(sectors_[newest.copy], newest.count, kMarked);
  }
  if (refused) flash_.program(sectors_[*refused], 0, 0);  // no magic, no record
}

void ParameterStore::apply(const Record& record, Parameters& parameters, LoadReport& report) const {
  std::size_t known = 0;
  for (const ParameterEntry& entry : table_) {
    const std::uint32_t hash = name_hash(entry);
    bool found = false;
    for (std::size_t i = 0; i < record.entries() && !found; ++i) {
      const std::size_t word = kHeaderWords + 2 * i;
      if (record.words[word] != hash) continue;
      found = true;
      const float value = std::bit_cast<float>(record.words[word + 1]);
      if (in_range(entry, value)) {
        entry.value(parameters) = value;
      } else {
        ++report.out_of_range;
      }
    }
    if (found) {
      ++known;
    } else {
      ++report.missing;
    }
  }
  report.unknown = static_cast<std::uint16_t>(record.entries() - known);
}

/// Fills in all but the sequence. @return false for a value out of its range
bool ParameterStore::encode(const Parameters& parameters, Record& record) const {
  Parameters copy = parameters;  // the table's accessors give references to change
  record.words[0] = kMagic;
  record.words[1] = kLayout;
  record.words[3] = static_cast<Word>(table_.size());
  record.count = kHeaderWords;
  for (const ParameterEntry& entry : table_) {
    const float value = entry.value(copy);
    if (!in_range(entry, value)) return false;
    record.words[record.count++] = name_hash(entry);
    record.words[record.count++] = std::bit_cast<Word>(value);
  }
  const std::span<const Word> words(record.words);
  record.words[record.count] = Crc32().add(words.first(record.count)).value();
  ++record.count;
  return true;
}

bool ParameterStore::write(const Record& record) {
  const std::size_t sector = sectors_[record.copy];
  if (flash_.erase(sector) != FlashResult::kOk) return false;
  for (std::size_t i = 0; i < record.count; ++i) {
    if (flash_.program(sector, i, record.words[i]) != FlashResult::kOk) return false;
  }
  for (std::size_t i = 0; i < record.count; ++i) {
    if (flash_.read(sector, i) != record.words[i]) return false;
  }
  return flash_.program(sector, record.count, kMarked) == FlashResult::kOk &&
         flash_.read(sector, record.count) == kMarked;
}

bool ParameterStore::blank() const {
  for (const std::size_t sector : sectors_) {
    for (std::size_t i = 0; i < flash_.sector_words(sector); ++i) {
      if (flash_.read(sector, i) != Nonvolatile::kErased) return false;
    }
  }
  return true;
}

}  // namespace hoof::firmware::app
