// What the reading of settings throws.
#pragma once

#include <stdexcept>

namespace hoof::sim {

/// A setting, file or mesh the user has to correct. what() is one line that names file, line, key,
/// value and the allowed bound; a command prints it and ends with status 2.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace hoof::sim
