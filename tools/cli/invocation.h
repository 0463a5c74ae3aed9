#pragma once

#include <functional>

namespace hoof::tools {

/// What the command line asks for. Parsing only fills this in; main runs it afterwards, so that
/// errors of the flags and errors of the work are told apart.
struct Invocation {
  std::function<void()> run;
};

}  // namespace hoof::tools
