// The image on a board of its own, with a test at both of its buses.
#pragma once

#include <catch2/catch.hpp>
#include <deque>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "firmware/protocol/codec.h"
#include "firmware/protocol/protocol_hash.h"
#include "tools/emulator/board.h"

namespace hoof::test {

/// Acknowledges everything and keeps it; sends what the test hands over.
struct TestWire final : tools::emulator::CanWire {
  std::vector<hal::CanFrame>& seen;
  std::deque<hal::CanFrame>& coming;
  std::vector<hal::CanFrame> sent;

  TestWire(std::vector<hal::CanFrame>& s, std::deque<hal::CanFrame>& c) : seen(s), coming(c) {}
  bool offer(const hal::CanFrame& frame) override {
    seen.push_back(frame);
    sent.push_back(frame);
    return true;
  }
  bool withdraw(const hal::CanFrame&) override { return false; }
  bool take(hal::CanFrame& frame) override {
    if (coming.empty()) return false;
    frame = coming.front();
    coming.pop_front();
    return true;
  }
  std::vector<hal::CanFrame> take_sent() override { return std::exchange(sent, {}); }
  hal::BusStatus status() const override { return {}; }
  void join_again() override {}
};

struct BoardBench {
  hal::RamFlash flash = tools::emulator::blank_flash();
  std::vector<hal::CanFrame> seen[2];
  std::deque<hal::CanFrame> coming[2];
  tools::emulator::Board board{tools::emulator::read_elf_file(HOOF_BOARD_IMAGE), flash};
  std::uint32_t tick = 0;
  std::uint8_t counter = 0;  // of the next order

  BoardBench() {
    for (std::size_t bus = 0; bus < 2; ++bus) {
      board.connect(bus, std::make_unique<TestWire>(seen[bus], coming[bus]));
    }
  }
  void run_ms(int ms) {
    for (int i = 0; i < ms; ++i) {
      board.advance_to(board.now() + tools::emulator::kCyclesPerMillisecond);
    }
  }
  /// A SYNC at the begin of each millisecond.
  void run_ticks(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      coming[0].push_back(encode(firmware::protocol::Sync{tick++}));
      run_ms(1);
    }
  }

  /// The last one of these that was seen on bus 0.
  template <typename Message>
  std::optional<Message> last() const {
    for (auto frame = seen[0].rbegin(); frame != seen[0].rend(); ++frame) {
      Message message;
      if (decode(*frame, message) == firmware::protocol::DecodeResult::kOk) return message;
    }
    return std::nullopt;
  }
  std::optional<firmware::protocol::Heartbeat> heartbeat() const {
    return last<firmware::protocol::Heartbeat>();
  }

  /// As a supervisor gives it: connected first.
  firmware::protocol::OrderResult order(firmware::protocol::Order what) {
    using namespace firmware::protocol;
    coming[0].push_back(encode(SupervisorConnect{1, kProtocolHash, 0}));
    run_ticks(20);
    coming[0].push_back(encode(SupervisorOrder{1, what, 0.0f, 0.0f, counter}));
    run_ticks(20);
    const auto answer = last<OrderAcknowledge>();
    REQUIRE(answer);
    counter = answer->expected_counter;
    return answer->result;
  }

  std::uint32_t word(std::uint32_t address) {
    std::uint32_t value = 0;
    REQUIRE(board.cpu().read_memory(address, &value, 4));
    return value;
  }
  /// Replaces the instruction behind the sleep in the main loop. @return what was there
  std::uint16_t replace_after_sleep(std::uint16_t instruction) {
    const std::uint32_t pc = board.cpu().registers().pc & ~1u;
    std::uint16_t former = 0;
    REQUIRE(board.cpu().read_memory(pc, &former, 2));
    REQUIRE(board.cpu().write_memory(pc, &instruction, 2));
    return former;
  }
};

inline constexpr std::uint32_t kCrashRecord = 0x2000'1000, kCrashMagic = 0x4846'4352;

}  // namespace hoof::test
