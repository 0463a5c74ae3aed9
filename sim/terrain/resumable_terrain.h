// A ground whose whole state can be taken and put back.
#pragma once

#include <string>
#include <string_view>

#include "sim/terrain/terrain.h"

namespace hoof::sim {

class ResumableTerrain : public Terrain {
 public:
  /// All that decides what is to come, exact: a ground with the same settings and bodies that is
  /// given these bytes goes on with the same bytes, on any number of threads. Between two calls of
  /// advance.
  virtual std::string snapshot() const = 0;

  /// @throws std::runtime_error where the bytes are not a snapshot of such a ground
  virtual void restore(std::string_view snapshot) = 0;
};

}  // namespace hoof::sim
