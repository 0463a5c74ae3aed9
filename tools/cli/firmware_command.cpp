// `hoof firmware update`: the one word after `firmware` that talks to a foot; tools/hoof does the
// others.
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>

#include "hil_bridge/update_client.h"
#include "tools/cli/commands.h"
#include "tools/cli/foot_connection.h"
#include "tools/run/errors.h"

namespace hoof::tools {
namespace {

using bridge::ImageStatus;
using firmware::update::Problem;

struct UpdateOptions {
  FootFlags foot;
  std::string image;
  bool dry_run = false;
  bool status = false;
  bool confirm = false;
};

/// Where `hoof firmware build` puts it: beside the folder of this program.
std::string built_update() {
  const auto program = std::filesystem::read_symlink("/proc/self/exe");
  const auto build = program.parent_path().parent_path().parent_path();
  return (build / "stm32f405" / "hoof-stm32f405.update").string();
}

char slot_name(std::size_t slot) {
  return slot == 0 ? 'A' : 'B';
}

ImageStatus status_of(bridge::UpdateClient& updates) {
  if (const auto status = updates.read_status()) return *status;
  throw CannotFinish(
      "this foot cannot be updated over the bus: it has no slots (the program hoof-firmware), or "
      "was flashed without boot loader; hoof firmware flash writes one");
}

void print(const ImageStatus& status) {
  std::cout << "slot " << slot_name(status.slot) << " runs: version " << status.version
            << (status.on_trial ? status.healthy ? ", on trial, healthy" : ", on trial" : "")
            << "\nslot " << slot_name(1 - status.slot) << ": ";
  if (!status.spare_version) {
    std::cout << "no image\n";
    return;
  }
  std::cout << "version " << *status.spare_version;
  if (status.spare_refusal != Problem::kNone) {
    std::cout << ", refused: " << bridge::text_of(status.spare_refusal);
  }
  std::cout << '\n';
}

/// A line that is redrawn on a terminal, else one for each tenth.
class ProgressLine {
 public:
  void show(std::size_t done, std::size_t all) {
    const std::size_t percent = 100 * done / all;
    if (percent == shown_ || (!terminal_ && percent % 10 != 0)) return;
    shown_ = percent;
    std::fprintf(stderr, "%s%3zu %% of %zu KB%s", terminal_ ? "\r" : "", percent, all * 4 / 1024,
                 !terminal_ || done == all ? "\n" : "");
  }

 private:
  bool terminal_ = isatty(STDERR_FILENO) != 0;
  std::size_t shown_ = SIZE_MAX;
};

void update(const UpdateOptions& options, const bridge::UpdateFile& file,
            bridge::ServiceClient& client) {
  bridge::UpdateClient updates(client);
  const ImageStatus before = status_of(updates);
  const bridge::UpdateImage& image = updates.choose(file, before);
  const std::size_t all = image.words.size() + firmware::update::ImageHeader::kWords;
  std::cout << "version " << before.version << " runs from slot " << slot_name(before.slot)
            << "; version " << image.header.version() << " goes to slot "
            << slot_name(1 - before.slot) << ", " << all * 4 << " bytes, about "
            << (all * 2 + 999) / 1000 << " s" << std::endl;
  if (options.dry_run) {
    std::cout << "dry run: nothing was sent\n";
    return;
  }
  ProgressLine line;
  updates.send(image, [&](std::size_t done, std::size_t words) { line.show(done, words); });
  std::cout << "all there; the foot restarts and looks at the signature" << std::endl;
  updates.start_and_confirm(image);
  std::cout << "version " << image.header.version() << " is healthy and confirmed; version "
            << before.version << " stays in slot " << slot_name(before.slot)
            << " to fall back on\n";
}

void run(const UpdateOptions& options) {
  const bool sends = !options.status && !options.confirm;
  bridge::UpdateFile file;
  try {
    if (sends) {
      file = bridge::read_update_file(options.image.empty() ? built_update() : options.image);
    }
  } catch (const std::runtime_error& error) {
    throw UserError(error.what());
  }
  with_any_foot(options.foot, [&](bridge::ServiceClient& client) {
    if (sends) return update(options, file, client);
    bridge::UpdateClient updates(client);
    const ImageStatus status = status_of(updates);
    if (options.confirm) {
      updates.confirm(status.version);
      std::cout << "version " << status.version << " is confirmed\n";
      return;
    }
    print(status);
  });
}

}  // namespace

void add_firmware_command(CLI::App& app, Invocation& invocation) {
  const auto options = std::make_shared<UpdateOptions>();
  options->foot.timeout_s = 5;  // a slot takes up to two seconds to erase
  CLI::App* firmware = app.add_subcommand(
      "firmware", "The board's image: build, size, flash, emulate, run; update over CAN");
  firmware->require_subcommand(1);
  CLI::App* command = firmware->add_subcommand(
      "update", "Brings a new image to a foot over CAN; the foot must be off");
  add_foot_flags(*command, options->foot);
  command
      ->add_option("--image", options->image,
                   "Update file [the one of the last hoof firmware build]")
      ->type_name("FILE");
  command->add_flag("--dry-run", options->dry_run, "Asks the foot and checks; sends nothing");
  command->add_flag("--status", options->status, "Only shows what its slots hold");
  command->add_flag("--confirm", options->confirm,
                    "Only confirms an image that runs on trial and is healthy");
  command->footer(
      "The image that runs stays until the new one has proved itself, and after: switching the\n"
      "power off at any moment, or Ctrl-C, leaves a foot that starts. Called again it goes on\n"
      "where it was, unless the foot was reset. A new image that is not confirmed within a "
      "minute,\n"
      "or fails three starts, gives way to the former one.\n\n"
      "Examples:\n"
      "  hoof firmware update --bus can0 --dry-run\n"
      "  hoof firmware build --key ~/foot.key --version 2 && hoof firmware update --bus can0\n"
      "  hoof firmware update --bus can0 --image ~/foot-3.update\n"
      "  hoof firmware update --bus can0 --status");
  firmware->footer("Example:\n  hoof firmware update --bus can0");
  command->callback([&invocation, options] { invocation.run = [options] { run(*options); }; });
}

}  // namespace hoof::tools
