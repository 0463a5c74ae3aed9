#include <filesystem>
#include <iostream>
#include <memory>
#include <sstream>

#include "tools/cli/commands.h"
#include "tools/log/cut.h"
#include "tools/log/decoded_frame.h"
#include "tools/log/export.h"
#include "tools/log/log_info.h"
#include "tools/log/log_plot.h"
#include "tools/log/spy.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

namespace hoof::tools {
namespace {

namespace fs = std::filesystem;

struct LogOptions {
  fs::path recording;
  fs::path
      out;  // empty: standard output, or a name made from the recording's; "-": standard output
  bool force = false;
  std::string to;
  std::vector<std::string> signals;
  CutRange range;
};

void add_recording(CLI::App& command, LogOptions& options) {
  command.add_option("RUN", options.recording, "Folder of a run, or a log as candump -L writes it")
      ->required();
}

void add_out(CLI::App& command, LogOptions& options, const std::string& otherwise) {
  command.add_option("--out", options.out, "File to write; - for standard output; " + otherwise)
      ->type_name("FILE");
  command.add_flag("--force", options.force, "Replace the file");
}

fs::path checked(const fs::path& out, const LogOptions& options) {
  if (fs::exists(out) && !options.force) {
    throw UserError("--out " + out.string() + ": exists; --force replaces it");
  }
  return out;
}

void write_text(const std::string& text, const LogOptions& options) {
  if (options.out.empty() || options.out == "-") {
    std::cout << text << std::flush;
    return;
  }
  write_file(checked(options.out, options), text);
  std::cout << options.out.string() << "\n";
}

void convert(const LogOptions& options) {
  const BusRecording recording = read_bus_log(options.recording);
  for (const std::string& note : recording.notes) std::cerr << "hoof: " << note << "\n";
  if (options.to == "mcap") {
    if (options.out == "-") throw UserError("--out -: MCAP needs a file");
    const fs::path out = checked(
        options.out.empty() ? fs::path(recording.path).replace_extension(".mcap") : options.out,
        options);
    const fs::path folder = recording.path.parent_path();
    const bool of_run = recording.path.filename() == "bus.log";
    const std::uint64_t count = export_mcap(recording, of_run ? folder : fs::path(), out);
    std::cout << out.string() << ": " << count << " messages\n";
    return;
  }
  std::ostringstream text;
  if (options.to == "csv") {
    require_known_signals(options.signals);
    export_csv(recording, options.signals, text);
  } else if (options.to == "json") {
    export_json(recording, text);
  } else {
    export_candump(recording, text);
  }
  write_text(text.str(), options);
}

void add_info(CLI::App& log, Invocation& invocation) {
  auto options = std::make_shared<LogOptions>();
  CLI::App* command = log.add_subcommand("info", "Times, messages, rates, gaps, load, faults");
  add_recording(*command, *options);
  command->footer("Example:\n  hoof log info runs/sinkage-2026-01-31-1");
  command->callback([&invocation, options] {
    invocation.run = [options] { print_info(read_bus_log(options->recording), std::cout); };
  });
}

void add_convert(CLI::App& log, Invocation& invocation) {
  auto options = std::make_shared<LogOptions>();
  CLI::App* command = log.add_subcommand("convert", "Write it as MCAP, CSV, JSON lines or candump");
  add_recording(*command, *options);
  command->add_option("--to", options->to, "mcap, csv, json or candump")
      ->required()
      ->check(CLI::IsMember({"mcap", "csv", "json", "candump"}));
  command
      ->add_option("--signal", options->signals,
                   "For csv: only these, Message.signal, * for any characters")
      ->allow_extra_args(false);
  add_out(*command, *options, "without it MCAP goes beside the log, text to standard output");
  command->footer(
      "Examples:\n"
      "  hoof log convert runs/sinkage-2026-01-31-1 --to mcap    for PlotJuggler and Foxglove\n"
      "  hoof log convert runs/sinkage-2026-01-31-1 --to csv --signal 'ToeReply.*' --out toe.csv\n"
      "  hoof log convert candump-2026.log --to json | head");
  command->callback([&invocation, options] { invocation.run = [options] { convert(*options); }; });
}

void add_cut(CLI::App& log, Invocation& invocation) {
  auto options = std::make_shared<LogOptions>();
  CLI::App* command = log.add_subcommand("cut", "A part of it, as candump lines");
  add_recording(*command, *options);
  command->add_option("--from", options->range.from_s, "Seconds since the recording's time 0");
  command->add_option("--to", options->range.to_s, "Seconds; this moment is not included");
  command->add_option("--from-tick", options->range.from_tick, "Control tick of the first SYNC");
  command->add_option("--to-tick", options->range.to_tick, "Last control tick, included");
  add_out(*command, *options, "without it, standard output");
  command->footer(
      "Examples:\n"
      "  hoof log cut runs/sinkage-2026-01-31-1 --from 0.5 --to 0.8 --out part.log\n"
      "  hoof log cut runs/sinkage-2026-01-31-1 --from-tick 800 --to-tick 820");
  command->callback([&invocation, options] {
    invocation.run = [options] {
      std::ostringstream text;
      export_candump(cut(read_bus_log(options->recording), options->range), text);
      write_text(text.str(), *options);
    };
  });
}

void add_plot(CLI::App& log, Invocation& invocation) {
  auto options = std::make_shared<LogOptions>();
  CLI::App* command = log.add_subcommand("plot", "Signals against time, as a page or a drawing");
  add_recording(*command, *options);
  command->add_option("--signal", options->signals, "Message.signal, * for any characters")
      ->required()
      ->allow_extra_args(false);
  command->add_option("--out", options->out, "FILE.html: a page of its own; FILE.svg: a drawing")
      ->required()
      ->type_name("FILE");
  command->add_flag("--force", options->force, "Replace the file");
  command->footer(
      "Examples:\n"
      "  hoof log plot runs/sinkage-2026-01-31-1 --signal 'ToeReply.*' --out toe.html\n"
      "  hoof log plot runs/sinkage-2026-01-31-1 --signal '*.torque_Nm' --out torque.svg");
  command->callback([&invocation, options] {
    invocation.run = [options] {
      const std::string kind = options->out.extension().string();
      if (kind != ".html" && kind != ".svg") {
        throw UserError("--out " + options->out.string() + ": must end in .html or .svg");
      }
      const BusRecording recording = read_bus_log(options->recording);
      write_text(kind == ".svg" ? plot_svg(recording, options->signals)
                                : plot_page(recording, options->signals),
                 *options);
    };
  });
}

void add_spy(CLI::App& log, Invocation& invocation) {
  auto request = std::make_shared<SpyRequest>();
  CLI::App* command =
      log.add_subcommand("spy", "Live view of a bus, of LCM channels, or of a log being written");
  auto* file = command->add_option("RUN", request->recording, "A log, or the folder of a run");
  auto* bus = command->add_option("--bus", request->bus, "SocketCAN interfaces: vcan0, can0,can1");
  bus->excludes(file);
  command
      ->add_option("--lcm", request->lcm,
                   "LCM channels instead, of this address or of LCM_DEFAULT_URL")
      ->expected(0, 1)
      ->type_name("[URL]")
      ->excludes(file)
      ->excludes(bus);
  command->add_flag("--once", request->once, "Print what is there and end");
  command->footer(
      "Examples:\n"
      "  hoof log spy --bus vcan0\n"
      "  hoof log spy runs/.sinkage-2026-01-31-1.partial/bus.log    a run under way\n"
      "Keys: up and down or j and k choose a message, q quits.");
  command->callback([&invocation, request] {
    if (request->bus.empty() && !request->lcm && request->recording.empty()) {
      throw CLI::ValidationError("give --bus, --lcm, or a log");
    }
    invocation.run = [request] { spy(*request); };
  });
}

}  // namespace

void add_log_command(CLI::App& app, Invocation& invocation) {
  CLI::App* log = app.add_subcommand("log", "Look into a recording of the bus");
  log->require_subcommand(1);
  log->footer(
      "Examples:\n"
      "  hoof log info runs/sinkage-2026-01-31-1\n"
      "  hoof log convert runs/sinkage-2026-01-31-1 --to mcap\n"
      "  hoof log spy --bus vcan0");
  add_info(*log, invocation);
  add_convert(*log, invocation);
  add_cut(*log, invocation);
  add_plot(*log, invocation);
  add_spy(*log, invocation);
}

}  // namespace hoof::tools
