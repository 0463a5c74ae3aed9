// The child process: how it begins, how it ends, what is said where it does not do what it should.
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cerrno>
#include <csignal>
#include <cstdlib>

#include "tests/tools/qemu/qemu_bench.h"
#include "tools/experiment/run_bus.h"

using namespace hoof;
using namespace hoof::tools::qemu;
using Catch::Matchers::Contains;

namespace {

std::vector<std::uint8_t> built_flash() {
  return flash_contents(tools::emulator::read_elf_file(test::image_file()), {});
}

/// Nothing of that id is left, not even unburied.
bool is_gone(pid_t id) {
  return kill(id, 0) != 0 && errno == ESRCH;
}

/// Another PATH while it lives.
class Path {
 public:
  explicit Path(const char* path) : before_(std::getenv("PATH")) { setenv("PATH", path, 1); }
  ~Path() { setenv("PATH", before_.c_str(), 1); }

 private:
  std::string before_;
};

}  // namespace

TEST_CASE("QEMU that is not installed: the package is named before anything is built") {
  const Path nowhere("/nonexistent:/dev");
  CHECK_THROWS_WITH(find_qemu(), Contains("apt-get install qemu-system-arm"));
  tools::RunSettings run = test::rigid_run("sinkage", {"experiment.firmware=\"qemu\""});
  CHECK_THROWS_AS(tools::RunBus(run, {}), tools::UserError);
  run.bus = "vcan0";
  CHECK_THROWS_WITH(tools::RunBus(run, {}), Contains("--firmware qemu") && Contains("--bus"));
}

TEST_CASE("QEMU ends with its owner, and leaves no unburied child") {
  if (!test::qemu_is_here()) return;
  pid_t id = -1;
  {
    QemuLine line(built_flash(), test::kPatience_ns);
    id = line.machine().id();
    CHECK_FALSE(is_gone(id));
    CHECK(line.gone().empty());
  }
  CHECK(is_gone(id));
  // An owner that does not come to its end: killed.
  int ids[2];
  REQUIRE(pipe(ids) == 0);
  const pid_t owner = fork();
  if (owner == 0) {
    const QemuMachine machine(built_flash());
    const pid_t child = machine.id();
    if (write(ids[1], &child, sizeof child) == sizeof child) raise(SIGKILL);
    _exit(1);
  }
  REQUIRE(read(ids[0], &id, sizeof id) == sizeof id);
  int status = 0;
  REQUIRE(waitpid(owner, &status, 0) == owner);
  CHECK(WIFSIGNALED(status));
  for (int i = 0; i < 1000 && !is_gone(id); ++i) usleep(10'000);
  CHECK(is_gone(id));
}

TEST_CASE("QEMU killed in the middle of a run is named with the SYNC it left unanswered") {
  if (!test::qemu_is_here()) return;
  const tools::RunSettings run = test::rigid_run("sinkage");
  const auto experiment = test::rigid_bench(run);
  const auto wires = bridge::in_process_wires([](int, const hal::CanFrame&) {});
  QemuFirmware* node = nullptr;
  const auto maker = test::in_qemu(run)(*wires);
  bridge::LockStep lock_step(
      *experiment,
      [&](hal::CanBus& bus0, hal::CanBus& bus1, const hal::Clock& clock) {
        auto made = maker(bus0, bus1, clock);
        node = dynamic_cast<QemuFirmware*>(made.get());
        return made;
      },
      *wires);
  REQUIRE(node != nullptr);
  for (int tick = 0; tick < 50; ++tick) lock_step.tick();
  CHECK(node->lost().empty());
  REQUIRE(kill(node->machine().id(), SIGKILL) == 0);
  for (int tick = 0; tick < 5; ++tick) lock_step.tick();
  CHECK_THAT(node->lost(), Contains("the image in QEMU ended before it answered SYNC 5"));
  CHECK_THAT(node->lost(), Contains("signal 9"));
}

TEST_CASE("QEMU with an image that says nothing: what did not come is named, and when") {
  if (!test::qemu_is_here()) return;
  constexpr std::int64_t kShort_ns = 3'000'000'000;
  // A loop at the reset vector, for ever.
  std::vector<std::uint8_t> flash(QemuMachine::kFlashBytes, 0xFF);
  const std::vector<std::uint8_t> begin = {0x00, 0x10, 0x00, 0x20, 0x09,
                                           0x00, 0x00, 0x08, 0xFE, 0xE7};
  std::copy(begin.begin(), begin.end(), flash.begin());
  CHECK_THROWS_WITH(QemuLine(flash, kShort_ns), Contains("USART1") && Contains("3000 ms"));
  // ldr r0, [pc, #4]; ldr r1, [pc, #8]; str r1, [r0]; b .; AIRCR, SYSRESETREQ (ARM DDI 0403E).
  const std::vector<std::uint8_t> reset = {0x01, 0x48, 0x02, 0x49, 0x01, 0x60, 0xFE, 0xE7,
                                           0x0C, 0xED, 0x00, 0xE0, 0x04, 0x00, 0xFA, 0x05};
  std::copy(reset.begin(), reset.end(), flash.begin() + 8);
  CHECK_THROWS_WITH(QemuLine(flash, test::kPatience_ns), Contains("the image has reset itself"));
  // Erased flash: the core locks up, QEMU ends and says so.
  flash.assign(flash.size(), 0xFF);
  CHECK_THROWS_WITH(QemuLine(flash, test::kPatience_ns),
                    Contains("qemu-system-arm was ended by signal 6") && Contains("Lockup"));
}

TEST_CASE("an image that does not fit is refused, parameters out of range too") {
  tools::emulator::ElfFile image;
  image.segments.push_back({0x0810'0000 - 3, 0, {1, 2, 3}});
  const auto flash = flash_contents(image, {});
  CHECK(flash[QemuMachine::kFlashBytes - 1] == 3);
  image.segments[0].load_address += 1;
  CHECK_THROWS_WITH(flash_contents(image, {}), Contains("outside the flash"));
  image.segments[0].load_address = 0x07FF'FFFF;
  CHECK_THROWS_WITH(flash_contents(image, {}), Contains("outside the flash"));
  firmware::app::Parameters parameters;
  parameters.control.toe.kp_Nm_rad = -1.0f;
  CHECK_THROWS_AS(flash_contents({}, parameters), std::invalid_argument);
}
