#include "tools/reproduce/slurm_queue.h"

#include <catch2/catch.hpp>

#include "tools/reproduce/campaign.h"

using namespace hoof::tools;

TEST_CASE("squeue's answer: one task a line, warnings and jobs without an array left out") {
  const auto tasks = parse_squeue(
      "squeue: warning: something\n"
      "12_3|hoof-abc|RUNNING|None\n"
      "12_14|hoof-abc|PENDING|JobArrayTaskLimit\n"
      "13|hoof-abc|RUNNING|None\n"
      "14_0|hoof-abc|PENDING|DependencyNeverSatisfied\n"
      "15_x|hoof-abc|PENDING|\n"
      "16_1|hoof-def|COMPLETING|\n"
      "2_3|hoof-5c4|PENDING|launch failed requeued held\n");
  REQUIRE(tasks.size() == 5);
  CHECK(tasks[4].stuck());
  CHECK(tasks[0].job == "12_3");
  CHECK(tasks[0].name == "hoof-abc");
  CHECK(tasks[0].index == 3);
  CHECK(tasks[0].state == "RUNNING");
  CHECK(tasks[1].index == 14);
  CHECK_FALSE(tasks[1].stuck());
  CHECK(tasks[2].stuck());
  CHECK(tasks[3].reason.empty());
  CHECK(parse_squeue("").empty());
}

TEST_CASE("jobs and threads share the cores") {
  Engine engine;
  CHECK(engine.jobs_at_once(2) == 2);
  CHECK(engine.threads_each(2) == 1);
  engine.threads = 2;
  CHECK(engine.jobs_at_once(2) == 1);
  CHECK(engine.jobs_at_once(8) == 4);
  CHECK(engine.jobs_at_once(1) == 1);
  engine.threads = {};
  engine.jobs = 2;
  CHECK(engine.threads_each(8) == 4);
  CHECK(engine.threads_each(1) == 1);
  engine.jobs = 3, engine.threads = 3;
  CHECK(engine.jobs_at_once(2) == 3);
  CHECK(engine.threads_each(2) == 3);
}
