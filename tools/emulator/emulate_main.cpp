// The program hoof-emulate (`hoof firmware emulate`): the board's image on a SocketCAN bus by the
// wall's clock, as a flashed board would be there.
#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <optional>

#include "firmware/app/received_ids.h"
#include "firmware/app/storage.h"
#include "firmware/board/host/options.h"
#include "hal/monotonic_clock.h"
#include "hal/socketcan/socketcan_bus.h"
#include "tools/emulator/emulated_firmware.h"
#include "tools/emulator/kept_flash.h"
#include "tools/run/sha256.h"

namespace {

using namespace hoof;
using namespace hoof::tools::emulator;

std::atomic<bool> interrupted{false};

void on_signal(int) {
  interrupted = true;
}

struct EmulateOptions {
  std::string buses;
  std::string image;
  std::string flash;
  std::vector<std::string> settings;  // name=value
  double supply_V = 0;                // 0: nothing is wired
};

/// A board that is later than this behind the wall's clock missed its tick.
constexpr std::int64_t kLate_ns = 1'000'000;
constexpr std::int64_t kLongestSleep_ns = 500'000;

std::string built_image() {
  const auto program = std::filesystem::read_symlink("/proc/self/exe");
  const auto build = program.parent_path().parent_path().parent_path();
  return (build / "stm32f405" / "hoof-stm32f405.elf").string();
}

/// As the service would that stores parameters.
void store_settings(const std::vector<std::string>& settings, hal::Nonvolatile& flash) {
  if (settings.empty()) return;
  firmware::app::Storage storage(flash);
  firmware::app::Parameters parameters;
  storage.load(parameters);
  for (const std::string& setting : settings) {
    const std::string problem = firmware::board::apply_setting(parameters, setting);
    if (!problem.empty()) throw CLI::ValidationError(problem);
  }
  if (storage.store(parameters, firmware::control::Mode::kOff) != firmware::app::StoreResult::kOk) {
    throw std::runtime_error("the parameters cannot be stored in the board's flash");
  }
}

hal::SocketCanSettings connection(const std::string& interface, std::size_t bus) {
  hal::SocketCanSettings settings;
  settings.interface = interface;
  // One interface may carry both buses: each controller sees the frames of its own.
  firmware::app::for_each_received_id(
      bus, [&](std::uint32_t id) { settings.filters.push_back({.id = id, .mask = 0x7FF}); });
  return settings;
}

/// The board's time follows the wall's; it cannot go ahead of it.
class WallClockBoard {
 public:
  WallClockBoard(const ElfFile& image, hal::Nonvolatile& flash, const std::string& bus0,
                 const std::string& bus1, double supply_V)
      : sockets_{hal::SocketCanBus(connection(bus0, 0)), hal::SocketCanBus(connection(bus1, 1))},
        board_(image, flash) {
    board_.set_voltages({.supply_V = supply_V});
    for (std::size_t bus = 0; bus < Board::kBuses; ++bus) {
      board_.connect(bus, wire_of(sockets_[bus]));
    }
    board_.power_on();
    start_ = board_.now();
  }

  void run() {
    const hal::MonotonicClock wall;
    const std::int64_t start_ns = wall.now_ns();
    std::int64_t done_ns = 0;
    while (!interrupted) {
      sockets_[0].wait(kLongestSleep_ns);
      const std::int64_t now_ns = wall.now_ns() - start_ns;
      if (now_ns - done_ns > kLate_ns) ++late_;
      longest_ns_ = std::max(longest_ns_, now_ns - done_ns);
      board_.advance_to(start_ + cycles_of_ns(now_ns));
      done_ns = now_ns;
      if (board_.resets() == resets_) continue;
      resets_ = board_.resets();
      std::cerr << "hoof-emulate: the board was reset (" << resets_ << " since power-on)\n";
    }
    seconds_ = double(done_ns) * 1e-9;
  }

  void report() const {
    std::fprintf(stderr,
                 "hoof-emulate: power off after %.1f s; %llu times more than %lld ms late, at most "
                 "%.2f ms; frames lost by the kernel: %llu\n",
                 seconds_, static_cast<unsigned long long>(late_),
                 static_cast<long long>(kLate_ns / 1'000'000), double(longest_ns_) * 1e-6,
                 static_cast<unsigned long long>(sockets_[0].status().dropped +
                                                 sockets_[1].status().dropped));
  }

