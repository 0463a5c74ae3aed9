// Checkpoints of long work, numbered files in a folder of their own: each is whole or refused.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hoof::sim {

/// 64 bits over many bytes at memory speed; against damage, not against forgery. Four lanes take
/// eight bytes each in turn: h ^= word, h ^= h >> 32, h = rotate(h * odd constant), which is
/// one-to-one in h and in the word, so that damage within one word never goes unseen.
/// Little-endian.
std::uint64_t checksum64(std::string_view bytes, std::uint64_t seed = 0);

/// What is kept of the work at one moment.
struct Checkpoint {
  std::uint64_t step = 0;  // how far the work was, in the caller's own count
  double time_s = 0;       // simulated
  std::string payload;
};

/// The newest good checkpoint, and why those after it were refused.
struct CheckpointSearch {
  std::optional<Checkpoint> found;
  /// One line a file: its path, then "is truncated", "is damaged: its checksum does not match",
  /// "was made from other settings", "is not a checkpoint", "is of another version".
  std::vector<std::string> refused;
};

/// The checkpoints of one piece of work. One process at a time writes to a folder.
class CheckpointFiles {
 public:
  /// @param folder made with the first write  @param key identity of the work: its settings
  CheckpointFiles(std::filesystem::path folder, std::string key);

  /// Writes to a temporary file, has it on the disk (fsync), then renames it. Keeps beside it the
  /// one that this object wrote or found before, and removes all others: there are two from the
  /// second write on.
  /// @throws std::runtime_error naming the file and the cause; the files of before are still there
  void write(std::uint64_t step, double time_s, std::string_view payload);

  /// Tries the newest, then the one before, and so on. Never throws for a bad file.
  /// @param up_to_step those of later steps are refused, too
  CheckpointSearch read_newest(
      std::uint64_t up_to_step = std::numeric_limits<std::uint64_t>::max());

  /// Whether a folder holds checkpoints, good or bad, of whatever work.
  static bool any_in(const std::filesystem::path& folder);

  /// Removes all checkpoints, and the folder where nothing else is in it.
  void remove();

 private:
  std::filesystem::path path_of(std::uint64_t number) const;

  std::filesystem::path folder_;
  std::string key_;
  std::optional<std::uint64_t> good_;  // number of the one last written or found
};

}  // namespace hoof::sim
