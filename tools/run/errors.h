#pragma once

#include <stdexcept>
#include <string>

namespace hoof::tools {

/// Exit statuses of the program, the same for every command.
enum class ExitStatus : int {
  kOk = 0,
  kUserError = 2,     ///< bad input, or output that cannot be written where it was asked for
  kCannotFinish = 3,  ///< the input was good but the work could not be completed
};

/// Something the user can mend: a wrong flag, key or value, a missing file, a full disk.
/// The message is one line that names the file, key or flag, the value and the bound.
class UserError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The work was begun and cannot be completed, for instance because a simulation diverged.
class CannotFinish : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The work was done, and what was measured is not as it must be: exit status 1.
class BarMissed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The user asked to stop (see StopRequest); thrown once everything worth keeping is kept.
class Interrupted : public std::runtime_error {
 public:
  /// `exit_status` is 128 + the signal's number, as shells report it: 130 for Ctrl-C.
  Interrupted(const std::string& what, int exit_status)
      : std::runtime_error(what), exit_status_(exit_status) {}

  int exit_status() const { return exit_status_; }

 private:
  int exit_status_;
};

/// Another program that was started has failed and has said why: only its status is left to pass
/// on.
class AlreadySaid : public std::runtime_error {
 public:
  explicit AlreadySaid(int exit_status)
      : std::runtime_error("a program that was started has failed"), exit_status_(exit_status) {}

  int exit_status() const { return exit_status_; }

 private:
  int exit_status_;
};

}  // namespace hoof::tools
