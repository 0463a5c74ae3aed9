#include "firmware/safety/cycle_watch.h"

#include <catch2/catch.hpp>
#include <vector>

using hoof::firmware::safety::CycleWatch;
using hoof::firmware::safety::Stage;

namespace {

constexpr Stage kStages[] = {Stage::kRead, Stage::kDecide, Stage::kGate, Stage::kWrite};

bool finishes(bool due, const std::vector<Stage>& stages) {
  CycleWatch watch;
  watch.begin();
  if (due) watch.tick_due();
  for (const Stage stage : stages) watch.passed(stage);
  return watch.finished();
}

}  // namespace

TEST_CASE("A cycle without a tick is finished when it has read; with one, when all is written") {
  using enum Stage;
  CHECK_FALSE(finishes(false, {}));
  CHECK(finishes(false, {kRead}));
  CHECK_FALSE(finishes(true, {}));
  CHECK_FALSE(finishes(true, {kRead}));
  CHECK_FALSE(finishes(true, {kRead, kDecide}));
  CHECK_FALSE(finishes(true, {kRead, kDecide, kGate}));
  CHECK(finishes(true, {kRead, kDecide, kGate, kWrite}));
}

TEST_CASE("Of all sequences of up to five stages only the two right ones finish a cycle") {
  for (const bool due : {false, true}) {
    int finished = 0;
    for (int length = 0; length <= 5; ++length) {
      int sequences = 1;
      for (int i = 0; i < length; ++i) sequences *= 4;
      for (int code = 0; code < sequences; ++code) {
        std::vector<Stage> stages;
        for (int i = 0, rest = code; i < length; ++i, rest /= 4)
          stages.push_back(kStages[rest % 4]);
        finished += finishes(due, stages);
      }
    }
    CHECK(finished == 1);
  }
}

TEST_CASE("Each cycle counts for itself") {
  CycleWatch watch;
  CHECK_FALSE(watch.finished());
  watch.passed(Stage::kRead);
  CHECK(watch.finished());
  watch.begin();
  watch.tick_due();
  for (const Stage stage : kStages) watch.passed(stage);
  CHECK(watch.finished());
  watch.begin();
  CHECK_FALSE(watch.finished());
  watch.passed(Stage::kRead);
  CHECK(watch.finished());  // the tick of the cycle before is not due again
  // A broken order stays broken until the next cycle, whatever comes.
  watch.passed(Stage::kRead);
  for (int i = 0; i < 600; ++i) {
    watch.passed(kStages[i % 4]);
    CHECK_FALSE(watch.finished());
  }
  watch.begin();
  watch.passed(Stage::kRead);
  CHECK(watch.finished());
}
