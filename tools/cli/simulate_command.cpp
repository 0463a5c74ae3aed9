#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>

#include "tools/cli/commands.h"
#include "tools/diagnose/answer_folder.h"
#include "tools/diagnose/answer_tables.h"
#include "tools/diagnose/effects_file.h"
#include "tools/diagnose/simulate_rig.h"
#include "tools/diagnose/verdict_text.h"
#include "tools/run/result_json.h"

namespace hoof::tools {
namespace {

namespace fs = std::filesystem;

constexpr char kResultFile[] = "result.json";

struct SimulateRequest {
  fs::path data_set, effects, out;
  bool force = false;
};

void print_row(const std::string& name, const std::string& role, const std::string& channel,
               double rmse, RigKind rig) {
  const std::string shown = with_unit(rmse, channel_unit(rig, channel));
  std::printf("%-32s %-8s %-16s %s\n", name.c_str(), role.c_str(), channel.c_str(), shown.c_str());
}

void print_table(const Simulation& simulation, RigKind rig) {
  std::printf("%-32s %-8s %-16s %s\n", "recording", "role", "channel", "rmse");
  for (const SimulatedRecording& done : simulation.recordings) {
    for (std::size_t c = 0; c < done.channels.size(); ++c) {
      print_row(done.recording->name, done.recording->holdout ? "holdout" : "fit", done.channels[c],
                done.rmse[c], rig);
    }
  }
  for (const auto& [channel, rmse] : simulation.fit) print_row("all", "fit", channel, rmse, rig);
  for (const auto& [channel, rmse] : simulation.holdout) {
    print_row("all", "holdout", channel, rmse, rig);
  }
}

void run(const SimulateRequest& request) {
  const std::vector<DataSet> sets = {read_data_set(request.data_set)};
  EffectsFile effects;
  if (!request.effects.empty()) effects = read_effects_file(request.effects);
  const std::unique_ptr<RigModel> model = make_rig_model(sets);
  AnswerFolder folder(request.out, kResultFile, request.force);
  const Simulation simulation = simulate_rig(*model, effects);
  for (const std::string& name : simulation.unused_setup) {
    std::cerr << request.effects.string() << ": setup." << name
              << " is not used: the data set does not say that it is in doubt\n";
  }
  const std::vector<std::string> files = prediction_file_names(simulation);
  for (std::size_t r = 0; r < files.size(); ++r) {
    const SimulatedRecording& done = simulation.recordings[r];
    folder.write(files[r], prediction_csv(*done.recording, done.channels, done.prediction));
  }
  folder.write(kResultFile, result_json_text(simulation_json(simulation)));
  folder.commit();
  print_table(simulation, sets.front().rig);
  std::printf("%s\n", request.out.c_str());
}

}  // namespace

void add_simulate_command(CLI::App& app, Invocation& invocation) {
  auto request = std::make_shared<SimulateRequest>();
  CLI::App* command = app.add_subcommand("simulate", "The model of a data set, without any search");
  command->add_option("DATASET", request->data_set, "Data set: the same file as for hoof diagnose")
      ->required()
      ->type_name("DATASET.toml");
  command
      ->add_option("--effects", request->effects,
                   "Refitted setup and effects: improved.toml of hoof diagnose")
      ->type_name("FILE.toml");
  command->add_option("--out", request->out, "Folder for the predicted channels")
      ->required()
      ->type_name("DIR");
  command->add_flag("--force", request->force, "Replace an earlier simulation in DIR");
  command->footer(
      "Writes a CSV file per recording, predicted beside measured, and result.json with the rmse.\n"
      "Each recording is rolled out from its first sample by its recorded inputs alone.\n"
      "Examples:\n"
      "  hoof simulate tests/data/diagnose/servo_pendulum_xl330/dataset.toml --out runs/nominal\n"
      "  hoof simulate sand.toml --effects runs/press/improved.toml --out runs/press-improved");
  command->callback([&invocation, request] { invocation.run = [request] { run(*request); }; });
}

}  // namespace hoof::tools
