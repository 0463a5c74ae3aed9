#include "firmware/app/fault_log.h"

#include <array>

#include "firmware/app/crc32.h"

namespace hoof::firmware::app {
namespace {

using hal::FlashResult;
using hal::Nonvolatile;
using Word = Nonvolatile::Word;

constexpr Word kMagic = 0x4846'4C47;  // "HFLG"
constexpr std::size_t kMagicWord = 0;

using Header = std::array<Word, 3>;
constexpr std::size_t kFirstSlotWord = std::tuple_size_v<Header>;

constexpr Header make_header(Word layout) {
  const std::array<Word, 2> content{kMagic, layout};
  return {kMagic, layout, Crc32().add(content).value()};
}

constexpr std::size_t slot_word(std::size_t slot) {
  return kFirstSlotWord + slot * kFaultRecordWords;
}

}  // namespace

FaultLog::FaultLog(Nonvolatile& flash, std::size_t sector) : flash_(flash), sector_(sector) {
  open();
}

std::size_t FaultLog::capacity() const {
  const std::size_t words = flash_.sector_words(sector_);
  return words < kFirstSlotWord ? 0 : (words - kFirstSlotWord) / kFaultRecordWords;
}

std::optional<FaultRecord> FaultLog::read(std::size_t slot) const {
  if (slot >= used_) return std::nullopt;
  FaultRecordWords words;
  for (std::size_t i = 0; i < words.size(); ++i) words[i] = word(slot, i);
  return decode(words);
}

FaultLog::Word FaultLog::word(std::size_t slot, std::size_t index) const {
  return flash_.read(sector_, slot_word(slot) + index);
}

AppendResult FaultLog::append(control::FaultBits faults, control::Mode mode, std::uint32_t tick,
                              std::int64_t time_ns) {
  if (writing_ || state_ != LogState::kReady) {
    ++lost_;
    if (writing_) return AppendResult::kBusy;
    return state_ == LogState::kFull ? AppendResult::kFull : AppendResult::kNotFormatted;
  }
  FaultRecord record{.time_ns = time_ns,
                     .tick = tick,
                     .faults = faults,
                     .mode = mode,
                     .trace_count = ring_.count()};
  for (std::size_t age = 0; age < ring_.count(); ++age) record.trace[age] = ring_.newest(age);
  encode(record, pending_);
  written_ = 0;
  writing_ = true;
  return AppendResult::kAccepted;
}

void FaultLog::step() {
  for (std::size_t i = 0; i < kWordsPerStep && writing_; ++i) {
    if (!program_next_word()) {
      written_ = 0;  // a bad word: once more, in the next slot
      leave_slot();
      if (state_ != LogState::kFull) continue;
      writing_ = false;
      ++lost_;
    } else if (written_ == pending_.size()) {
      writing_ = false;
      leave_slot();
    }
  }
}

EraseResult FaultLog::erase(control::Mode mode) {
  if (mode != control::Mode::kOff) return EraseResult::kWrongMode;
  if (writing_) return EraseResult::kBusy;
  // A cut erase must never pass for a log; zero may be programmed over anything.
  const bool erased = flash_.program(sector_, kMagicWord, 0) == FlashResult::kOk &&
                      flash_.erase(sector_) == FlashResult::kOk && write_header();
  open();
  return erased && state_ == LogState::kReady ? EraseResult::kOk : EraseResult::kFlashFailed;
}

void FaultLog::open() {
  state_ = read_header();
  used_ = 0;
  if (state_ == LogState::kOtherLayout) return;
  // Behind the last slot with anything in it, be it torn.
  for (std::size_t slot = 0; slot < capacity(); ++slot) {
    if (!blank(slot)) used_ = slot + 1;
  }
  if (state_ == LogState::kReady && used_ == capacity()) state_ = LogState::kFull;
}

LogState FaultLog::read_header() const {
  Header header;
  for (std::size_t i = 0; i < header.size(); ++i) {
    header[i] = flash_.read(sector_, i);
  }
  if (header != make_header(header[1])) return LogState::kUnformatted;
  return header[1] == kLayout ? LogState::kReady : LogState::kOtherLayout;
}

bool FaultLog::write_header() {
  const Header header = make_header(kLayout);
  for (std::size_t i = 0; i < header.size(); ++i) {
    if (flash_.program(sector_, i, header[i]) != FlashResult::kOk) return false;
  }
  return true;
}

bool FaultLog::blank(std::size_t slot) const {
  for (std::size_t i = 0; i < kFaultRecordWords; ++i) {
    if (flash_.read(sector_, slot_word(slot) + i) != Nonvolatile::kErased) return false;
  }
  return true;
}

bool FaultLog::program_next_word() {
  const std::size_t word = slot_word(used_) + written_;
  const Word value = pending_[written_];
  if (flash_.program(sector_, word, value) != FlashResult::kOk) return false;
  if (flash_.read(sector_, word) != value) return false;
  ++written_;
  return true;
}

void FaultLog::leave_slot() {
  ++used_;
  if (used_ == capacity()) state_ = LogState::kFull;
}

}  // namespace hoof::firmware::app
