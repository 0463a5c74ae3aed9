// Data sets in a temporary folder, made from text.
#pragma once

#include <filesystem>
#include <string>

#include "tests/tools/run/scratch_folder.h"

namespace hoof::tests {

class DataFolder {
 public:
  const std::filesystem::path& path() const { return scratch_.path(); }
  std::filesystem::path write(const std::string& name, const std::string& text) const;

  /// `text` without the folder in front of file names.
  std::string shortened(std::string text) const;

 private:
  ScratchFolder scratch_;
};

/// `text` with the first `from` replaced; fails the test where there is none.
std::string replaced(std::string text, const std::string& from, const std::string& to);

/// A pendulum under the law "duty" with two recordings, a.csv and b.csv, each on a known line.
extern const std::string kPendulumToml;
extern const std::string kPendulumCsv;
extern const std::string kSandToml;
extern const std::string kSandCsv;

}  // namespace hoof::tests
