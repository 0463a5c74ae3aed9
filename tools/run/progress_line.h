#pragma once

#include <ostream>
#include <string>

namespace hoof::tools {

enum class ProgressStyle {
  kTerminal,  ///< one line, redrawn in place
  kLines,     ///< a plain line every few seconds, for logs
  kSilent,
};

/// Terminal bar if standard error is a terminal, plain lines if not, nothing if `quiet`.
ProgressStyle choose_progress_style(bool quiet);

/// Shows how far a run is and how long it will still take. The caller passes the time, so that
/// what is printed depends on nothing else.
class ProgressLine {
 public:
  ProgressLine(std::string label, ProgressStyle style, std::ostream& out);

  /// `fraction` in 0..1 of the work is done `now_s` seconds after some fixed start; `detail` is
  /// a short text for the end of the line, for instance "t = 0.31 s, depth 12.4 mm".
  void update(double fraction, double now_s, const std::string& detail = "");

  /// The same with the time since construction by the steady clock.
  void update(double fraction, const std::string& detail = "");

  /// Ends a redrawn line so that what follows starts on a new one. Harmless when called twice.
  void finish();

 private:
  std::string label_;
  ProgressStyle style_;
  std::ostream& out_;
  double created_s_;
  double first_update_s_ = 0.0;
  double first_fraction_ = 0.0;
  double last_shown_s_ = 0.0;
  bool started_ = false;
  bool line_open_ = false;
};

/// "4 s", "2 min 05 s", "1 h 07 min".
std::string format_duration(double duration_s);

}  // namespace hoof::tools