 private:
  std::array<hal::SocketCanBus, Board::kBuses> sockets_;
  Board board_;
  Cycles start_ = 0;
  std::uint32_t resets_ = 0;
  std::uint64_t late_ = 0;
  std::int64_t longest_ns_ = 0;
  double seconds_ = 0;
};

/// A flash file that is not there yet is made under another name, and has its own once the image is
/// in it: whoever kills the program before that leaves no board flashed by half.
class NewFlash {
 public:
  explicit NewFlash(const std::string& path)
      : path_(path), is_new_(!path.empty() && !std::filesystem::exists(path)) {
    if (is_new_) std::filesystem::remove(place());
  }
  ~NewFlash() {
    std::error_code ignored;
    if (is_new_) std::filesystem::remove(place(), ignored);
  }
  NewFlash(const NewFlash&) = delete;
  NewFlash& operator=(const NewFlash&) = delete;

  std::string place() const { return is_new_ ? path_ + ".partial" : path_; }
  void flashed() {
    if (is_new_) std::filesystem::rename(place(), path_);
    is_new_ = false;
  }

 private:
  std::string path_;
  bool is_new_;
};

void run(const EmulateOptions& options) {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  const std::string file = options.image.empty() ? built_image() : options.image;
  const ElfFile image = read_elf_file(file);
  hal::RamFlash lost = blank_flash();
  std::optional<KeptFlash> kept;
  NewFlash new_flash(options.flash);
  if (!options.flash.empty()) kept.emplace(new_flash.place());
  hal::Nonvolatile& flash = kept ? static_cast<hal::Nonvolatile&>(*kept) : lost;
  store_settings(options.settings, flash);
  const std::size_t comma = options.buses.find(',');
  const std::string bus0 = options.buses.substr(0, comma);
  WallClockBoard board(image, flash, bus0,
                       comma == std::string::npos ? bus0 : options.buses.substr(comma + 1),
                       options.supply_V);
  new_flash.flashed();
  std::cerr << "hoof-emulate: image sha256 " << tools::sha256_hex_of_file(file) << " runs on "
            << options.buses << "; Ctrl-C takes its power\n";
  board.run();
  board.report();
}

}  // namespace

int main(int argc, char** argv) {
  EmulateOptions options;
  CLI::App app{"The board's image in an emulator, on a CAN bus by the wall's clock",
               "hoof-emulate"};
  app.add_option("--bus", options.buses, "interface of bus 0, or of bus 0 and bus 1: can0,can1")
      ->required();
  app.add_option("--image", options.image, "ELF file [the one of `hoof firmware build`]");
  app.add_option(
      "--flash", options.flash,
      "file with the board's data sectors and image slots, made where missing; holds every word "
      "as it is written, so kill -9 is a power cut; what was updated into it runs in place of "
      "the image [lost at the end]");
  app.add_option("--set", options.settings, "parameter as name=value, stored in its flash first");
  app.add_option("--supply-V", options.supply_V,
                 "voltage at the board's divider; below 36 the foot stops [0: nothing is wired]")
      ->check(CLI::Range(0.0, 60.0));
  app.footer(
      "Examples:\n"
      "  tools/hoof firmware emulate --bus vcan0 --set leg_present=0 --supply-V 48\n"
      "  tools/hoof bridge --bus vcan0 --clock real-time --terrain rigid --experiment sinkage\n"
      "  tools/hoof firmware emulate --bus vcan0 --flash board.flash   then, beside it:\n"
      "  tools/hoof firmware update --bus vcan0 --image foot-2.update");
  try {
    app.parse(argc, argv);
    run(options);
    return 0;
  } catch (const CLI::CallForHelp&) {
    std::cout << app.help();
    return 0;
  } catch (const CLI::ParseError& error) {
    std::cerr << "hoof-emulate: " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "hoof-emulate: " << error.what() << '\n';
    return 3;
  }
}
