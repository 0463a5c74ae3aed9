// A run that is cut off anywhere and gone through again meets the same ground. The ground here is
// an oscillator that remembers all it was told, so that any slip shows in every later number.

#include "sim/terrain/journaled_terrain.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "sim/dem/byte_archive.h"
#include "sim/terrain/random.h"
#include "tests/sim/terrain/temporary_folder.h"

using namespace hoof::sim;
using hoof::sim::test::read_bytes;
using hoof::sim::test::TemporaryFolder;
using hoof::sim::test::write_bytes;
namespace fs = std::filesystem;

namespace {

constexpr char kKey[] = "run 1";
constexpr double kInterval_s = 1e-3;
constexpr int kBodies = 2;

struct Counts {
  int advances = 0;
  int restores = 0;
};

class Oscillator final : public ResumableTerrain {
 public:
  explicit Oscillator(Counts& counts) : counts_(counts) {}
  int add_body(const TriangleMesh&, const Pose&) override { return bodies_++; }
  void advance(double interval_s, std::span<const BodyMotion> motions,
               std::span<Wrench> wrenches) override {
    ++counts_.advances;
    for (std::size_t i = 0; i < motions.size(); ++i) {
      x_ += interval_s * (v_ += std::sin(x_) + motions[i].end.p_WB_m.z());
      wrenches[i].f_W_N = {x_, v_, double(i)};
      wrenches[i].tau_Bo_W_Nm = {v_, x_, -x_};
      work_J_ += x_ * v_;
    }
  }
  double surface_height_m() const override { return 0.25; }
  double work_on_bodies_J() const override { return work_J_; }
  std::string snapshot() const override {
    ByteWriter w;
    w.put(x_), w.put(v_), w.put(work_J_);
    return w.bytes();
  }
  void restore(std::string_view bytes) override {
    ++counts_.restores;
    ByteReader r(bytes);
    r.get(x_), r.get(v_), r.get(work_J_);
  }

 private:
  Counts& counts_;
  int bodies_ = 0;
  double x_ = 1, v_ = 0, work_J_ = 0;
};

/// A run: bodies that move as the ground pushes them, and the trace they leave.
struct Run {
  Counts counts;
  std::vector<std::string> notes;
  std::vector<double> trace;
  std::unique_ptr<JournaledTerrain> ground;
  std::vector<BodyMotion> motions{kBodies};
  std::vector<Wrench> wrenches{kBodies};

  explicit Run(const fs::path& folder, double every_s = 0, const std::string& key = kKey,
               double start_m = 0.1) {
    ground = std::make_unique<JournaledTerrain>(
        std::make_unique<Oscillator>(counts),
        JournalSettings{folder,
                        key,
                        every_s,
                        [this](const std::string& text) { notes.push_back(text); },
                        {},
                        {}});
    for (BodyMotion& motion : motions) {
      motion.end.p_WB_m.z() = start_m;
      ground->add_body({}, motion.end);
    }
  }

  void advance(int intervals) {
    for (int n = 0; n < intervals; ++n) {
      for (int i = 0; i < kBodies; ++i) {
        motions[i].start = motions[i].end;
        motions[i].end.p_WB_m += 1e-3 * wrenches[i].f_W_N + 1e-4 * wrenches[i].tau_Bo_W_Nm;
      }
      ground->advance(kInterval_s, motions, wrenches);
      for (const Wrench& w : wrenches) {
        for (int axis = 0; axis < 3; ++axis) {
          trace.push_back(w.f_W_N[axis]), trace.push_back(w.tau_Bo_W_Nm[axis]);
        }
      }
      trace.push_back(ground->work_on_bodies_J());
    }
  }
};

std::vector<double> undisturbed(int intervals) {
  const TemporaryFolder folder("undisturbed");
  Run run(folder.path());
  run.advance(intervals);
  return run.trace;
}

}  // namespace

TEST_CASE("without checkpoints it is the ground itself and writes nothing") {
  const TemporaryFolder folder("journal");
  Run run(folder.path());
  run.advance(50);
  CHECK(run.counts.advances == 50);
  CHECK(run.ground->surface_height_m() == 0.25);
  CHECK(run.ground->wrench_time() == WrenchTime::kMeanOverInterval);
  CHECK_FALSE(run.ground->replaying());
  CHECK_FALSE(run.ground->can_be_resumed());
  CHECK(folder.count() == 0);
}

