#include "tools/cli/engine_options.h"

namespace hoof::tools {

void add_ground_options(CLI::App& command, Ground& ground) {
  command
      .add_option("--scale", ground.scale, "Bed: demo (coarse grains), medium, bench, paper [demo]")
      ->type_name("BED")
      ->check(CLI::IsMember({"demo", "medium", "bench", "paper"}).description(""));
  command
      .add_option("--terrain", ground.terrain,
                  "dem, or rft or rigid: quick looks that say nothing about sand [dem]")
      ->type_name("NAME")
      ->check(CLI::IsMember({"dem", "rft", "rigid"}).description(""));
}

void add_engine_options(CLI::App& command, Engine& engine) {
  command
      .add_option("--jobs", engine.jobs,
                  "Runs at once on this machine, 1..256 [cores over --threads]; the bytes are the "
                  "same")
      ->type_name("N")
      ->check(CLI::Range(1, 256));
  command
      .add_option("--threads", engine.threads,
                  "Threads of each run's sand solver, 1..1024 [1, or cores over --jobs]; more runs "
                  "at once beat more threads")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  command
      .add_option_function<std::string>(
          "--engine", [&engine](const std::string& name) { engine.slurm = name == "slurm"; },
          "local, or slurm: array jobs of a cluster [local]")
      ->type_name("NAME")
      ->check(CLI::IsMember({"local", "slurm"}).description(""));
  SlurmSettings& slurm = engine.cluster;
  command.add_option("--at-once", slurm.at_once, "Slurm: tasks of an array at once [no limit]")
      ->type_name("N")
      ->check(CLI::Range(1, 100000));
  command.add_option("--time", slurm.time, "Slurm: limit of a task, as of sbatch [partition's]")
      ->type_name("TIME");
  command
      .add_option("--stop-ahead", slurm.stop_ahead_s,
                  "Slurm: stop with a checkpoint so long before the limit [120]")
      ->type_name("S")
      ->check(CLI::Range(10, 65535));
  command
      .add_option("--sbatch", slurm.options,
                  "Slurm: one more option, e.g. --sbatch=--partition=fat")
      ->type_name("OPTION")
      ->allow_extra_args(false);
  command.add_flag("--wait", slurm.wait,
                   "Slurm: stay, and submit again what is stopped or lost, until all is done");
  command.add_option("--poll", slurm.poll_s, "Slurm: between looks of --wait [10]")
      ->type_name("S")
      ->check(CLI::Range(0.1, 3600.0));
}

}  // namespace hoof::tools
