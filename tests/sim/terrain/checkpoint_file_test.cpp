// A checkpoint is whole or refused, and the one before it is still there.

#include "sim/terrain/checkpoint_file.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>
#include <stdexcept>

#include "sim/terrain/random.h"
#include "tests/sim/terrain/temporary_folder.h"

using namespace hoof::sim;
using hoof::sim::test::read_bytes;
using hoof::sim::test::TemporaryFolder;
using hoof::sim::test::write_bytes;
namespace fs = std::filesystem;

namespace {

constexpr char kKey[] = "settings 1";

/// Bytes that hold no pattern.
std::string noise(std::size_t size, std::uint64_t seed) {
  Random random(seed);
  std::string bytes(size, '\0');
  for (char& c : bytes) c = char(random.next());
  return bytes;
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// Two checkpoints, of steps 10 and 20, the newest of which is then harmed.
struct Two {
  TemporaryFolder folder{"checkpoints"};
  std::string older = noise(40, 1), newer = noise(41, 2);
  fs::path newest = folder.path() / "checkpoint-2";
  std::string whole;

  Two() {
    CheckpointFiles files(folder.path(), kKey);
    files.write(10, 0.01, older);
    files.write(20, 0.02, newer);
    whole = read_bytes(newest);
  }

  CheckpointSearch search(const std::string& key = kKey) const {
    return CheckpointFiles(folder.path(), key).read_newest();
  }

  /// The newest is refused, for this reason, and the one before it is given.
  void check_refused(const std::string& reason) const {
    const CheckpointSearch found = search();
    REQUIRE(found.refused.size() == 1);
    CHECK(found.refused[0] == newest.string() + " " + reason);
    REQUIRE(found.found);
    CHECK(found.found->step == 10);
    CHECK(found.found->payload == older);
  }
};

}  // namespace

TEST_CASE("the checksum sees every bit, the order and the length") {
  const std::string bytes = noise(75, 3);  // two blocks of 32 bytes, a word and a part of one
  std::set<std::uint64_t> seen = {checksum64(bytes)};
  for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
    std::string flipped = bytes;
    flipped[bit / 8] = char(flipped[bit / 8] ^ (1 << (bit % 8)));
    CAPTURE(bit);
    // Nor are two of them alike: then both together would go unseen.
    CHECK(seen.insert(checksum64(flipped)).second);
  }
  std::string swapped = bytes;
  std::swap_ranges(swapped.begin(), swapped.begin() + 8, swapped.begin() + 8);
  CHECK(seen.insert(checksum64(swapped)).second);
  // Zeros at the end, across the end of the word and of the block.
  std::string longer = bytes;
  for (int zeros = 1; zeros < 70; ++zeros) {
    longer += '\0';
    CAPTURE(zeros);
    CHECK(seen.insert(checksum64(longer)).second);
  }
  CHECK(seen.insert(checksum64(bytes, 1)).second);
  // Fixed, because files are kept from one build to the next.
  CHECK(checksum64("") == 0xe9d3e0a11e31b15au);
  CHECK(checksum64("hoof") == 0x638ac60fcd4356d0u);
}

TEST_CASE("a checkpoint comes back as it was") {
  const TemporaryFolder folder("checkpoints");
  for (const std::size_t size : {0, 1, 31, 32, 33, 100'000}) {
    const std::string payload = noise(size, size);
    CheckpointFiles(folder.path() / "made", kKey).write(size, 1e-3 * double(size), payload);
    const CheckpointSearch search = CheckpointFiles(folder.path() / "made", kKey).read_newest();
    CHECK(search.refused.empty());
    REQUIRE(search.found);
    CHECK(search.found->step == size);
    CHECK(search.found->time_s == 1e-3 * double(size));
    CHECK(search.found->payload == payload);
  }
}

TEST_CASE("no checkpoint is no error") {
  const TemporaryFolder folder("checkpoints");
  const CheckpointSearch search = CheckpointFiles(folder.path() / "none", kKey).read_newest();
  CHECK_FALSE(search.found);
  CHECK(search.refused.empty());
}

TEST_CASE("the last two are kept, and what a killed writer left is removed") {
  const TemporaryFolder folder("checkpoints");
  CheckpointFiles files(folder.path(), kKey);
  write_bytes(folder.path() / "checkpoint-1.part", "half");
  write_bytes(folder.path() / "journal", "not ours");
  for (std::uint64_t step = 1; step <= 4; ++step) files.write(step, 0, "x");
  CHECK(names_in(folder.path()) ==
        std::vector<std::string>{"checkpoint-3", "checkpoint-4", "journal"});
  files.remove();
  CHECK(names_in(folder.path()) == std::vector<std::string>{"journal"});
}

TEST_CASE("truncated at any byte, the newest is refused and the one before is used") {
  const Two two;
  for (std::size_t size = 0; size < two.whole.size(); ++size) {
    CAPTURE(size);
    write_bytes(two.newest, two.whole.substr(0, size));
    two.check_refused("is truncated");
  }
  write_bytes(two.newest, two.whole + "x");
  two.check_refused("is damaged: it is longer than it should be");
}

TEST_CASE("a flipped bit in any byte is noticed, and the one before is used") {
  const Two two;
  for (std::size_t byte = 0; byte < two.whole.size(); ++byte) {
    CAPTURE(byte);
    std::string damaged = two.whole;
    damaged[byte] = char(damaged[byte] ^ (1 << (byte * 5 % 8)));
    write_bytes(two.newest, damaged);
    two.check_refused(byte < 16 ? "is not a checkpoint"
                                : "is damaged: its checksum does not match");
  }
}

TEST_CASE("a checkpoint of other settings, or of steps not asked for, is refused") {
  const Two two;
  const CheckpointSearch other = two.search("settings 2");
  CHECK_FALSE(other.found);
  REQUIRE(other.refused.size() == 2);
  CHECK(other.refused[0] == two.newest.string() + " was made from other settings");

  const CheckpointSearch early = CheckpointFiles(two.folder.path(), kKey).read_newest(19);
  REQUIRE(early.found);
  CHECK(early.found->step == 10);
  CHECK(early.refused.size() == 1);
  CHECK_FALSE(CheckpointFiles(two.folder.path(), kKey).read_newest(9).found);
  CHECK(CheckpointFiles(two.folder.path(), kKey).read_newest(20).found->step == 20);
}

TEST_CASE("after a damaged checkpoint the next one does not push out the good one") {
  const Two two;
  write_bytes(two.newest, two.whole.substr(0, two.whole.size() - 1));
  CheckpointFiles files(two.folder.path(), kKey);
  REQUIRE(files.read_newest().found);
  files.write(15, 0.015, "next");
  CHECK(names_in(two.folder.path()) == std::vector<std::string>{"checkpoint-1", "checkpoint-3"});
}

TEST_CASE("a checkpoint that cannot be written names file and cause, and harms none") {
  const Two two;
  // A folder in the way of the temporary file: refused to root, too.
  fs::create_directory(two.folder.path() / "checkpoint-3.part");
  write_bytes(two.folder.path() / "checkpoint-3.part" / "x", "");
  CheckpointFiles files(two.folder.path(), kKey);
  CHECK_THROWS_WITH(
      files.write(30, 0.03, "third"),
      "cannot write " + (two.folder.path() / "checkpoint-3").string() + ": Is a directory");
  CHECK(files.read_newest().found->step == 20);
}
