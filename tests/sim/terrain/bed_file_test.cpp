#include "sim/terrain/bed_file.h"

#include <sys/resource.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <cstring>
#include <limits>
#include <random>

#include "tests/sim/terrain/small_bed.h"
#include "tests/sim/terrain/temporary_folder.h"

using namespace hoof::sim;
using namespace hoof::sim::test;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

constexpr char kKey[] = "recipe=1 seed=1";

/// Numbers of every kind: tiny, negative, minus zero, without a short decimal.
BedState some_state() {
  BedState state;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&] {
    const double x = unit(random), y = unit(random), z = unit(random);
    return Eigen::Vector3d(x, y, z);
  };
  for (std::uint32_t i = 0; i < 20; ++i) {
    state.grains.push_back({i, 1e-3 + 1e-4 * i, vector(), vector(), vector()});
  }
  state.grains[3].v_m_s = {-0.0, std::numeric_limits<double>::denorm_min(), -1e300};
  for (std::uint32_t i = 0; i + 1 < 20; ++i) state.contacts.push_back({i, i + 1, vector()});
  state.contacts.push_back({19, GrainContact::kWallContact + 4, vector()});
  return state;
}

bool same_bits(const BedState& a, const BedState& b) {
  const std::vector<double> x = numbers(a), y = numbers(b);
  return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof x[0]) == 0;
}

/// No file of this process can grow beyond some bytes: writing fails halfway, as on a full disk.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) : on_excess_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~SmallDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, on_excess_);
  }

 private:
  rlimit before_{};
  void (*on_excess_)(int);
};

}  // namespace

TEST_CASE("FNV-1a gives its published values") {
  CHECK(fnv1a("", 0) == 0xcbf29ce484222325u);
  CHECK(fnv1a("a", 1) == 0xaf63dc4c8601ec8cu);
  CHECK(fnv1a("foobar", 6) == 0x85944171f73967e8u);
  CHECK(fnv1a("bar", 3, fnv1a("foo", 3)) == fnv1a("foobar", 6));
}

TEST_CASE("a bed comes back from its file bit by bit") {
  const TemporaryFolder folder("bed-file");
  const fs::path file = folder.path() / "new" / "some.bed";
  write_bed_file(file, kKey, some_state());
  CHECK(same_bits(read_bed_file(file, kKey), some_state()));
  // A second writing replaces it; nothing else stays in the folder.
  BedState other = some_state();
  other.grains[0].p_m.x() = 7;
  write_bed_file(file, kKey, other);
  CHECK(same_bits(read_bed_file(file, kKey), other));
  CHECK(std::distance(fs::directory_iterator(file.parent_path()), {}) == 1);
}

TEST_CASE("the file of the same bed has the same bytes") {
  const TemporaryFolder folder("bed-bytes");
  write_bed_file(folder.path() / "a.bed", kKey, some_state());
  write_bed_file(folder.path() / "b.bed", kKey, some_state());
  CHECK(read_bytes(folder.path() / "a.bed") == read_bytes(folder.path() / "b.bed"));
}

TEST_CASE("a truncated bed file is refused by name, wherever it ends") {
  const TemporaryFolder folder("bed-truncated");
  const fs::path file = folder.path() / "some.bed";
  write_bed_file(file, kKey, some_state());
  const std::string whole = read_bytes(file);
  for (std::size_t part = 0; part < 16; ++part) {
    const std::size_t size = whole.size() * part / 16;
    INFO(size << " of " << whole.size() << " bytes");
    write_bytes(file, whole.substr(0, size));
    CHECK_THROWS_WITH(
        read_bed_file(file, kKey),
        Contains(file.string()) && (Contains("truncated") || Contains("is not a bed file")));
  }
  write_bytes(file, whole.substr(0, whole.size() - 1));
  CHECK_THROWS_WITH(read_bed_file(file, kKey), Contains(file.string()) && Contains("truncated"));
  write_bytes(file, whole + "x");
  CHECK_THROWS_WITH(read_bed_file(file, kKey), Contains(file.string()));
}

TEST_CASE("one flipped bit is found") {
  const TemporaryFolder folder("bed-flipped");
  const fs::path file = folder.path() / "some.bed";
  write_bed_file(file, kKey, some_state());
  const std::string whole = read_bytes(file);
  const unsigned seed = std::random_device{}();
  std::mt19937 random(seed);
  for (int i = 0; i < 200; ++i) {
    const std::size_t byte = random() % whole.size();
    const int bit = int(random() % 8);
    INFO("seed " << seed << ": bit " << bit << " of byte " << byte);
    std::string damaged = whole;
    damaged[byte] = char(damaged[byte] ^ (1 << bit));
    write_bytes(file, damaged);
    CHECK_THROWS_WITH(read_bed_file(file, kKey), Contains(file.string()));
  }
}

TEST_CASE("what is no bed, or another bed, is refused by name") {
  const TemporaryFolder folder("bed-other");
  const fs::path file = folder.path() / "some.bed";
  CHECK_THROWS_WITH(read_bed_file(file, kKey),
                    "cannot read " + file.string() + ": No such file or directory");
  write_bytes(file, "name = \"demo\"\nbox_length_mm = 530\n");
  CHECK_THROWS_WITH(read_bed_file(file, kKey), file.string() + " is not a bed file");
  CHECK_THROWS_WITH(read_bed_file(folder.path(), kKey),
                    folder.path().string() + " is not a bed file");
  write_bed_file(file, kKey, some_state());
  for (const std::string key : {"recipe=1 seed=2", "recipe=1 seed=", "recipe=1 seed=11", ""}) {
    CHECK_THROWS_WITH(read_bed_file(file, key), file.string() + " was made from other settings");
  }
}

TEST_CASE("a place that cannot be written is named, and nothing is left there") {
  const TemporaryFolder folder("bed-unwritable");
  const auto cannot_write = [](const fs::path& file) {
    CHECK_THROWS_WITH(write_bed_file(file, kKey, some_state()),
                      Catch::StartsWith("cannot write " + file.string() + ": "));
  };
  // A file where a folder should be, a folder where the file should be.
  write_bytes(folder.path() / "file", "x");
  cannot_write(folder.path() / "file" / "some.bed");
  fs::create_directories(folder.path() / "taken.bed" / "full");
  cannot_write(folder.path() / "taken.bed");
  CHECK(folder.count() == 2);
  {
    const SmallDisk no_room(1000);
    cannot_write(folder.path() / "large.bed");
  }
  CHECK(folder.count() == 2);
  if (geteuid() != 0) {  // permissions do not bind root
    const fs::path closed = folder.path() / "closed";
    fs::create_directories(closed);
    fs::permissions(closed, fs::perms::owner_read | fs::perms::owner_exec);
    cannot_write(closed / "some.bed");
    CHECK(fs::is_empty(closed));
    fs::permissions(closed, fs::perms::owner_all);
  }
}
