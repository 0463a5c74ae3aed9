// The real rigs over the rigid floor, from the shipped settings: seconds of test in milliseconds.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hil_bridge/session.h"
#include "tools/experiment/bench.h"
#include "tools/experiment/run_settings.h"

namespace hoof::test {

inline tools::RunSettings rigid_run(const std::string& kind, std::vector<std::string> set = {}) {
  set.insert(set.begin(), "experiment.terrain=\"rigid\"");
  return tools::read_run_settings(kind, set);
}

inline std::unique_ptr<sim::Experiment> rigid_bench(const tools::RunSettings& run) {
  return tools::make_experiment(
      run, [](double) { return true; }, [](const std::string&) {});
}

/// A frame as the wires' observer saw it.
struct SeenFrame {
  int bus = 0;
  hal::CanFrame frame;
};

}  // namespace hoof::test
