#include "sim/terrain/checkpoint_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include "sim/terrain/disk_file.h"

namespace hoof::sim {
namespace fs = std::filesystem;
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::string_view kName = "checkpoint-";
constexpr std::string_view kTemporary = ".part";
constexpr std::array<char, 16> kMagic = {'h', 'o', 'o', 'f', ' ', 'c', 'h', 'e',
                                         'c', 'k', 'p', 'o', 'i', 'n', 't', '\n'};
constexpr std::uint64_t kVersion = 1;

/// In front of key and payload, as it lies in the file.
struct Header {
  std::array<char, 16> magic = kMagic;
  std::uint64_t version = kVersion;
  std::uint64_t step = 0;
  double time_s = 0;
  std::uint64_t key_bytes = 0;
  std::uint64_t payload_bytes = 0;
  std::uint64_t body_checksum = 0;  // of key, then payload
  std::uint64_t checksum = 0;       // of the header so far

  std::uint64_t right_checksum() const {
    return checksum64({reinterpret_cast<const char*>(this), offsetof(Header, checksum)});
  }
};
static_assert(sizeof(Header) == 72);  // no gaps in the file

std::uint64_t body_checksum(std::string_view key, std::string_view payload) {
  return checksum64(payload, checksum64(key));
}

/// @return the checkpoint, or why it is none, in `reason`
std::optional<Checkpoint> read_checkpoint(const fs::path& path, const std::string& key,
                                          std::uint64_t up_to_step, std::string& reason) {
  const auto refuse = [&reason](const char* why) {
    reason = why;
    return std::nullopt;
  };
  DiskFile file(path, DiskFile::Mode::kRead);
  Header header;
  const std::size_t got = file.read(&header, sizeof header);
  const std::size_t magic = std::min(got, kMagic.size());
  if (!std::equal(kMagic.begin(), kMagic.begin() + magic, header.magic.begin())) {
    return refuse("is not a checkpoint");
  }
  if (got < sizeof header) return refuse("is truncated");
  if (header.checksum != header.right_checksum()) {
    return refuse("is damaged: its checksum does not match");
  }
  if (header.version != kVersion) return refuse("is of another version");
  const std::uint64_t size = sizeof header + header.key_bytes + header.payload_bytes;
  const std::uint64_t there = fs::file_size(path);
  if (there < size) return refuse("is truncated");
  if (there > size) return refuse("is damaged: it is longer than it should be");
  std::string found_key(header.key_bytes, '\0');
  Checkpoint checkpoint{header.step, header.time_s, std::string(header.payload_bytes, '\0')};
  if (file.read(found_key.data(), found_key.size()) != found_key.size() ||
      file.read(checkpoint.payload.data(), header.payload_bytes) != header.payload_bytes) {
    return refuse("is truncated");
  }
  if (header.body_checksum != body_checksum(found_key, checkpoint.payload)) {
    return refuse("is damaged: its checksum does not match");
  }
  if (found_key != key) return refuse("was made from other settings");
  if (header.step > up_to_step) return refuse("is further on than the journal beside it");
  return checkpoint;
}

/// All files of ours, half-written ones included.
std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().filename().string().starts_with(kName)) files.push_back(entry.path());
  }
  return files;
}

/// Of whole files, newest first.
std::vector<std::uint64_t> numbers_in(const fs::path& folder) {
  std::vector<std::uint64_t> numbers;
  for (const fs::path& file : files_in(folder)) {
    const std::string digits = file.filename().string().substr(kName.size());
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (error == std::errc() && end == digits.data() + digits.size()) numbers.push_back(number);
  }
  std::sort(numbers.rbegin(), numbers.rend());
  return numbers;
}

}  // namespace

