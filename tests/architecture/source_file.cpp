#include "tests/architecture/source_file.h"

#include <algorithm>
#include <array>
#include <fstream>

namespace hoof::tests {
namespace fs = std::filesystem;
namespace {

constexpr std::array kRooms = {".ci", "firmware", "hal", "hil_bridge", "sim", "tests", "tools"};
constexpr std::array kTextEndings = {".h",  ".cpp", ".cmake", ".txt", ".toml",     ".md",
                                     ".js", ".css", ".sh",    ".py",  ".json",     ".ld",
                                     ".S",  ".in",  "/hoof",  "/run", "/with-vcan"};

bool is_text(const std::string& path) {
  return std::any_of(kTextEndings.begin(), kTextEndings.end(),
                     [&path](const char* ending) { return path.ends_with(ending); });
}

SourceFile read_source(const fs::path& root, const fs::path& path) {
  SourceFile file{path.lexically_relative(root).generic_string(), {}};
  std::ifstream stream(path);
  for (std::string line; std::getline(stream, line);) file.lines.push_back(line);
  return file;
}

bool is_left_out(const fs::directory_entry& entry, const std::string& path) {
  return entry.is_directory() && (entry.path().filename() == "vendor" || path == "tests/data");
}

}  // namespace

std::string to_string(const Finding& finding) {
  return finding.path + ":" + std::to_string(finding.line) + ": " + finding.rule;
}

std::vector<SourceFile> read_source_tree(const fs::path& root) {
  std::vector<SourceFile> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(root)) {
    if (entry.is_regular_file() && is_text(entry.path().string())) {
      files.push_back(read_source(root, entry.path()));
    }
  }
  for (const char* room : kRooms) {
    if (!fs::is_directory(root / room)) continue;
    fs::recursive_directory_iterator entries(root / room);
    for (auto it = begin(entries); it != end(entries); ++it) {
      const std::string path = it->path().lexically_relative(root).generic_string();
      if (is_left_out(*it, path)) {
        it.disable_recursion_pending();
      } else if (it->is_regular_file() && is_text(path)) {
        files.push_back(read_source(root, it->path()));
      }
    }
  }
  std::sort(files.begin(), files.end(),
            [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
  return files;
}

}  // namespace hoof::tests
