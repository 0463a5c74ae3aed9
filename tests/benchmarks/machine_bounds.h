// What the machine itself can do, measured in the same run as what the engine does.
#pragma once

namespace hoof::benchmarks {

/// Bytes copied per second by `threads` at once, read and written, over 256 MB each.
double copy_bandwidth_B_s(int threads);

/// Single-precision multiplications and additions per second, half of each, by `threads` at once,
/// in vectors as wide as the machine has.
double float_rate_flop_s(int threads);

}  // namespace hoof::benchmarks