std::uint64_t checksum64(std::string_view bytes, std::uint64_t seed) {
  // Odd, half of the bits set: the fractional parts of the golden ratio and of the square root
  // of 2.
  constexpr std::uint64_t kFactor = 0x9e3779b97f4a7c15u, kOther = 0x6a09e667f3bcc909u;
  std::array<std::uint64_t, 4> lane{};
  for (std::size_t k = 0; k < lane.size(); ++k) lane[k] = seed + (k + 1) * kOther;
  constexpr std::size_t kWord = sizeof(std::uint64_t), kBlock = lane.size() * kWord;
  const auto take = [](std::uint64_t h, const char* from, std::size_t size) {
    std::uint64_t word = 0;
    std::memcpy(&word, from, size);
    h ^= word;
    // A product carries upward only: without the upper half in the lower one, a flipped top bit
    // would stay alone and could be flipped back by the next word of the lane.
    return std::rotl((h ^ (h >> 32)) * kFactor, 29);
  };
  std::size_t at = 0;
  for (; at + kBlock <= bytes.size(); at += kBlock) {
    for (std::size_t k = 0; k < lane.size(); ++k) {
      lane[k] = take(lane[k], bytes.data() + at + k * kWord, kWord);
    }
  }
  for (std::size_t k = 0; at < bytes.size(); ++k) {
    const std::size_t size = std::min(kWord, bytes.size() - at);
    lane[k] = take(lane[k], bytes.data() + at, size);
    at += size;
  }
  // The length tells zeros at the end from none; each step is one-to-one in what it takes in.
  std::uint64_t hash = bytes.size();
  for (const std::uint64_t h : lane) {
    hash = (hash ^ h) * kFactor;
    hash ^= hash >> 32;
  }
  return hash;
}

CheckpointFiles::CheckpointFiles(fs::path folder, std::string key)
    : folder_(std::move(folder)), key_(std::move(key)) {}

fs::path CheckpointFiles::path_of(std::uint64_t number) const {
  return folder_ / (std::string(kName) + std::to_string(number));
}

void CheckpointFiles::write(std::uint64_t step, double time_s, std::string_view payload) {
  fs::create_directories(folder_);
  const std::vector<std::uint64_t> numbers = numbers_in(folder_);
  const std::uint64_t number = numbers.empty() ? 1 : numbers.front() + 1;
  const fs::path path = path_of(number), temporary = path.string() + std::string(kTemporary);
  Header header;
  header.step = step, header.time_s = time_s;
  header.key_bytes = key_.size(), header.payload_bytes = payload.size();
  header.body_checksum = body_checksum(key_, payload);
  header.checksum = header.right_checksum();
  try {
    {
      DiskFile file(temporary, DiskFile::Mode::kCreate);
      file.write({reinterpret_cast<const char*>(&header), sizeof header});
      file.write(key_);
      file.write(payload);
      file.sync();
    }
    fs::rename(temporary, path);
    sync_folder(folder_);
  } catch (const std::system_error& error) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw std::runtime_error("cannot write " + path.string() + ": " + error.code().message());
  }
  for (const fs::path& file : files_in(folder_)) {
    std::error_code ignored;
    if (file != path && !(good_ && file == path_of(*good_))) fs::remove(file, ignored);
  }
  good_ = number;
}

CheckpointSearch CheckpointFiles::read_newest(std::uint64_t up_to_step) {
  CheckpointSearch search;
  for (const std::uint64_t number : numbers_in(folder_)) {
    std::string reason;
    try {
      search.found = read_checkpoint(path_of(number), key_, up_to_step, reason);
    } catch (const std::system_error& error) {
      reason = "cannot be read: " + error.code().message();
    }
    if (search.found) {
      good_ = number;
      break;
    }
    search.refused.push_back(path_of(number).string() + " " + reason);
  }
  return search;
}

bool CheckpointFiles::any_in(const fs::path& folder) {
  return !numbers_in(folder).empty();
}

void CheckpointFiles::remove() {
  std::error_code ignored;
  for (const fs::path& file : files_in(folder_)) fs::remove(file, ignored);
  fs::remove(folder_, ignored);  // refuses where something else is in it
  good_.reset();
}

}  // namespace hoof::sim
