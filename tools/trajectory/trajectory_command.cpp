#include "tools/trajectory/trajectory_command.h"

#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tools/trajectory/check.h"
#include "tools/trajectory/random_check.h"
#include "tools/trajectory/solve.h"

namespace hoof::tools {
namespace {

using firmware::trajectory::Interface;
using firmware::trajectory::Synchronisation;
using trajectory::Input;
using trajectory::kMaxJoints;

void end_with(int exit_code) {
  if (exit_code != 0) throw CLI::RuntimeError(exit_code);
}

void add_check(CLI::App& parent) {
  auto path = std::make_shared<std::string>();
  CLI::App* command = parent.add_subcommand("check", "Compare with a file of solved cases");
  command->add_option("CASES", *path, "CSV file, columns as in tests/data/trajectory")
      ->required()
      ->check(CLI::ExistingFile);
  command->footer("Exits 1 when a bar is missed.");
  command->callback([path] { end_with(trajectory::run_trajectory_check(*path, std::cout)); });
}

void add_random(CLI::App& parent) {
  auto options = std::make_shared<trajectory::RandomCheckOptions>();
  CLI::App* command = parent.add_subcommand("random", "Try random problems of every family");
  command->add_option("--count", options->count, "Number of problems")->capture_default_str();
  command->add_option("--seed", options->seed, "Seed; the same seed, the same problems")
      ->capture_default_str();
  command
      ->add_option("--slow-every", options->slow_every,
                   "Every n-th of a family also against the slow check and its twins")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->callback(
      [options] { end_with(trajectory::run_trajectory_random(*options, std::cout)); });
}

struct SolveOptions {
  std::vector<std::string> from, to, limits;
  std::string synchronisation = "time";
  bool velocity = false;
  double minimum_duration_s = 0;
  double duration_step_s = 0;
  std::string svg;
};

std::vector<double> numbers(const std::string& text, const std::string& option) {
  std::vector<double> values;
  for (const std::string& word : CLI::detail::split(text, ',')) {
    double value = 0;
    if (!CLI::detail::lexical_cast(word, value)) {
      throw CLI::ValidationError(option, "not a number: " + word);
    }
    values.push_back(value);
  }
  return values;
}

std::vector<double> state(const std::string& text, const std::string& option) {
  std::vector<double> values = numbers(text, option);
  if (values.empty() || values.size() > 3) {
    throw CLI::ValidationError(option, "takes position,velocity,acceleration");
  }
  values.resize(3, 0.0);
  return values;
}

void set_limits(const std::string& text, int i, Input& input) {
  const std::vector<double> values = numbers(text, "--limits");
  if (values.size() == 3) {
    input.set_limits(i, values[0], values[1], values[2]);
  } else if (values.size() == 5) {
    input.set_limits(i, values[0], values[2], values[4]);
    input.min_velocity[i] = values[1];
    input.min_acceleration[i] = values[3];
  } else {
    throw CLI::ValidationError("--limits",
                               "takes velocity,acceleration,jerk or "
                               "vmax,vmin,amax,amin,jmax (jerk may be inf)");
  }
}

Input input_of(const SolveOptions& options) {
  const std::size_t joints = options.from.size();
  if (options.to.size() != joints || options.limits.size() != joints || joints > kMaxJoints) {
    throw CLI::ValidationError("--from, --to, --limits", "one of each per axis, 8 axes at most");
  }
  const std::map<std::string, Synchronisation> modes{{"none", Synchronisation::kNone},
                                                     {"time", Synchronisation::kTime},
                                                     {"phase", Synchronisation::kPhase}};
  Input input;
  input.joints = static_cast<int>(joints);
  input.interface = options.velocity ? Interface::kVelocity : Interface::kPosition;
  input.synchronisation = modes.at(options.synchronisation);
  input.minimum_duration_s = options.minimum_duration_s;
  input.duration_step_s = options.duration_step_s;
  for (int i = 0; i < input.joints; ++i) {
    const std::vector<double> from = state(options.from[i], "--from");
    const std::vector<double> to = state(options.to[i], "--to");
    input.position[i] = from[0];
    input.velocity[i] = from[1];
    input.acceleration[i] = from[2];
    input.target_position[i] = to[0];
    input.target_velocity[i] = to[1];
    input.target_acceleration[i] = to[2];
    set_limits(options.limits[i], i, input);
  }
  return input;
}

void add_solve(CLI::App& parent) {
  auto options = std::make_shared<SolveOptions>();
  CLI::App* command = parent.add_subcommand("solve", "Solve one problem, print and plot it");
  const auto per_axis = [&](const char* flag, std::vector<std::string>& into, const char* help) {
    command->add_option(flag, into, help)
        ->required()
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  };
  per_axis("--from", options->from, "Start: position,velocity,acceleration (once per axis)");
  per_axis("--to", options->to, "Target: position,velocity,acceleration (once per axis)");
  per_axis("--limits", options->limits,
           "velocity,acceleration,jerk or vmax,vmin,amax,amin,jmax (once per axis)");
  command->add_option("--sync", options->synchronisation, "none, time or phase")
      ->check(CLI::IsMember({"none", "time", "phase"}))
      ->capture_default_str();
  command->add_flag("--velocity", options->velocity, "Velocity target; position is not reached");
  command->add_option("--min-duration-s", options->minimum_duration_s, "Shortest duration allowed");
  command->add_option("--step-s", options->duration_step_s, "Duration is a multiple of this");
  command->add_option("--svg", options->svg, "Write the plot to this file");
  command->footer(
      "Example:\n  hoof trajectory solve --from=0,0.5,0 --to=1 --limits=2,8,60 --svg=move.svg");
  command->callback([options] {
    trajectory::SolveRequest request{input_of(*options), std::nullopt};
    if (!options->svg.empty()) request.svg = options->svg;
    end_with(trajectory::run_trajectory_solve(request, std::cout));
  });
}

}  // namespace

void add_trajectory_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("trajectory", "Check, try and show the trajectory generator");
  command->require_subcommand(1);
  command->footer(
      "Examples:\n"
      "  hoof trajectory check tests/data/trajectory/cases_public.csv\n"
      "  hoof trajectory random --count 10000 --seed 3");
  add_check(*command);
  add_random(*command);
  add_solve(*command);
}

}  // namespace hoof::tools
