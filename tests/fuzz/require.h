// What a fuzz target demands of the code under it: the first broken demand ends the program, so
// that the fuzzer keeps the input.
#pragma once

#include <cstdio>
#include <cstdlib>

namespace hoof::tests::fuzz {

/// @param holds when false, `demand` is printed and the program aborts
inline void require(bool holds, const char* demand) {
  if (holds) return;
  std::fprintf(stderr, "fuzz: broken: %s\n", demand);
  std::abort();
}

}  // namespace hoof::tests::fuzz
