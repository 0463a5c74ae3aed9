// The deadlines of real time, in a time that the test makes up.
#include "hil_bridge/deadline_schedule.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

using hoof::bridge::DeadlineSchedule;
using hoof::bridge::DurationHistogram;

namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000;
constexpr std::int64_t kStart_ns = 123'456'789'000;

}  // namespace

TEST_CASE("deadlines lie on the grid from the start on, however late each wake is") {
  DeadlineSchedule schedule(kStart_ns, kPeriod_ns);
  const std::int64_t late_ns[] = {0, 999'999, 1, 500'000, 0, 70'000};
  std::int64_t grid = 0;
  for (const std::int64_t late : late_ns) {
    ++grid;
    REQUIRE(schedule.deadline_ns() == kStart_ns + grid * kPeriod_ns);
    CHECK(schedule.woke(schedule.deadline_ns() + late) == 1);
  }
  CHECK(schedule.ticks() == 6);
  CHECK(schedule.missed() == 0);
  CHECK(schedule.latency().count() == 6);
  CHECK(schedule.latency().max_ns() == 999'999);
}

TEST_CASE("a wake that is late by periods counts each of them and keeps to the grid") {
  // Exactly one period late: the second deadline is due at that very moment, too.
  const std::vector<std::pair<std::int64_t, std::uint32_t>> cases = {
      {0, 1}, {kPeriod_ns - 1, 1}, {kPeriod_ns, 2}, {kPeriod_ns + 1, 2}, {7 * kPeriod_ns + 3, 8}};
  for (const auto& [late_ns, ticks] : cases) {
    DeadlineSchedule schedule(kStart_ns, kPeriod_ns);
    CHECK(schedule.woke(kStart_ns + kPeriod_ns + late_ns) == ticks);
    CHECK(schedule.missed() == ticks - 1);
    CHECK(schedule.deadline_ns() == kStart_ns + (1 + std::int64_t(ticks)) * kPeriod_ns);
    CHECK(schedule.deadline_ns() > kStart_ns + kPeriod_ns + late_ns);  // never in the past
  }
}

TEST_CASE("work that ends after its deadline is an overrun, at the deadline it is not") {
  DeadlineSchedule schedule(kStart_ns, kPeriod_ns);
  schedule.work_done(kStart_ns + kPeriod_ns);
  CHECK(schedule.overruns() == 0);
  schedule.work_done(kStart_ns + kPeriod_ns + 1);
  CHECK(schedule.overruns() == 1);
}

TEST_CASE("a wake that is early, as a clock of coarse steps may tell it, is not late") {
  DeadlineSchedule schedule(kStart_ns, kPeriod_ns);
  CHECK(schedule.woke(kStart_ns + kPeriod_ns - 40) == 1);
  CHECK(schedule.latency().max_ns() == 0);
  CHECK(schedule.deadline_ns() == kStart_ns + 2 * kPeriod_ns);
}

TEST_CASE("jitter is the distance of two wakes from whole periods, either way") {
  DeadlineSchedule schedule(kStart_ns, kPeriod_ns);
  schedule.woke(kStart_ns + 1 * kPeriod_ns + 100'000);
  CHECK(schedule.jitter().count() == 0);               // there is no wake before the first
  schedule.woke(kStart_ns + 2 * kPeriod_ns + 30'000);  // nearer by 70 us
  CHECK(schedule.jitter().max_ns() == 70'000);
  schedule.woke(kStart_ns + 3 * kPeriod_ns + 230'000);  // farther by 200 us
  CHECK(schedule.jitter().max_ns() == 200'000);
  // Three periods on, at the same lateness: no jitter, though two ticks were missed.
  schedule.woke(kStart_ns + 4 * kPeriod_ns + 2 * kPeriod_ns + 230'000);
  CHECK(schedule.jitter().percentile_ns(0.01) == 0);
  CHECK(schedule.missed() == 2);
}

TEST_CASE("over any history the ticks given out are the periods that have passed") {
  const auto seed = GENERATE(1u, 2u, 3u, 4u);
  CAPTURE(seed);
  std::mt19937 random(seed);
  DeadlineSchedule schedule(kStart_ns, kPeriod_ns);
  std::int64_t now_ns = kStart_ns;
  std::uint64_t given = 0, overruns = 0;
  for (int i = 0; i < 20'000; ++i) {
    // Work of mostly a fifth of a period, now and then of several.
    const bool stall = random() % 50 == 0;
    now_ns += stall ? std::int64_t(random() % (5 * kPeriod_ns))
                    : std::int64_t(random() % (kPeriod_ns / 5));
    if (now_ns > schedule.deadline_ns()) ++overruns;
    schedule.work_done(now_ns);
    // An absolute sleep comes back at once where its time has passed, and late by the scheduler.
    now_ns = std::max(now_ns, schedule.deadline_ns()) + std::int64_t(random() % 90'000);
    given += schedule.woke(now_ns);
    REQUIRE(given == std::uint64_t((now_ns - kStart_ns) / kPeriod_ns));
  }
  CHECK(schedule.ticks() == given);
  CHECK(schedule.overruns() == overruns);
  CHECK(schedule.missed() == given - 20'000);
  CHECK(overruns > 100);  // the history had some
}

TEST_CASE("percentiles are those of the sorted durations, rounded up to microseconds") {
  const auto seed = GENERATE(5u, 6u, 7u);
  CAPTURE(seed);
  std::mt19937 random(seed);
  std::vector<std::int64_t> all;
  DurationHistogram histogram;
  for (int i = 0; i < 2'000; ++i) {
    const std::int64_t ns = random() % 7 == 0 ? random() % 30'000'000 : random() % 50'000;
    all.push_back(ns);
    histogram.add(ns);
  }
  std::sort(all.begin(), all.end());
  for (const double share : {0.01, 0.5, 0.9, 0.99, 1.0}) {
    const std::int64_t exact = all[std::size_t(std::ceil(share * double(all.size()))) - 1];
    const bool in_range = exact <= (DurationHistogram::kRange_us - 1) * 1000;
    CHECK(histogram.percentile_ns(share) == (in_range ? (exact + 999) / 1000 * 1000 : all.back()));
  }
  CHECK(histogram.max_ns() == all.back());
  std::uint64_t counted = 0;
  for (const auto& [upper_us, count] : histogram.octaves()) counted += count;
  CHECK(counted == all.size());
}

TEST_CASE("octaves count by their upper ends, and an empty histogram tells zeros") {
  DurationHistogram histogram;
  CHECK(histogram.percentile_ns(0.5) == 0);
  CHECK(histogram.octaves().empty());
  for (const std::int64_t ns : {0, 1'000, 1'001, 2'000, 4'000, 5'000, -3}) histogram.add(ns);
  // 0, 1 us and the negative one; above 1 to 2 us; above 2 to 4 us; above 4 to 8 us.
  CHECK(histogram.octaves() ==
        std::vector<std::pair<std::int64_t, std::uint64_t>>{{1, 3}, {2, 2}, {4, 1}, {8, 1}});
  // Beyond the range nothing hides behind a power of two.
  histogram.add(117'000'000);
  CHECK(histogram.octaves().back() == std::pair<std::int64_t, std::uint64_t>{117'000, 1});
}
