#include "tests/architecture/file_rules.h"

#include <algorithm>
#include <array>
#include <regex>
#include <string_view>

namespace hoof::tests {
namespace {

constexpr std::size_t kMostLines = 500;

constexpr std::array kTopLevel = {".ci", ".clang-format", ".clang-tidy", ".git", ".gitattributes",
                                  ".gitignore", "CHANGELOG.md", "CMakeLists.txt", "LICENSE",
                                  "CMakePresets.json", "README.md", "firmware", "hal", "hil_bridge",
                                  "sim", "tests", "tools",
                                  // Made by use, ignored by git.
                                  ".cache", "compile_commands.json", "runs"};

}  // namespace

std::vector<Finding> check_files(const std::vector<SourceFile>& files) {
  // In pieces, so that this file does not find itself.
  static const std::regex kMachinePath(
      "(^|[^A-Za-z0-9_.])/(wo"
      "rk|fa"
      "rm|ro"
      "ot|ho"
      "me)/");
  std::vector<Finding> findings;
  for (const SourceFile& file : files) {
    if (file.lines.size() > kMostLines) {
      findings.push_back({file.path, 0, std::to_string(file.lines.size()) + " lines, over 500"});
    }
    const bool guarded =
        std::find(file.lines.begin(), file.lines.end(), "#pragma once") != file.lines.end();
    if (file.is_header() && !guarded) findings.push_back({file.path, 0, "no #pragma once"});
    for (std::size_t i = 0; i < file.lines.size(); ++i) {
      if (std::regex_search(file.lines[i], kMachinePath)) {
        findings.push_back({file.path, static_cast<int>(i) + 1, "path of one machine"});
      }
    }
  }
  return findings;
}

std::vector<Finding> check_top_level(const std::filesystem::path& root) {
  std::vector<Finding> findings;
  for (const auto& entry : std::filesystem::directory_iterator(root)) {
    const std::string name = entry.path().filename().string();
    const bool known = std::find(kTopLevel.begin(), kTopLevel.end(), name) != kTopLevel.end();
    // build*, as in .gitignore
    if (!known && !name.starts_with("build")) {
      findings.push_back({name, 0, "the top level of the house is fixed"});
    }
  }
  return findings;
}

}  // namespace hoof::tests
