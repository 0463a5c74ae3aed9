// Our ParaView files as VTK's own reader (package python3-vtk9) reads them, by read_vtp.py.
#pragma once

#include <sys/wait.h>

#include <array>
#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

namespace hoof::tests {

/// What it printed; status 77 where VTK is not installed, and then a warning that CTest looks for.
struct VtkReading {
  int status = 0;
  std::string text;
};

inline VtkReading read_with_vtk(const std::filesystem::path& file) {
  const std::string command = "/usr/bin/python3 '" HOOF_SOURCE_DIR
                              "/tests/tools/bed/read_vtp.py' '" +
                              file.string() + "' 2>&1";
  std::FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  VtkReading reading;
  std::array<char, 4096> block;
  std::size_t count = 0;
  while ((count = std::fread(block.data(), 1, block.size(), pipe)) > 0) {
    reading.text.append(block.data(), count);
  }
  reading.status = WEXITSTATUS(pclose(pipe));
  if (reading.status == 77) {
    WARN("SKIPPED: python3-vtk9 is not installed, " << file << " was not read back");
  }
  return reading;
}

/// The numbers below the line that begins with `title`.
inline std::vector<double> numbers_below(const std::string& text, const std::string& title) {
  std::istringstream lines(text);
  std::string line;
  while (std::getline(lines, line) && !line.starts_with(title)) {
  }
  INFO(title << " in:\n" << text);
  REQUIRE(lines);
  std::vector<double> numbers;
  while (std::getline(lines, line) && line.starts_with("  ")) {
    std::istringstream row(line);
    for (double x; row >> x;) numbers.push_back(x);
  }
  return numbers;
}

inline void require_near(const std::vector<double>& got, const std::vector<double>& wanted) {
  REQUIRE(got.size() == wanted.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    INFO("number " << i);
    CHECK(got[i] == Approx(wanted[i]).epsilon(1e-6));  // 32 bit floats
  }
}

}  // namespace hoof::tests
