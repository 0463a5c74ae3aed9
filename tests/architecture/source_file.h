#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace hoof::tests {

/// A file of the source tree.
struct SourceFile {
  std::string path;  ///< from the root, with slashes: "sim/dem/contact_law.h"
  std::vector<std::string> lines;

  bool is_header() const { return path.ends_with(".h"); }
  bool is_cpp() const { return is_header() || path.ends_with(".cpp"); }
};

/// What breaks a rule of the house, and where. Line 0: the file as a whole.
struct Finding {
  std::string path;
  int line = 0;
  std::string rule;
};

/// "sim/dem/a.h:12: rule"
std::string to_string(const Finding& finding);

/// All text files of the house below `root`, by path. Leaves out what git does not hold (build
/// folders, runs), third-party code (vendor/) and recorded data (tests/data).
std::vector<SourceFile> read_source_tree(const std::filesystem::path& root);

}  // namespace hoof::tests
