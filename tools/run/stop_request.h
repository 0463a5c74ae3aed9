#pragma once

namespace hoof::tools {

/// While one of these lives, the first SIGINT (Ctrl-C), SIGTERM or SIGUSR1 (what batch systems send
/// ahead of a time limit) only asks the program to stop; a second one ends it at once. One at a
/// time; loops ask requested() once per step.
class StopRequest {
 public:
  StopRequest();
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;

  bool requested() const;

  /// 128 + the signal's number as shells report it (130 for Ctrl-C), 0 if nothing was requested.
  int exit_status() const;
};

}  // namespace hoof::tools
