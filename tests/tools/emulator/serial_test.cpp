// The image in lock-step by its serial lines, nothing but silence on CAN: the same commands.
#include <catch2/catch.hpp>

#include "hal/lock_step_frame.h"
#include "hal/slcan/line.h"
#include "tests/tools/emulator/image_bench.h"

using namespace hoof;
using test::RunRecord;
using tools::emulator::Board;

namespace {

/// Frames of a bus to lines of text and back, between a run and the image.
class ImageBySerial final : public bridge::FirmwareNode {
 public:
  ImageBySerial(const firmware::app::Parameters& parameters, hal::CanBus& bus0, hal::CanBus& bus1,
                const hal::Clock& clock)
      : flash_(tools::emulator::flash_with(parameters)),
        board_(tools::emulator::read_elf_file(test::image_file()), flash_),
        buses_{&bus0, &bus1},
        clock_(clock) {
    start_ = tools::emulator::run_to_start(board_);
    for (std::size_t bus = 0; bus < Board::kBuses; ++bus) board_.hear(bus, "O\r");
  }

  void poll(std::uint32_t) override {
    board_.advance_to(start_ + tools::emulator::cycles_of_ns(clock_.now_ns()));
    for (std::size_t bus = 0; bus < Board::kBuses; ++bus) {
      hal::CanFrame frame;
      while (buses_[bus]->receive(frame)) {
        const hal::slcan::Line line = hal::slcan::line_of(frame);
        REQUIRE(line.length > 0);
        board_.hear(bus, {line.text.begin(), line.text.begin() + std::ptrdiff_t(line.length)});
      }
    }
    for (std::size_t bus = 0; bus < Board::kBuses; ++bus) pass_on(bus);
  }
  const firmware::app::Telemetry& telemetry() const override { return none_; }

 private:
  void pass_on(std::size_t bus) {
    said_[bus] += board_.take_said(bus);
    std::size_t end;
    while ((end = said_[bus].find_first_of("\r\a")) != std::string::npos) {
      CHECK(said_[bus][end] != '\a');
      const auto* text = reinterpret_cast<const std::uint8_t*>(said_[bus].data());
      hal::CanFrame frame;
      if (hal::slcan::frame_of({text, end}, frame)) {
        REQUIRE(buses_[bus]->send(frame) == hal::SendResult::kQueued);
      }
      said_[bus].erase(0, end + 1);
    }
  }

  hal::RamFlash flash_;
  Board board_;
  std::array<hal::CanBus*, Board::kBuses> buses_;
  const hal::Clock& clock_;
  std::array<std::string, Board::kBuses> said_;
  firmware::app::Telemetry none_;
  tools::emulator::Cycles start_ = 0;
};

test::FirmwareOn by_serial(const tools::RunSettings& run) {
  return [&run](bridge::Wires&) {
    return [&run](hal::CanBus& bus0, hal::CanBus& bus1, const hal::Clock& clock) {
      return std::make_unique<ImageBySerial>(run.parameters, bus0, bus1, clock);
    };
  };
}

std::vector<hal::CanFrame> commands(const RunRecord& record, int bus) {
  std::vector<hal::CanFrame> found;
  for (const test::SeenFrame& s : record.frames) {
    if (s.bus == bus && test::is_command(s.frame)) found.push_back(s.frame);
  }
  return found;
}

}  // namespace

TEST_CASE("serial lines: sinkage and traction, the commands are those of the loop in process") {
  const std::string kind = GENERATE("sinkage", "traction");
  constexpr std::uint32_t kTicks = 1000;
  const tools::RunSettings run = test::rigid_run(kind);
  const RunRecord host = test::record_run(run, test::host(run), kTicks);
  const RunRecord image = test::record_run(run, by_serial(run), kTicks);
  for (const int bus : {0, 1}) {
    CAPTURE(kind, bus);
    const auto a = commands(host, bus), b = commands(image, bus);
    // Sinkage moves the toes alone, on bus 0; traction all three joints.
    if (bus == 0 || kind == "traction") CHECK(a.size() > kTicks / 2);
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      CAPTURE(i);
      REQUIRE(a[i] == b[i]);
    }
  }
}

TEST_CASE("serial lines: a part that has clocks of its own takes no time from outside") {
  namespace lock_step = hal::lock_step;
  const bool crystal_dead = GENERATE(false, true);  // then CAN is off, too
  const bool pll_dead = crystal_dead && GENERATE(false, true);
  CAPTURE(crystal_dead, pll_dead);
  hal::RamFlash flash = tools::emulator::flash_with({});
  Board board(tools::emulator::read_elf_file(test::image_file()), flash);
  board.set_clock_faults({.crystal_dead = crystal_dead, .pll_dead = pll_dead});
  board.power_on();
  const auto tell = [&board](const hal::CanFrame& frame) {
    const hal::slcan::Line line = hal::slcan::line_of(frame);
    board.hear(0, {line.text.begin(), line.text.begin() + std::ptrdiff_t(line.length)});
  };
  const auto run_ms = [&board](int ms) {
    for (int i = 0; i < ms; ++i) board.advance_to(board.next_tick());
  };
  run_ms(20);
  board.hear(0, "O\r");
  board.take_said(0);
  tell(lock_step::begin());
  tell(encode(lock_step::Go{.time_ns = 60'000'000'000}));
  run_ms(1000);
  const std::string said = board.take_said(0);
  CHECK(said.find("T") == std::string::npos);  // no Done, which has a 29-bit identifier
  std::size_t beats = 0;
  for (std::size_t at = 0; (at = said.find("t050", at)) != std::string::npos; ++at) ++beats;
  CHECK(beats >= 10);  // every 100 ms of its own, and where it changed sooner
  CHECK(beats <= 11);
  CHECK(board.resets() == 0);
}
