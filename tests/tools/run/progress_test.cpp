#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <sstream>

#include "tools/run/progress_line.h"
#include "tools/run/stop_request.h"
#include "tools/run/version.h"

using namespace hoof::tools;

TEST_CASE("plain progress is a line every few seconds, with the time left") {
  std::ostringstream out;
  ProgressLine progress("sinkage", ProgressStyle::kLines, out);
  for (int second = 0; second <= 20; ++second) progress.update(second / 20.0, second, "x");
  progress.finish();
  CHECK(out.str() ==
        "sinkage   0 %, x\n"
        "sinkage  25 %, 15 s left, x\n"
        "sinkage  50 %, 10 s left, x\n"
        "sinkage  75 %, 5 s left, x\n"
        "sinkage 100 %, x\n");
}

TEST_CASE("time left counts from where this run began") {
  std::ostringstream out;
  ProgressLine progress("settle", ProgressStyle::kLines, out);
  progress.update(0.5, 100.0);
  progress.update(0.75, 110.0);  // a quarter took 10 s, a quarter is left
  CHECK_THAT(out.str(), Catch::EndsWith("settle  75 %, 10 s left\n"));
}

TEST_CASE("progress on a terminal redraws one line and ends it") {
  std::ostringstream out;
  ProgressLine progress("sinkage", ProgressStyle::kTerminal, out);
  progress.update(0.0, 0.0);
  progress.update(0.01, 0.05);  // too soon to redraw
  progress.update(0.5, 4.0);
  progress.finish();
  progress.finish();
  CHECK(out.str() ==
        "\rsinkage [                            ]   0 %\033[K"
        "\rsinkage [==============              ]  50 %, 4 s left\033[K\n");
}

TEST_CASE("quiet progress prints nothing") {
  std::ostringstream out;
  ProgressLine progress("sinkage", ProgressStyle::kSilent, out);
  progress.update(0.0, 0.0);
  progress.update(1.0, 9.0);
  progress.finish();
  CHECK(out.str().empty());
}

TEST_CASE("durations read naturally") {
  CHECK(format_duration(4.4) == "4 s");
  CHECK(format_duration(59.6) == "1 min 00 s");
  CHECK(format_duration(125.0) == "2 min 05 s");
  CHECK(format_duration(4020.0) == "1 h 07 min");
  CHECK(format_duration(-1.0) == "0 s");
}

TEST_CASE("the first Ctrl-C is a request, as is SIGTERM") {
  for (const int signal_number : {SIGINT, SIGTERM}) {
    const StopRequest stop;
    CHECK_FALSE(stop.requested());
    CHECK(stop.exit_status() == 0);
    std::raise(signal_number);
    CHECK(stop.requested());
    CHECK(stop.exit_status() == 128 + signal_number);
  }
}

TEST_CASE("the second Ctrl-C ends the program") {
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    std::signal(SIGINT, SIG_DFL);  // the test framework's own handler would report it
    const StopRequest stop;
    std::raise(SIGINT);
    if (!stop.requested()) _exit(1);
    std::raise(SIGINT);
    _exit(2);
  }
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  CHECK(WIFSIGNALED(status));
  CHECK(WTERMSIG(status) == SIGINT);
}

TEST_CASE("the version names code, compiler and build") {
  const auto version = version_json();
  CHECK_FALSE(version.at("code").get<std::string>().empty());
  CHECK_THAT(version.at("compiler").get<std::string>(), Catch::Matches(".* [0-9.]+"));
  CHECK_FALSE(version.at("build").get<std::string>().empty());
}
