#include "tools/run/progress_line.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <utility>

namespace hoof::tools {
namespace {

constexpr double kTerminalInterval_s = 0.1;  // faster than this only flickers
constexpr double kLineInterval_s = 5.0;      // a log of a three-minute run stays under 40 lines
constexpr int kBarWidth = 28;                // leaves room for the detail in 80 columns
// Before this much is done the time left is a guess that jumps about, so it is not shown.
constexpr double kLeastFractionForEstimate = 0.01;

double steady_now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string bar(double fraction) {
  const int filled = static_cast<int>(fraction * kBarWidth);
  return "[" + std::string(filled, '=') + std::string(kBarWidth - filled, ' ') + "]";
}

std::string percent(double fraction) {
  char text[8];
  std::snprintf(text, sizeof text, "%3d %%", static_cast<int>(fraction * 100.0));
  return text;
}

}  // namespace

ProgressStyle choose_progress_style(bool quiet) {
  if (quiet) return ProgressStyle::kSilent;
  return isatty(STDERR_FILENO) != 0 ? ProgressStyle::kTerminal : ProgressStyle::kLines;
}

ProgressLine::ProgressLine(std::string label, ProgressStyle style, std::ostream& out)
    : label_(std::move(label)), style_(style), out_(out), created_s_(steady_now_s()) {}

void ProgressLine::update(double fraction, const std::string& detail) {
  update(fraction, steady_now_s() - created_s_, detail);
}

void ProgressLine::update(double fraction, double now_s, const std::string& detail) {
  if (style_ == ProgressStyle::kSilent) return;
  fraction = std::clamp(fraction, 0.0, 1.0);
  const double interval_s =
      style_ == ProgressStyle::kTerminal ? kTerminalInterval_s : kLineInterval_s;
  if (!started_) {
    started_ = true;
    first_update_s_ = now_s;
    first_fraction_ = fraction;
  } else if (now_s - last_shown_s_ < interval_s && fraction < 1.0) {
    return;
  }
  last_shown_s_ = now_s;

  std::string text = label_ + " ";
  if (style_ == ProgressStyle::kTerminal) text += bar(fraction) + " ";
  text += percent(fraction);
  const double done = fraction - first_fraction_;
  if (done >= kLeastFractionForEstimate && fraction < 1.0) {
    const double left_s = (now_s - first_update_s_) * (1.0 - fraction) / done;
    text += ", " + format_duration(left_s) + " left";
  }
  if (!detail.empty()) text += ", " + detail;

  if (style_ == ProgressStyle::kTerminal) {
    out_ << '\r' << text << "\033[K" << std::flush;  // ESC [ K erases the rest of the old line
    line_open_ = true;
  } else {
    out_ << text << std::endl;
  }
}

void ProgressLine::finish() {
  if (line_open_) out_ << std::endl;
  line_open_ = false;
}

std::string format_duration(double duration_s) {
  const long total_s = static_cast<long>(std::max(0.0, duration_s) + 0.5);
  char text[48];
  if (total_s < 60) {
    std::snprintf(text, sizeof text, "%ld s", total_s);
  } else if (total_s < 3600) {
    std::snprintf(text, sizeof text, "%ld min %02ld s", total_s / 60, total_s % 60);
  } else {
    std::snprintf(text, sizeof text, "%ld h %02ld min", total_s / 3600, total_s / 60 % 60);
  }
  return text;
}

}  // namespace hoof::tools
