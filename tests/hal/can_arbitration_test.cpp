#include "hal/can_arbitration.h"

#include <catch2/catch.hpp>
#include <random>

#include "hal/can_filter.h"
#include "hal/can_frame_check.h"
#include "tests/hal/wire_reference.h"

namespace hoof::hal {
namespace {

CanFrame id_of(std::uint32_t id, bool extended = false, bool remote = false) {
  CanFrame frame;
  frame.id = id;
  frame.extended = extended;
  frame.remote = remote;
  return frame;
}

std::uint32_t key(std::uint32_t id, bool extended = false, bool remote = false) {
  return arbitration_key(id_of(id, extended, remote));
}

}  // namespace

TEST_CASE("lower identifiers, data and standard frames win", "[can_arbitration]") {
  CHECK(key(0x100) < key(0x101));
  CHECK(key(0x7FE) < key(0x7FF));
  CHECK(key(0x100) < key(0x100, false, true));
  CHECK(key(0x100, true) < key(0x101, true));
  CHECK(key(0x100, true) < key(0x100, true, true));
  // Same 11 leading bits: even the standard remote frame beats the extended data frame.
  CHECK(key(0x100, false, true) < key(0x100U << 18, true));
  // A number is no priority: extended 0x100 has eleven leading zeros and beats standard 0x001.
  CHECK(key(0x100, true) < key(0x001));
  CHECK(key(0x000) < key(0x100, true));
  CHECK(key(0x101) > key(0x100U << 18 | 0x3FFFF, true));
}

TEST_CASE("keys order frames as the wired-and of their bits does", "[can_arbitration]") {
  const unsigned seed = 41;
  INFO("seed " << seed);
  std::mt19937 random(seed);
  int decided = 0;
  for (int i = 0; i < 20'000; ++i) {
    CanFrame a = test::random_classic_frame(random);
    CanFrame b = test::random_classic_frame(random);
    if (i % 2 == 0) b.id = a.extended == b.extended ? a.id ^ (1U << (random() % 11)) : b.id;
    const test::Bits bits_a = test::unstuffed_classic(a);
    const test::Bits bits_b = test::unstuffed_classic(b);
    // Arbitration ends behind the remote bit: standard 13 bits (with IDE), extended 33.
    for (std::size_t k = 1; k < (a.extended && b.extended ? 33U : 14U); ++k) {
      if (bits_a[k] == bits_b[k]) continue;
      ++decided;
      const bool a_wins = !bits_a[k];
      if ((arbitration_key(a) < arbitration_key(b)) != a_wins) {
        FAIL(test::describe(a) << " against " << test::describe(b));
      }
      break;
    }
  }
  CHECK(decided > 15'000);
}

TEST_CASE("frames that cannot be on a wire are recognised", "[can_frame_check]") {
  CHECK(can_exist(id_of(0x7FF)));
  CHECK_FALSE(can_exist(id_of(0x800)));
  CHECK(can_exist(id_of(0x1FFF'FFFF, true)));
  CHECK_FALSE(can_exist(id_of(0x2000'0000, true)));
  CanFrame frame = id_of(1);
  frame.length = 8;
  CHECK(can_exist(frame));
  frame.length = 9;
  CHECK_FALSE(can_exist(frame));
  frame.fd = true;
  CHECK_FALSE(can_exist(frame));
  frame.length = 12;
  CHECK(can_exist(frame));
  frame.remote = true;
  CHECK_FALSE(can_exist(frame));
  frame = id_of(1);
  frame.bit_rate_switch = true;
  CHECK_FALSE(can_exist(frame));
  frame = id_of(1);
  frame.error = true;
  CHECK_FALSE(can_exist(frame));
  int fd_lengths = 0;
  for (int length = 0; length <= 255; ++length) {
    fd_lengths += is_fd_length(static_cast<std::uint8_t>(length)) ? 1 : 0;
  }
  CHECK(fd_lengths == 16);  // the DLC has four bits
}

TEST_CASE("filters compare the masked identifier and the format", "[can_filter]") {
  const CanFilter filter{0x120, 0x7F0, false};
  CHECK(filter.accepts(id_of(0x120)));
  CHECK(filter.accepts(id_of(0x12F)));
  CHECK_FALSE(filter.accepts(id_of(0x130)));
  CHECK_FALSE(filter.accepts(id_of(0x120, true)));
  CHECK(CanFilter{0x120, 0x7F0, true}.accepts(id_of(0x125, true)));
  CHECK(CanFilter{}.accepts(id_of(0x7FF)));
}

}  // namespace hoof::hal
