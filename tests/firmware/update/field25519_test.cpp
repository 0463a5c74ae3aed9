// The field against itself: laws that hold for any numbers, at the numbers where carries happen.
#include "firmware/update/field25519.h"

#include <catch2/catch.hpp>
#include <random>
#include <vector>

using namespace hoof::firmware::update;

namespace {

constexpr std::uint32_t kOnes = 0xFFFF'FFFF;

/// 2^255 - 19, 2^256 - 38 and what is next to them, all ones, and small numbers.
std::vector<Field> edges() {
  std::vector<Field> list;
  for (const std::uint32_t low : {0xFFFF'FFECu, 0xFFFF'FFEDu, 0xFFFF'FFEEu, kOnes}) {
    list.push_back({{low, kOnes, kOnes, kOnes, kOnes, kOnes, kOnes, 0x7FFF'FFFF}});
  }
  for (const std::uint32_t low : {0xFFFF'FFD9u, 0xFFFF'FFDAu, 0xFFFF'FFDBu, kOnes}) {
    list.push_back({{low, kOnes, kOnes, kOnes, kOnes, kOnes, kOnes, kOnes}});
  }
  for (const std::uint32_t small : {0u, 1u, 2u, 18u, 19u, 37u, 38u, 39u}) list.push_back({{small}});
  list.push_back({{0, 0, 0, 0, 0, 0, 0, 0x8000'0000}});
  return list;
}

std::vector<Field> numbers() {
  std::vector<Field> list = edges();
  std::mt19937 random(3);
  for (int i = 0; i < 12; ++i) {
    Field f;
    for (auto& w : f.word) w = random() % 4 == 0 ? kOnes : std::uint32_t(random());
    list.push_back(f);
  }
  return list;
}

}  // namespace

TEST_CASE("field: edges have the remainders that they have") {
  const auto e = edges();
  const auto small = [](std::uint32_t n) { return Field{{n}}.word; };
  CHECK(e[0].canonical().word == e[0].word);  // p - 1
  CHECK(e[1].canonical().word == small(0));   // p
  CHECK(e[2].canonical().word == small(1));
  CHECK(e[3].canonical().word == small(18));  // 2^255 - 1
  CHECK(e[4].canonical().word == e[0].word);  // 2p - 1
  CHECK(e[5].canonical().word == small(0));   // 2p
  CHECK(e[6].canonical().word == small(1));
  CHECK(e[7].canonical().word == small(37));      // 2^256 - 1
  CHECK(e.back().canonical().word == small(19));  // 2^255
  CHECK(e[1].is_zero());
  CHECK_FALSE(e[0].is_zero());
  CHECK((e[0] * e[0]).canonical().word == small(1));  // (-1)^2
  CHECK((e[7] * e[7]).canonical().word == small(37 * 37));
  CHECK((e[7] + e[7]).canonical().word == small(74));
  CHECK((Field{} - e[2]).canonical().word == e[0].word);
}

TEST_CASE("field: sums and products commute and distribute, differences undo sums") {
  const auto list = numbers();
  for (std::size_t i = 0; i < list.size(); ++i) {
    for (std::size_t j = 0; j < list.size(); ++j) {
      const Field &a = list[i], &b = list[j], &c = list[(i + j) % list.size()];
      CAPTURE(i, j);
      REQUIRE(a + b == b + a);
      REQUIRE(a * b == b * a);
      REQUIRE((a + b) - b == a);
      REQUIRE((a - b) + b == a);
      REQUIRE(a * (b + c) == a * b + a * c);
      REQUIRE(a * (b - c) == a * b - a * c);
    }
  }
}

TEST_CASE("field: a number times its inverse is 1, and the power for roots is that") {
  for (const Field& a : numbers()) {
    if (a.is_zero()) {
      CHECK(inverse(a).is_zero());
      continue;
    }
    CHECK(a * inverse(a) == Field{{1}});
    // (a^(2^252 - 3))^8 a^4 = a^(2^255 - 20) = 1 (Fermat)
    const Field r = power_for_root(a), r2 = r * r, r4 = r2 * r2, a2 = a * a;
    CHECK(r4 * r4 * a2 * a2 == Field{{1}});
  }
}
