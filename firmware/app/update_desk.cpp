#include "firmware/app/update_desk.h"

#include "firmware/app/parameters.h"

namespace hoof::firmware::app {

using protocol::Status;
using protocol::UpdateObject;
using update::ImageHeader;

namespace {

/// The answer to the order to restart has to get out first.
constexpr std::int64_t kBeforeRestart_ns = 20'000'000;

}  // namespace

UpdateDesk::UpdateDesk(hal::ImageSlots* board) : board_(board), trial_(on_trial()) {}

/// Without a boot loader that counts attempts there is no trial.
bool UpdateDesk::on_trial() const {
  if (board_ == nullptr) return false;
  const update::ImageSlot slot = running();
  return slot.attempts() > 0 && !slot.confirmed();
}

bool UpdateDesk::healthy() const {
  const bool long_enough = started_ns_ >= 0 && now_ns_ - started_ns_ >= kHealthyAfter_ns;
  const bool ticked = health_.ticks == 0 || health_.ticks >= kHealthyTicks;
  return long_enough && ticked && !health_.faulty && health_.overruns == 0;
}

protocol::ServiceResult UpdateDesk::write(std::uint8_t object, std::uint32_t value) {
  if (board_ == nullptr) return Result::kNoStorage;
  switch (static_cast<UpdateObject>(object)) {
    case UpdateObject::kOpen:
      return open();
    case UpdateObject::kWord:
      return take_word(value);
    case UpdateObject::kErase:
      return erase();
    case UpdateObject::kFinish:
      return finish();
    case UpdateObject::kRestart:
      return restart();
    case UpdateObject::kConfirm:
      return confirm(value);
  }
  return Result::kNoSuchIndex;
}

/// On trial the spare slot holds the image to go back to.
protocol::ServiceResult UpdateDesk::open() {
  if (trial_ || restart_) return Result::kBusy;
  state_ = State::kHeader;
  problem_ = Problem::kNone;
  header_ = {};
  next_ = 0;
  crc_ = {};
  return Result::kDone;
}

protocol::ServiceResult UpdateDesk::take_word(std::uint32_t word) {
  if (state_ == State::kHeader) return take_header_word(word);
  if (state_ != State::kReceiving || next_ >= words()) return Result::kNothingThere;
  const std::size_t place = update::kHeaderWords + next_ - ImageHeader::kWords;
  const Result result = program(place, word);
  if (result != Result::kDone) return result;
  const std::uint32_t stored = board_->flash().read(spare().number(), place);
  crc_.add(std::span(&stored, 1));
  ++next_;
  return Result::kDone;
}

/// Refused before anything is erased: the spare slot may hold what one wants to go back to.
protocol::ServiceResult UpdateDesk::take_header_word(std::uint32_t word) {
  header_.word[next_++] = word;
  if (next_ < ImageHeader::kWords) return Result::kDone;
  const update::ImageSlot slot = spare();
  const Problem found = examine(header_, update::kFootBoard, slot.number(), slot.words());
  if (found != Problem::kNone) return fail(found, Result::kOutOfRange);
  if (header_.version() <= running().header().version()) {
    return fail(Problem::kNotNewer, Result::kOutOfRange);
  }
  state_ = State::kChecked;
  return Result::kDone;
}

protocol::ServiceResult UpdateDesk::program(std::size_t place, std::uint32_t word) {
  hal::Nonvolatile& flash = board_->flash();
  const std::size_t slot = spare().number();
  const bool good = word == hal::Nonvolatile::kErased
                        ? flash.read(slot, place) == word
                        : flash.program(slot, place, word) == hal::FlashResult::kOk &&
                              flash.read(slot, place) == word;
  return good ? Result::kDone : fail(Problem::kFlash, Result::kFlashFailed);
}

/// A cut erase must never leave what passes for an image; zero may be programmed over anything.
protocol::ServiceResult UpdateDesk::erase() {
  const bool again = state_ == State::kReceiving && next_ == ImageHeader::kWords;
  if (again) return Result::kDone;
  if (state_ != State::kChecked) return Result::kNothingThere;
  hal::Nonvolatile& flash = board_->flash();
  const std::size_t slot = spare().number();
  const bool erased = flash.program(slot, ImageHeader::kMagicWord, 0) == hal::FlashResult::kOk &&
                      flash.erase(slot) == hal::FlashResult::kOk;
  if (!erased) return fail(Problem::kFlash, Result::kFlashFailed);
  state_ = State::kReceiving;
  return Result::kDone;
}

protocol::ServiceResult UpdateDesk::finish() {
  if (state_ == State::kComplete) return Result::kDone;
  if (state_ != State::kReceiving || next_ != words()) return Result::kNothingThere;
  if (crc_.value() != header_.crc()) return fail(Problem::kChecksum, Result::kOutOfRange);
  for (std::size_t i = ImageHeader::kMagicWord; i < ImageHeader::kWords; ++i) {
    const Result result = program(i, header_.word[i]);
    if (result != Result::kDone) return result;
  }
  const Result result = program(ImageHeader::kCompleteWord, 0);
  if (result == Result::kDone) state_ = State::kComplete;
  return result;
}

protocol::ServiceResult UpdateDesk::restart() {
  if (state_ != State::kComplete) return Result::kNothingThere;
  restart_ = true;
  restart_ns_ = -1;
  return Result::kDone;
}

protocol::ServiceResult UpdateDesk::confirm(std::uint32_t version) {
  if (version != running().header().version()) return Result::kOutOfRange;
  if (!trial_) return running().confirmed() ? Result::kDone : Result::kNothingThere;
  if (!healthy()) return Result::kBusy;
  if (!running().confirm()) return Result::kFlashFailed;
  trial_ = false;
  return Result::kDone;
}

protocol::ServiceResult UpdateDesk::fail(Problem problem, Result result) {
  state_ = State::kIdle;
  problem_ = problem;
  return result;
}

std::optional<std::uint32_t> UpdateDesk::status(Status what) const {
  if (board_ == nullptr) return std::nullopt;
  const update::ImageSlot slot = running(), other = spare();
  const auto version_of = [](const update::ImageSlot& s) {
    return s.complete() ? s.header().version() : hal::Nonvolatile::kErased;
  };
  switch (what) {
    case Status::kImageSlot:
      return static_cast<std::uint32_t>(slot.number());
    case Status::kImageVersion:
      return version_of(slot);
    case Status::kImageOnTrial:
      return trial_ ? 1 : 0;
    case Status::kSpareVersion:
      return version_of(other);
    case Status::kSpareRefusal:
      return static_cast<std::uint32_t>(other.refusal());
    case Status::kUpdateState:
      return static_cast<std::uint32_t>(state_);
    case Status::kUpdateNextWord:
      return next_;
    case Status::kUpdateChecksum:
      return header_.crc();
    case Status::kUpdateVersion:
      return header_.version();
    case Status::kUpdateProblem:
      return static_cast<std::uint32_t>(problem_);
    case Status::kImageHealthy:
      return healthy() ? 1 : 0;
    default:
      return std::nullopt;
  }
}

void UpdateDesk::poll(std::int64_t now_ns, const Health& health) {
  now_ns_ = now_ns;
  health_ = health;
  if (started_ns_ < 0) started_ns_ = now_ns;
  // A foot that moves is not restarted: its trial ends when it is off.
  if (trial_ && !restart_ && health.idle && now_ns - started_ns_ > kTrial_ns) {
    running().refuse(Problem::kNotConfirmed);
    restart_ = true;
    restart_ns_ = now_ns;
  }
  if (restart_ && restart_ns_ < 0) restart_ns_ = now_ns + kBeforeRestart_ns;
  if (!restart_ || now_ns < restart_ns_ || !health.idle) return;
  restart_ = trial_ = false;
  board_->restart();
}

}  // namespace hoof::firmware::app
