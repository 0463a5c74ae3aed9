// A bed put back from its snapshot goes on to the same bytes.
#include <catch2/catch.hpp>

#include "tests/sim/dem/falling_heap.h"

using namespace hoof::sim;
using namespace hoof::sim::test;

namespace {

SandBed bed_with_box(const DemSettings& s) {
  SandBed bed(s, heap(9));
  bed.add_mesh(box_mesh({8e-3, 6e-3, 5e-3}), {0, 0, 0.06}, Eigen::Quaterniond::Identity());
  return bed;
}

const MeshMotion kMotion{{0, 0, 0.06}, Eigen::Quaterniond::Identity(), {0.3, 0, -2}, {0, 1, 3}};

}  // namespace

TEST_CASE("a bed restored from a snapshot ends with the same bytes, from any number of threads") {
  const Precision precision = GENERATE(Precision::kMixed, Precision::kDouble);
  const int before = GENERATE(1, 333, 3000);  // within an interval, before and after many updates
  DemSettings s = falling(precision);
  s.account_energy = true;
  SandBed whole = bed_with_box(s);
  whole.set_motion(0, kMotion);
  whole.advance(before);
  const std::string snapshot = whole.snapshot();
  whole.advance(2500);
  const std::string end = whole.snapshot();

  for (const int threads : {1, 3}) {
    INFO(threads << " threads, after " << before << " steps");
    s.threads = threads;
    SandBed resumed = bed_with_box(s);
    resumed.set_motion(0, kMotion);
    resumed.advance(17);  // whatever it did before is gone
    resumed.restore(snapshot);
    CHECK((resumed.snapshot() == snapshot));  // in brackets: bytes are not to be printed
    resumed.advance(2500);
    CHECK(resumed.state_hash() == whole.state_hash());
    CHECK((resumed.snapshot() == end));
    CHECK(resumed.energy().total_J() == whole.energy().total_J());
    CHECK(resumed.health().renewed == whole.health().renewed);
  }
  s.threads = 1;
  SandBed once_more = bed_with_box(s);
  once_more.restore(snapshot);
  once_more.advance(2500);
  CHECK(once_more.take_load(0).impulse_W_Ns == whole.take_load(0).impulse_W_Ns);
}

TEST_CASE("a snapshot that is cut or of another bed is refused") {
  SandBed bed = bed_with_box(falling(Precision::kMixed));
  bed.advance(100);
  const std::string snapshot = bed.snapshot();
  for (const std::size_t size :
       {std::size_t(0), std::size_t(3), snapshot.size() / 2, snapshot.size() - 1}) {
    SandBed other = bed_with_box(falling(Precision::kMixed));
    CHECK_THROWS_WITH(other.restore(std::string_view(snapshot).substr(0, size)),
                      Catch::Contains("truncated"));
  }
  SandBed exact = bed_with_box(falling(Precision::kDouble));
  CHECK_THROWS_WITH(exact.restore(snapshot), Catch::Contains("of another bed"));
  SandBed longer = bed_with_box(falling(Precision::kMixed));
  CHECK_THROWS_WITH(longer.restore(snapshot + "x"), Catch::Contains("longer"));
}
