#pragma once

#include <filesystem>
#include <iosfwd>

namespace hoof::tools::conceal {

struct GradeOptions {
  std::filesystem::path batch, answers;
  std::filesystem::path truth;  ///< empty = batch/truth.json
  std::filesystem::path csv;    ///< empty = none
  /// Of a batch that is not through: only the cases that have an answer folder count, and how many
  /// do not is said. Otherwise what is not answered is wrong.
  bool answered = false;
};

/// Prints the table of the contract's section 5 with baselines beside it, what was taken for what,
/// the time taken and which answers are missing. UserError where the truth is not the sealed one.
void grade(const GradeOptions& options, std::ostream& out);

}  // namespace hoof::tools::conceal