TEST_CASE("a run cut off many times ends with the same numbers as the undisturbed one") {
  const int whole = 400;
  const std::vector<double> expected = undisturbed(whole);
  const std::uint64_t seed = 20260401;
  CAPTURE(seed);
  Random random(seed);
  const TemporaryFolder folder("journal");
  int kept = 0;
  for (int kill = 0; kill < 12; ++kill) {
    Run run(folder.path());
    const int to_checkpoint = int(random.between(0, 30)), lost = int(random.between(0, 20));
    run.advance(kept);
    CHECK(run.counts.advances == 0);  // all from the journal
    CHECK(run.counts.restores == (kept > 0 ? 1 : 0));
    CHECK_FALSE(run.ground->replaying());
    run.advance(to_checkpoint);
    run.ground->write_checkpoint();
    run.advance(lost);
    kept += to_checkpoint;
    CHECK(std::equal(run.trace.begin(), run.trace.end(), expected.begin()));
  }
  CHECK(kept > 100);  // or nothing was resumed
  Run last(folder.path());
  last.advance(whole);
  CHECK(last.trace == expected);
  CHECK(last.counts.advances == whole - kept);
  CHECK(last.notes.size() == 2);
  CHECK_THAT(last.notes.at(0),
             Catch::StartsWith("going over what was done, up to the checkpoint at "));
}

TEST_CASE("checkpoints come by the clock, and none while the journal answers") {
  const TemporaryFolder folder("journal");
  {
    Run run(folder.path(), 1e-12);  // each interval
    run.advance(10);
    CHECK(run.ground->can_be_resumed());
    CHECK(fs::exists(folder.path() / "checkpoint-10"));
  }
  Run run(folder.path(), 1e-12);
  run.advance(9);
  CHECK(run.ground->replaying());
  CHECK_FALSE(fs::exists(folder.path() / "checkpoint-11"));
  run.advance(1);
  CHECK_FALSE(run.ground->replaying());
  run.advance(1);
  CHECK(fs::exists(folder.path() / "checkpoint-11"));
  CHECK(run.trace == undisturbed(11));
}

TEST_CASE("what others saw is kept with a checkpoint and given back once, when it goes on") {
  const TemporaryFolder folder("journal");
  const std::string large(100'000, 'x');
  for (const std::string& saw : {std::string(), std::string("\0\1 a look", 9), large}) {
    fs::remove_all(folder.path());
    fs::create_directory(folder.path());
    const auto ground = [&](Counts& counts, std::vector<std::string>& again) {
      JournalSettings settings;
      settings.folder = folder.path();
      settings.key = kKey;
      settings.checkpoint_every_s = 0;
      settings.seen = [&saw] { return saw; };
      settings.see_again = [&again](std::string_view bytes) { again.emplace_back(bytes); };
      return JournaledTerrain(std::make_unique<Oscillator>(counts), settings);
    };
    const std::vector<BodyMotion> motions;
    std::vector<Wrench> wrenches;
    Counts counts;
    std::vector<std::string> again;
    JournaledTerrain first = ground(counts, again);
    for (int i = 0; i < 7; ++i) first.advance(kInterval_s, motions, wrenches);
    first.write_checkpoint();
    CHECK(again.empty());
    JournaledTerrain second = ground(counts, again);
    for (int i = 0; i < 6; ++i) second.advance(kInterval_s, motions, wrenches);
    CHECK(again.empty());
    second.advance(kInterval_s, motions, wrenches);
    CHECK(again == std::vector<std::string>{saw});
    second.advance(kInterval_s, motions, wrenches);
    CHECK(again.size() == 1);
    CHECK(counts.restores == 1);
  }
}

TEST_CASE("a damaged checkpoint is named, and the one before it is used") {
  const TemporaryFolder folder("journal");
  {
    Run run(folder.path());
    run.advance(30);
    run.ground->write_checkpoint();
    run.advance(30);
    run.ground->write_checkpoint();
  }
  const fs::path newest = folder.path() / "checkpoint-2";
  std::string bytes = read_bytes(newest);
  bytes[bytes.size() - 3] ^= 1;
  write_bytes(newest, bytes);
  {
    Run run(folder.path());
    run.advance(100);
    CHECK(run.trace == undisturbed(100));
    CHECK(run.counts.advances == 70);
    REQUIRE(run.notes.size() == 3);
    CHECK(run.notes[0] ==
          newest.string() + " is damaged: its checksum does not match; it is not used");
    CHECK(run.notes[1] == "going over what was done, up to the checkpoint at 30 ms in the ground");
  }
  // Neither can be used: anew.
  write_bytes(folder.path() / "checkpoint-1", "");
  Run run(folder.path());
  run.advance(100);
  CHECK(run.trace == undisturbed(100));
  CHECK(run.counts.advances == 100);
  REQUIRE(run.notes.size() == 3);
  CHECK(run.notes[2] == "no checkpoint can be used; the run begins anew");
}

TEST_CASE("a journal torn anywhere ends there, and a checkpoint beyond its end is not used") {
  const TemporaryFolder folder("journal");
  {
    Run run(folder.path());
    run.advance(3);
    run.ground->write_checkpoint();
    run.advance(3);
    run.ground->write_checkpoint();
  }
  const fs::path journal = folder.path() / "journal";
  const std::string whole = read_bytes(journal);
  // The header is 15 letters and two numbers; a record two numbers, twelve of each body's wrench
  // pair and its checksum.
  constexpr std::size_t kHeader = 15 + 2 * 8, kRecord = 8 * (2 + 6 * kBodies + 1);
  REQUIRE(whole.size() == kHeader + 6 * kRecord);
  const std::string first = read_bytes(folder.path() / "checkpoint-1"),
                    second = read_bytes(folder.path() / "checkpoint-2");
  const auto put_back = [&](const std::string& torn) {
    write_bytes(journal, torn);
    write_bytes(folder.path() / "checkpoint-1", first);
    write_bytes(folder.path() / "checkpoint-2", second);
  };
  const auto expected = undisturbed(9);
  const auto check = [&](std::size_t good_records, bool write) {
    Run run(folder.path());
    run.advance(9);
    const int from = good_records >= 6 ? 6 : good_records >= 3 ? 3 : 0;
    CHECK(run.counts.advances == 9 - from);
    CHECK(run.trace == expected);
    if (!write) return;
    run.ground->write_checkpoint();  // over what was torn
    CHECK(read_bytes(journal).size() == kHeader + 9 * kRecord);
    CHECK(read_bytes(journal).substr(0, whole.size()) == whole);
  };
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    CAPTURE(size);
    put_back(whole.substr(0, size));
    check(size < kHeader ? 0 : (size - kHeader) / kRecord, size % 50 == 0);
  }
  // A flipped bit ends it as well.
  for (std::size_t at = kHeader; at < whole.size(); at += 7) {
    CAPTURE(at);
    std::string damaged = whole;
    damaged[at] ^= 0x10;
    put_back(damaged);
    check((at - kHeader) / kRecord, at % 10 == 0);
  }
}

