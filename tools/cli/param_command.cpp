#include <iostream>
#include <memory>

#include "hal/monotonic_clock.h"
#include "hal/socketcan/socketcan_bus.h"
#include "tools/cli/commands.h"
#include "tools/cli/foot_connection.h"
#include "tools/cli/param.h"
#include "tools/run/errors.h"

namespace hoof::tools {
namespace {

struct ParamOptions {
  FootFlags foot;
  std::vector<std::string> names;
  std::vector<std::string> assignments;
  std::string joint;
  bool store = false;
};

using Options = std::shared_ptr<ParamOptions>;
using Work = std::function<void(bridge::ServiceClient&)>;

void store(bridge::ServiceClient& client) {
  std::cout << "stored; this is set " << client.store_parameters() << '\n';
}

/// A sub-command that needs a foot on a bus.
CLI::App* add(CLI::App& parent, const char* name, const char* help, const Options& options) {
  CLI::App* command = parent.add_subcommand(name, help);
  add_foot_flags(*command, options->foot);
  return command;
}

void arrange(CLI::App* command, Invocation& invocation, const Options& options, Work work) {
  command->callback([&invocation, options, work] {
    invocation.run = [options, work] { with_foot(options->foot, work); };
  });
}

void add_list(CLI::App& parent, Invocation& invocation, const Options& options) {
  CLI::App* command = parent.add_subcommand("list", "All parameters: range, default, meaning");
  add_foot_flags(*command, options->foot)->required(false);
  command->callback([&invocation, options] {
    invocation.run = [options] {
      if (options->foot.bus.empty()) return list_parameters(nullptr, std::cout);
      with_foot(options->foot, [](bridge::ServiceClient& c) { list_parameters(&c, std::cout); });
    };
  });
}

void add_get(CLI::App& parent, Invocation& invocation, const Options& options) {
  CLI::App* command = add(parent, "get", "Values of some", options);
  command->add_option("NAME", options->names, "As in hoof param list")->required();
  arrange(command, invocation, options, [options](bridge::ServiceClient& client) {
    get_parameters(client, options->names, std::cout);
  });
}

void add_set(CLI::App& parent, Invocation& invocation, const Options& options) {
  CLI::App* command = add(parent, "set", "Change some; the foot must be off", options);
  command->add_option("NAME=VALUE", options->assignments, "In the unit of the name")->required();
  command->add_flag("--store", options->store, "Keep them without power, too");
  command->callback([&invocation, options] {
    invocation.run = [options] {
      const auto assignments = parse_assignments(options->assignments);
      with_foot(options->foot, [&](bridge::ServiceClient& client) {
        set_parameters(client, assignments, std::cout);
        if (options->store) store(client);
      });
    };
  });
}

void add_calibrate(CLI::App& parent, Invocation& invocation, const Options& options) {
  CLI::App* command =
      add(parent, "calibrate", "The joint stands at its mark now: find its zero", options);
  command->add_option("JOINT", options->joint, "toe, hip or knee")
      ->required()
      ->check(CLI::IsMember({"toe", "hip", "knee"}));
  command->add_flag("--store", options->store, "Keep it without power, too");
  arrange(command, invocation, options, [options](bridge::ServiceClient& client) {
    calibrate_joint(client, options->joint, std::cout);
    if (options->store) store(client);
  });
}

}  // namespace

void add_param_command(CLI::App& app, Invocation& invocation) {
  const auto options = std::make_shared<ParamOptions>();
  CLI::App* command = app.add_subcommand("param", "Parameters of a foot on a CAN bus");
  command->require_subcommand(1);
  add_list(*command, invocation, options);
  add_get(*command, invocation, options);
  add_set(*command, invocation, options);
  add_calibrate(*command, invocation, options);
  arrange(add(*command, "store", "Keep the present ones without power", options), invocation,
          options, store);
  arrange(add(*command, "defaults", "All back to their defaults; stored only by store", options),
          invocation, options, [](bridge::ServiceClient& client) {
            client.default_parameters();
            std::cout << "all at their defaults; no joint is calibrated\n";
          });
  command->footer(
      "Examples:\n"
      "  hoof param list\n"
      "  hoof param list --bus can0\n"
      "  hoof param set toe_kp_Nm_rad=200 toe_kd_Nm_s_rad=2 --bus can0 --store\n"
      "  hoof param set hip_mark_rad=0 --bus can0; hoof param calibrate hip --bus can0 --store");
}

}  // namespace hoof::tools
