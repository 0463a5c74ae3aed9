#include "hal/can_timing.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <random>
#include <vector>

#include "tests/hal/wire_reference.h"

namespace hoof::hal {
namespace {

using test::Bits;

CanFrame frame_of(std::uint32_t id, std::vector<std::uint8_t> data, bool extended = false) {
  CanFrame frame;
  frame.id = id;
  frame.extended = extended;
  frame.length = static_cast<std::uint8_t>(data.size());
  std::copy(data.begin(), data.end(), frame.data.begin());
  return frame;
}

/// Most stuff bits that any classic frame of `length` bytes can have: dynamic programming over
/// every state of CRC register and stuffing, all identifiers and data at once.
int most_bits_of_any_frame(int length, bool extended) {
  constexpr int kFree = -1;
  std::vector<int> pattern{0};
  pattern.insert(pattern.end(), 11, kFree);
  if (extended) {
    pattern.insert(pattern.end(), {1, 1});
    pattern.insert(pattern.end(), 18, kFree);
  }
  pattern.insert(pattern.end(), {0, 0, 0});  // RTR, IDE, r0 or RTR, r1, r0
  for (int i = 3; i >= 0; --i) pattern.push_back((length >> i) & 1);
  pattern.insert(pattern.end(), static_cast<std::size_t>(8 * length), kFree);

  // Stuffing state: 2 * run + level, run 0 (nothing sent yet) to 4.
  constexpr int kStates = 10;
  const auto stuff_bit = [](int state, int bit, int& inserted) {
    const int run = state / 2;
    inserted = 0;
    if (run == 0 || state % 2 != bit) return 2 + bit;
    if (run < 4) return state + 2;
    inserted = 1;
    return 2 + (1 - bit);
  };
  std::vector<std::int8_t> most(0x8000 * kStates, -1);
  most[0] = 0;
  for (const int fixed : pattern) {
    std::vector<std::int8_t> next(most.size(), -1);
    for (int crc = 0; crc < 0x8000; ++crc) {
      for (int state = 0; state < kStates; ++state) {
        const int so_far = most[crc * kStates + state];
        if (so_far < 0) continue;
        for (int bit = 0; bit < 2; ++bit) {
          if (fixed != kFree && bit != fixed) continue;
          int inserted = 0;
          const int new_state = stuff_bit(state, bit, inserted);
          const int new_crc = ((crc << 1) ^ (((crc >> 14) ^ bit) & 1 ? 0x4599 : 0)) & 0x7FFF;
          std::int8_t& entry = next[new_crc * kStates + new_state];
          entry = static_cast<std::int8_t>(std::max<int>(entry, so_far + inserted));
        }
      }
    }
    most.swap(next);
  }
  int best = 0;
  for (int crc = 0; crc < 0x8000; ++crc) {
    for (int first = 0; first < kStates; ++first) {
      int total = most[crc * kStates + first];
      if (total < 0) continue;
      int state = first;
      for (int i = 14; i >= 0; --i) {
        int inserted = 0;
        state = stuff_bit(state, (crc >> i) & 1, inserted);
        total += inserted;
      }
      best = std::max(best, total);
    }
  }
  return static_cast<int>(pattern.size()) + 15 + best + test::kUnstuffedTail;
}

}  // namespace

TEST_CASE("the reference computes the catalogued CRC-15/CAN check value", "[can_timing]") {
  Bits bits;
  for (const char c : std::string("123456789")) test::append(bits, static_cast<unsigned>(c), 8);
  CHECK(test::crc15_of(bits) == 0x059E);  // reveng catalogue, CRC-15/CAN
}

TEST_CASE("the reference stuffs after five equal bits and after the next four", "[can_timing]") {
  CHECK(test::stuff({0, 0, 0, 0, 0, 1}) == Bits{0, 0, 0, 0, 0, 1, 1});
  CHECK(test::stuff({0, 0, 0, 0, 0, 1, 1, 1, 1, 0}) == Bits{0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 0, 0});
  CHECK(test::stuff({1, 1, 1, 1, 0, 1}) == Bits{1, 1, 1, 1, 0, 1});
}

TEST_CASE("frame lengths worked out by hand", "[can_timing]") {
  // Identifier 0, no data: SOF to CRC is 34 zeros (the CRC of zeros is zero), so a stuff bit after
  // every fifth zero: 6. 34 + 6 + 13.
  CHECK(frame_bits(frame_of(0, {})).nominal == 53);
  CHECK(classic_crc15(frame_of(0, {})) == 0);
  // The same with eight zero bytes: the DLC 1000 stands after 15 zeros (3 stuff bits). What follows
  // is 67 zeros, then the CRC, taken from the reference as it is no longer zero.
  const CanFrame zeros = frame_of(0, std::vector<std::uint8_t>(8, 0));
  CHECK(frame_bits(zeros).nominal == test::reference_bits(zeros));
  // 29 zeros of identifier: SOF and base 12 zeros (2 stuff), 2 zeros left over, SRR and IDE 1 1,
  // 18 + 1 + 2 + 4 zeros (5 stuff), CRC from the reference.
  const CanFrame extended = frame_of(0, {}, true);
  CHECK(frame_bits(extended).nominal == test::reference_bits(extended));
  // A remote frame carries its DLC and no data.
  CanFrame remote = frame_of(0x2A5, std::vector<std::uint8_t>(8, 0));
  remote.remote = true;
  CHECK(frame_bits(remote).nominal == test::reference_bits(remote));
  CHECK(frame_bits(remote).nominal < 44 + 13 + 10);
}

TEST_CASE("exact bits agree with the bit by bit reference and survive reading back",
          "[can_timing]") {
  const unsigned seed = 20260107;
  INFO("seed " << seed);
  std::mt19937 random(seed);
  int reached = 0;
  for (int i = 0; i < 100'000; ++i) {
    const CanFrame frame = test::random_classic_frame(random);
    const FrameBits bits = frame_bits(frame);
    const int data_length = frame.remote ? 0 : frame.length;
    const int worst = worst_classic_frame_bits(data_length, frame.extended);
    reached = std::max(reached, bits.nominal * 1000 / worst);
    const bool ok = bits.data == 0 && bits.nominal == test::reference_bits(frame) &&
                    bits.nominal <= worst &&
                    bits.nominal >= (frame.extended ? 54 : 34) + 8 * data_length + 13 &&
                    classic_crc15(frame) == (test::crc15_of([&] {
                      Bits all = test::unstuffed_classic(frame);
                      all.resize(all.size() - 15);
                      return all;
                    }()));
    if (!ok) FAIL(test::describe(frame) << " gives " << bits.nominal << " bits");
    if (i % 16 == 0) {
      const auto back = test::read_back(test::stuff(test::unstuffed_classic(frame)));
      if (!back || !(*back == frame)) FAIL(test::describe(frame) << " is not read back");
    }
  }
  CHECK(reached > 950);  // the cases come near the bound: it was really tried
}

TEST_CASE("the worst frame that exists is two bits below the schedulability bound",
          "[can_timing]") {
  // The bound takes every stuffed bit as free. Control bits and CRC are not: for 8 bytes no frame
  // at all has more than 133 of the 135 bits (158 of 160 extended), and these two have them.
  CHECK(most_bits_of_any_frame(8, false) == 133);
  CHECK(most_bits_of_any_frame(8, true) == 158);
  CHECK(most_bits_of_any_frame(0, false) == 53);  // identifier 0 above is a worst one
  const CanFrame standard = frame_of(0x078, {0x01, 0xE1, 0xE1, 0xE1, 0xE1, 0xE1, 0xE0, 0x0F});
  CHECK(frame_bits(standard).nominal == 133);
  const CanFrame extended =
      frame_of(0x000C3C3C, {0x3C, 0x3C, 0x3F, 0xFF, 0x0F, 0x0F, 0x0F, 0x0F}, true);
  CHECK(frame_bits(extended).nominal == 158);
  for (int length = 0; length <= 8; ++length) {
    CHECK(worst_classic_frame_bits(length) == 55 + 10 * length);
    CHECK(worst_classic_frame_bits(length, true) == 80 + 10 * length);
  }
}

TEST_CASE("times follow the bit rate and are rounded up", "[can_timing]") {
  const CanFrame frame = frame_of(0, {});
  CHECK(frame_time_ns(frame) == 53'000);
  CHECK(frame_time_ns(frame, {500'000, 500'000}) == 106'000);
  CHECK(frame_time_ns(frame, {83'333, 83'333}) == 636'003);  // 53e9 / 83333 = 636002.54...
}

TEST_CASE("FD frames: fixed stuff bits, two rates", "[can_timing]") {
  CanFrame frame = frame_of(0x555, {});
  frame.fd = true;
  // Alternating identifier; SOF 0 | 10101010101 | RRS 0 IDE 0 FDF 1 res 0 BRS 0 ESI 0 DLC 0000.
  // res, BRS, ESI and two DLC bits are five zeros: one stuff bit; then 00 to the end: none.
  // 22 + 1, CRC field 4 + 17 + 6 fixed, delimiter 1, tail 2 + 7 + 3.
  CHECK(frame_bits(frame).nominal == 22 + 1 + 27 + 1 + 12);
  CHECK(frame_bits(frame).data == 0);
  // With BRS: res 0 BRS 1, nothing to stuff before; ESI and DLC are five zeros and the last bit of
  // the header: its stuff bit gives way to the first fixed one.
  frame.bit_rate_switch = true;
  CHECK(frame_bits(frame).nominal == 17 + 12);
  CHECK(frame_bits(frame).data == 5 + 27 + 1);
  CHECK(bit_time_ns(frame_bits(frame), {1'000'000, 5'000'000}) == 29'000 + 33 * 200);
  // One byte 0x55 behind the five zeros: now the stuff bit is due, and 0101... needs no other.
  frame.length = 1;
  frame.data[0] = 0x55;  // DLC 0001: ESI 000 1 breaks the run
  CHECK(frame_bits(frame).data == 5 + 8 + 27 + 1);
  // Above 16 bytes the CRC has 21 bits: 4 + 21 + 7 fixed. DLC of 20 bytes is 1011.
  frame.length = 20;
  frame.data.fill(0x55);
  CHECK(frame_bits(frame).data == 5 + 160 + 32 + 1);
  // Extended: 18 identifier bits and SRR more, all before BRS.
  frame.extended = true;
  frame.id = 0x15555555;
  CHECK(frame_bits(frame).nominal == 36 + 12);
  // A run of equal data bits is stuffed like everywhere: 160 zeros behind DLC 1011.
  frame.data.fill(0);
  // 160 zeros: every fifth one would be followed by a stuff bit, 32 of them, the last one replaced.
  CHECK(frame_bits(frame).data == 5 + 160 + 31 + 32 + 1);
}

TEST_CASE("the first difference is found behind its stuff bits, on either side", "[can_timing]") {
  CanFrame a = frame_of(0, {0x00});
  CanFrame b = frame_of(0, {0x01});
  // Unstuffed: 19 header bits and 8 data bits, the last one differs. Before it: 15 zeros (3 stuff
  // bits), DLC 0001, seven zeros (1 stuff bit).
  CHECK(first_difference(a, b).bits == 19 + 8 + 4);
  CHECK(first_difference(a, b).first_is_dominant);
  CHECK_FALSE(first_difference(b, a).first_is_dominant);
  // Other lengths: the DLC differs, 0001 against 0000 in its last bit.
  CHECK(first_difference(a, frame_of(0, {})).bits == 19 + 3);
  CHECK_FALSE(first_difference(a, frame_of(0, {})).first_is_dominant);
}

}  // namespace hoof::hal