TEST_CASE("records after the last checkpoint are of no use and are written anew") {
  const TemporaryFolder folder("journal");
  {
    Run run(folder.path());
    run.advance(5);
    run.ground->write_checkpoint();
    run.advance(5);
    run.ground->write_checkpoint();
  }
  fs::remove(folder.path() / "checkpoint-2");  // killed after the journal, before the checkpoint
  Run run(folder.path());
  run.advance(20);
  CHECK(run.counts.advances == 15);
  run.ground->write_checkpoint();
  CHECK(run.trace == undisturbed(20));
  Run again(folder.path());
  again.advance(20);
  CHECK(again.counts.advances == 0);
  CHECK(again.trace == undisturbed(20));
}

TEST_CASE("another run is told from this one") {
  const TemporaryFolder folder("journal");
  {
    Run run(folder.path());
    run.advance(10);
    run.ground->write_checkpoint();
  }
  Run other_key(folder.path(), 0, "run 2");
  CHECK_THROWS_WITH(other_key.advance(1),
                    (folder.path() / "journal").string() + " is of a run with other settings");
  Run other_start(folder.path(), 0, kKey, 0.1000001);
  CHECK_THROWS_WITH(other_start.advance(1),
                    Catch::Contains("the bodies move otherwise than in the run that wrote"));
  Run other_way(folder.path());
  other_way.advance(4);
  other_way.motions[1].end.p_WB_m.x() += 1e-15;
  CHECK_THROWS_WITH(other_way.advance(1), Catch::StartsWith("after 4 ms in the ground the bodies"));
  write_bytes(folder.path() / "journal", std::string(1000, 'x'));
  Run no_journal(folder.path());
  CHECK_THROWS_WITH(no_journal.advance(1), Catch::EndsWith(" is not a journal"));
}

TEST_CASE("a checkpoint that cannot be written is told and the run goes on") {
  const TemporaryFolder folder("journal");
  Run run(folder.path() / "gone", 1e-12);
  run.advance(2);
  CHECK(run.trace == undisturbed(2));
  REQUIRE(run.notes.size() == 2);
  CHECK_THAT(run.notes[0], Catch::Contains("No such file or directory") &&
                               Catch::EndsWith("; the run goes on without this checkpoint"));
  CHECK_FALSE(run.ground->can_be_resumed());
  CHECK_THROWS_AS(run.ground->write_checkpoint(), std::runtime_error);
  // Once there is room, all that was missed is written.
  fs::create_directory(folder.path() / "gone");
  run.ground->write_checkpoint();
  Run resumed(folder.path() / "gone");
  resumed.advance(3);
  CHECK(resumed.counts.advances == 1);
  CHECK(resumed.trace == undisturbed(3));
}

TEST_CASE("a time between checkpoints that cannot be is refused") {
  const TemporaryFolder folder("journal");
  CHECK_THROWS_AS(Run(folder.path(), -1.0), std::invalid_argument);
  CHECK_THROWS_AS(Run(folder.path(), NAN), std::invalid_argument);
}
