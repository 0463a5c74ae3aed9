#include "hil_bridge/update_client.h"

#include <algorithm>

namespace hoof::bridge {

using firmware::protocol::ServiceResult;
using firmware::update::ImageHeader;
using firmware::update::Problem;

namespace {

constexpr std::int64_t kRepeat_ns = 50'000'000;
constexpr std::int64_t kRepeatErase_ns = 3'000'000'000;  // it takes up to two seconds
constexpr std::int64_t kAskAgain_ns = 100'000'000;
constexpr std::uint32_t kReceiving = 3, kComplete = 4;  // UpdateDesk's states

bool in_doubt(ServiceResult result) {
  return result == ServiceResult::kBadCounter || result == ServiceResult::kNotConnected;
}

std::uint32_t word_of(const UpdateImage& image, std::size_t i) {
  return i < ImageHeader::kWords ? image.header.word[i] : image.words[i - ImageHeader::kWords];
}

std::size_t words_of(const UpdateImage& image) {
  return ImageHeader::kWords + image.words.size();
}

}  // namespace

std::string text_of(Problem problem) {
  switch (problem) {
    case Problem::kNone:
      return "no problem";
    case Problem::kNoImage:
      return "it is no image";
    case Problem::kOtherBoard:
      return "it is for another board";
    case Problem::kOtherSlot:
      return "it is linked for the other slot";
    case Problem::kLength:
      return "its length is not possible";
    case Problem::kNotNewer:
      return "its version is not above the running one's";
    case Problem::kChecksum:
      return "its checksum is not that of what came";
    case Problem::kSignature:
      return "its signature is not one of the board's key";
    case Problem::kNotConfirmed:
      return "it was not confirmed on its trial";
    case Problem::kFlash:
      return "the flash did not take it";
    case Problem::kUnknown:
      break;
  }
  return "for a reason that a power cut has wiped out";
}

std::optional<ImageStatus> UpdateClient::read_status() {
  const std::optional<std::uint32_t> slot = client_.stored_status(Status::kImageSlot);
  if (!slot) return std::nullopt;
  ImageStatus status;
  status.slot = *slot;
  status.version = client_.status(Status::kImageVersion);
  status.on_trial = client_.status(Status::kImageOnTrial) != 0;
  status.healthy = client_.status(Status::kImageHealthy) != 0;
  const std::uint32_t spare = client_.status(Status::kSpareVersion);
  if (spare != hal::Nonvolatile::kErased) status.spare_version = spare;
  status.spare_refusal = static_cast<Problem>(client_.status(Status::kSpareRefusal));
  return status;
}

const UpdateImage& UpdateClient::choose(const UpdateFile& file, const ImageStatus& status) const {
  const std::size_t spare = 1 - status.slot;
  const UpdateImage* image = file.for_slot(spare);
  if (image == nullptr) {
    throw ServiceError(std::string("the file has no image for slot ") + "AB"[spare] +
                       ", the one that does not run");
  }
  if (image->header.version() <= status.version) {
    throw ServiceError("the foot runs version " + std::to_string(status.version) +
                       ", the file is version " + std::to_string(image->header.version()) +
                       "; sign it as a higher one: hoof firmware build --version " +
                       std::to_string(status.version + 1) + ", or hoof firmware sign");
  }
  if (status.on_trial) {
    throw ServiceError("the foot runs version " + std::to_string(status.version) +
                       " on trial; confirm it first (hoof firmware update --confirm), or wait a "
                       "minute until it goes back");
  }
  return *image;
}

void UpdateClient::send(const UpdateImage& image, const Progress& progress) {
  if (!goes_on(image)) begin(image);
  send_words(image, progress);
  finish();
}

/// Whether the foot is already in the middle of this very image.
bool UpdateClient::goes_on(const UpdateImage& image) {
  const std::uint32_t state = client_.status(Status::kUpdateState);
  return (state == kReceiving || state == kComplete) &&
         client_.status(Status::kUpdateChecksum) == image.header.crc() &&
         client_.status(Status::kUpdateVersion) == image.header.version();
}

/// The header from its first word, again where one of its words is in doubt, then the erase.
void UpdateClient::begin(const UpdateImage& image) {
  for (;;) {
    Result result = client_.write_update(Object::kOpen, 0, kRepeat_ns);
    for (std::size_t i = 0; i < ImageHeader::kWords && result == Result::kDone; ++i) {
      result = client_.write_update(Object::kWord, image.header.word[i], kRepeat_ns);
    }
    if (result == Result::kDone) break;
    if (!in_doubt(result)) refused("this image", result);
  }
  for (;;) {
    const Result result = client_.write_update(Object::kErase, 0, kRepeatErase_ns);
    if (result == Result::kDone) return;
    if (!in_doubt(result)) refused("to erase a slot", result);
  }
}

void UpdateClient::send_words(const UpdateImage& image, const Progress& progress) {
  const std::size_t all = words_of(image);
  std::size_t next = client_.status(Status::kUpdateNextWord);
  std::int64_t due_ns = client_.now_ns();
  while (next < all) {
    client_.wait_until(due_ns);
    due_ns = std::max(due_ns + settings_.word_period_ns, client_.now_ns());
    const Result result = client_.write_update(Object::kWord, word_of(image, next), kRepeat_ns);
    if (result == Result::kDone) {
      ++next;
    } else if (in_doubt(result)) {
      next = client_.status(Status::kUpdateNextWord);
      // A foot that started anew expects its first word.
      if (!goes_on(image)) throw ServiceError("the foot was reset; its former image runs: again");
    } else {
      refused("word " + std::to_string(next) + " of " + std::to_string(all), result);
    }
    if (progress) progress(next, all);
  }
}

void UpdateClient::finish() {
  for (;;) {
    const Result result = client_.write_update(Object::kFinish, 0, kRepeat_ns);
    if (result == Result::kDone) return;
    if (!in_doubt(result)) refused("the image as a whole", result);
  }
}

void UpdateClient::refused(const std::string& what, Result result) {
  const auto name_of = [result] {
    for (const auto& n : firmware::protocol::kServiceResultNames) {
      if (n.value == static_cast<std::uint32_t>(result)) return std::string(n.name);
    }
    return std::to_string(static_cast<int>(result));
  };
  std::string why = name_of();
  std::string help;
  switch (result) {
    case Result::kOutOfRange:
    case Result::kFlashFailed:
      why = text_of(static_cast<Problem>(client_.status(Status::kUpdateProblem)));
      break;
    case Result::kWrongMode:
      help = "; an update needs mode off: hoof order stop, then hoof order reset where a fault is";
      break;
    case Result::kNotOwner:
      help = "; another supervisor owns the foot, and has to release it";
      break;
    case Result::kBusy:
      help = "; its image runs on trial";
      break;
    default:
      break;
  }
  throw ServiceError("the foot refused " + what + ": " + why + help + ". Its image is as it was");
}

void UpdateClient::start_and_confirm(const UpdateImage& image) {
  for (;;) {
    const Result result = client_.write_update(Object::kRestart, 0, kRepeat_ns);
    if (result == Result::kDone) break;
    if (!in_doubt(result)) refused("to restart", result);
    // The answer may have been lost and the foot may be on its way.
    if (client_.status(Status::kUpdateState) != kComplete) break;
  }
  client_.wait_until(client_.now_ns() + kAskAgain_ns);
  const ImageStatus status = wait_for_start();
  if (status.slot != image.header.slot() || status.version != image.header.version()) {
    throw ServiceError("the foot went back to version " + std::to_string(status.version) +
                       "; it refused version " + std::to_string(image.header.version()) + ": " +
                       text_of(status.spare_refusal));
  }
  confirm(image.header.version());
}

/// Verification and start take less than a second; nobody answers then.
ImageStatus UpdateClient::wait_for_start() {
  const std::int64_t give_up_ns = client_.now_ns() + settings_.start_ns;
  for (;;) {
    try {
      client_.greet();
      if (const auto status = read_status()) return *status;
      throw ServiceError("the foot that started cannot be updated");
    } catch (const ServiceError&) {
      if (client_.now_ns() >= give_up_ns) throw;
    }
  }
}

void UpdateClient::confirm(std::uint32_t version) {
  const std::int64_t give_up_ns = client_.now_ns() + settings_.healthy_ns;
  for (;;) {
    const Result result = client_.write_update(Object::kConfirm, version, kRepeat_ns);
    if (result == Result::kDone) return;
    const bool wait = result == Result::kBusy || result == Result::kWrongMode || in_doubt(result);
    if (!wait || client_.now_ns() >= give_up_ns) {
      throw ServiceError("version " + std::to_string(version) +
                         " runs and does not report healthy: a fault, an overrun, or fewer than "
                         "1000 ticks of SYNC (hoof faults, hoof monitor); in a minute the foot "
                         "goes back to its former version");
    }
    client_.wait_until(client_.now_ns() + kAskAgain_ns);
  }
}

}  // namespace hoof::bridge
