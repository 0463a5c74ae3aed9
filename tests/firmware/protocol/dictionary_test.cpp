#include "firmware/protocol/dictionary.h"

#include <catch2/catch.hpp>
#include <set>
#include <string>

#include "firmware/protocol/messages.h"
#include "firmware/protocol/protocol_hash.h"

using namespace hoof::firmware::protocol;

TEST_CASE("Every identifier fits 11 bits and is used once, in falling order of priority") {
  std::uint32_t previous = 0;
  for (const MessageSpec& message : kMessages) {
    INFO(message.name);
    CHECK(message.id > previous);
    CHECK(message.id < 0x800);
    previous = message.id;
  }
  CHECK(kMessages.front().name == "EmergencyStop");
}

TEST_CASE("Signals of a message lie side by side, fill no bit twice and stay inside the payload") {
  for (const MessageSpec& message : kMessages) {
    int next_bit = 0;
    std::set<std::string_view> names;
    for (const Signal& signal : message.signals) {
      INFO(message.name << '.' << signal.name);
      CHECK(signal.first_bit == next_bit);
      CHECK(signal.length >= 1);
      CHECK(signal.length <= 32);
      CHECK(names.insert(signal.name).second);
      next_bit += signal.length;
    }
    INFO(message.name);
    CHECK(next_bit == 8 * message.length);
  }
}

TEST_CASE("The range of a signal is what its codes reach") {
  for (const MessageSpec& message : kMessages) {
    for (const Signal& signal : message.signals) {
      INFO(message.name << '.' << signal.name);
      const double top = double{signal.offset} + double{signal.scale} * signal.largest_raw();
      CHECK(signal.minimum == signal.offset);
      // Scale and ends are floats: one part in 2^23 of the span each.
      CHECK(top == Approx(signal.maximum).epsilon(3e-7));
    }
  }
}

TEST_CASE("A physical signal has a unit and its name ends in it") {
  for (const MessageSpec& message : kMessages) {
    for (const Signal& signal : message.signals) {
      if (signal.unit.empty()) continue;
      INFO(message.name << '.' << signal.name);
      std::string suffix = "_";
      for (const char c : signal.unit) suffix += c == '/' || c == ' ' ? '_' : c;
      if (suffix == "_degC") suffix = "_C";
      CHECK(std::string(signal.name).ends_with(suffix));
    }
  }
}

TEST_CASE("Messages with a CRC name it as their last byte") {
  for (const MessageSpec& message : kMessages) {
    INFO(message.name);
    const Signal& last = message.signals.back();
    CHECK(message.crc == (last.name == "crc"));
    if (message.crc) CHECK((last.length == 8 && last.first_bit == 8 * message.length - 8));
  }
}

TEST_CASE("Every message and signal says what it is") {
  for (const MessageSpec& message : kMessages) {
    INFO(message.name);
    CHECK_FALSE(message.comment.empty());
    for (const Signal& signal : message.signals) {
      INFO(signal.name);
      CHECK_FALSE(signal.comment.empty());
    }
  }
}

TEST_CASE("Every message can come as often as it is cycled") {
  for (const MessageSpec& message : kMessages) {
    INFO(message.name);
    CHECK(message.shortest_ms >= 1);
    CHECK((message.cycle_ms == 0 || message.shortest_ms <= message.cycle_ms));
    CHECK(message.buses != 0);
  }
}

TEST_CASE("The hash is FNV-1a and is not that of an empty dictionary") {
  detail::Fnv1a hash;
  CHECK(hash.value() == 0x811C9DC5u);  // of nothing, by definition
  hash.add(std::string_view("a"));
  // "a" is 0xE40C292C (reference of the authors); then the closing zero byte.
  CHECK(hash.value() == 0xE40C292Cu * 16777619u);
  CHECK(kProtocolHash != 0x811C9DC5u);
  CHECK(kProtocolHash == compute_protocol_hash());
}
