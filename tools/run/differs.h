#pragma once

#include <stdexcept>

namespace hoof::tools {

/// What was compared is not the same. The message may have several lines and is the result: it goes
/// to standard output.
class Differs : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;

  /// As of diff(1) and cmp(1); beside those of errors.h.
  static constexpr int kExitStatus = 1;
};

}  // namespace hoof::tools
