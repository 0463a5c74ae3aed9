#pragma once

#include <filesystem>
#include <string>

namespace hoof::tools::conceal {

struct ExaminationOptions {
  std::filesystem::path batch, answers;
  std::string program = "hoof";  ///< a path, or a name that is searched in PATH
  int jobs = 1;
  std::string only;  ///< one case, empty = all
  bool quiet = false;
};

/// Has PROGRAM diagnose each case of a batch and takes the time. Answers that are there already
/// stay; CannotFinish names the cases in which the program failed, once all are done.
void examine(const ExaminationOptions& options);

}  // namespace hoof::tools::conceal
