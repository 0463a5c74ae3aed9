// Opens a page in a headless browser without a network.
#pragma once

#include <sys/wait.h>

#include <array>
#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>
#include <string>

#include "tools/run/output_file.h"

namespace hoof::tests {

struct ShellOutcome {
  int status = 0;
  std::string output;
};

inline ShellOutcome run_shell(const std::string& command) {
  std::FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  ShellOutcome outcome;
  std::array<char, 1 << 16> block;
  std::size_t count = 0;
  while ((count = std::fread(block.data(), 1, block.size(), pipe)) > 0) {
    outcome.output.append(block.data(), count);
  }
  outcome.status = WEXITSTATUS(pclose(pipe));
  return outcome;
}

inline bool browser_is_missing() {
  if (run_shell("command -v chromium").status == 0) return false;
  WARN("SKIPPED: chromium is not installed, the page was not opened in a browser");
  return true;
}

struct Opened {
  std::string page;      ///< the document after its scripts have run
  std::string messages;  ///< errors that scripts wrote to the console
};

// Root, as in a container, cannot use chromium's sandbox; the page is our own. So may WebGL be
// drawn in software.
inline Opened open_in_browser(const std::filesystem::path& page,
                              const std::filesystem::path& scratch,
                              const std::string& more_flags = "") {
  const std::string log = (scratch / "browser.log").string();
  const ShellOutcome outcome = run_shell(
      "timeout 60 chromium --headless=new --no-sandbox --disable-gpu --disable-dev-shm-usage "
      "--enable-unsafe-swiftshader " +
      more_flags +
      " "
      "--host-resolver-rules='MAP * ~NOTFOUND' --enable-logging=stderr --user-data-dir='" +
      (scratch / "profile").string() + "' --dump-dom 'file://" + page.string() + "' 2>'" + log +
      "'");
  CHECK(outcome.status == 0);
  Opened opened{outcome.output, ""};
  const std::string text = tools::read_file(log);
  for (std::size_t at = text.find(":CONSOLE"); at != std::string::npos;
       at = text.find(":CONSOLE", at + 1)) {
    opened.messages += text.substr(at, text.find('\n', at) - at) + "\n";
  }
  return opened;
}

inline int count_of(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

}  // namespace hoof::tests
