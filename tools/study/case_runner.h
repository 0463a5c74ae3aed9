// Runs the cases of a study one after another, keeping each as it is finished.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/config/materials.h"
#include "sim/terrain/bed_store.h"
#include "tools/run/progress_line.h"
#include "tools/run/stop_request.h"
#include "tools/study/press.h"

namespace hoof::tools {

class CaseRunner {
 public:
  /// @param folder of the study; curves go to cases/ in it
  /// @param beds folder of settled beds
  CaseRunner(std::filesystem::path folder, std::filesystem::path beds, sim::Materials materials,
             int threads, ProgressStyle style);

  /// Curves of the cases, in their order. A case whose file is there is read, not run.
  /// @throws Interrupted after Ctrl-C; what was finished is kept, and the same call goes on
  std::vector<PressCurve> run(const std::string& label, const std::vector<PressCase>& cases);

  std::filesystem::path file(const PressCase& c) const;

 private:
  struct Plan;  // how long what is missing takes, in grain-steps

  PressCurve run_one(const PressCase& c, Plan& plan);
  [[noreturn]] void stop() const;

  std::filesystem::path folder_;
  sim::BedStore store_;
  sim::Materials materials_;
  int threads_;
  ProgressStyle style_;
  StopRequest stop_;
};

}  // namespace hoof::tools
