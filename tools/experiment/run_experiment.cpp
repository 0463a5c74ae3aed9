#include "tools/experiment/run_experiment.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <optional>
#include <system_error>

#include "hil_bridge/session.h"
#include "tools/experiment/bench.h"
#include "tools/experiment/recorder.h"
#include "tools/experiment/resume_folder.h"
#include "tools/experiment/run_fields.h"
#include "tools/experiment/section_view.h"
#include "tools/experiment/summary.h"
#include "tools/report/report.h"
#include "tools/run/csv_writer.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"
#include "tools/run/progress_line.h"
#include "tools/run/result_json.h"
#include "tools/run/run_folder.h"
#include "tools/run/stop_request.h"

namespace hoof::tools {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string moment(const sim::Observation& o) {
  char text[80];
  std::snprintf(text, sizeof text, "%s, t = %.3f s, depth %.1f mm", sim::to_string(o.phase),
                o.time_s, o.depth_m * 1e3);
  return text;
}

/// Where a run grows and where it keeps what it takes to resume it.
struct Places {
  std::unique_ptr<RunFolder> run;
  std::unique_ptr<ResumeFolder> resume;  // null where it cannot be resumed
};

Places new_places(const RunSettings& run, const RunOutput& output) {
  for (;;) {
    Places places;
    places.run = std::make_unique<RunFolder>(RunFolderOptions{run.kind, output.out, output.force});
    const std::filesystem::path path = places.run->final_path();
    places.resume = ResumeFolder::begin(path, run.kind, run.tree.to_toml(), output.force);
    if (places.resume) {
      // Without grains a run is done sooner than resumed.
      // The folder of a run that can be resumed tells all of it.
      if (!run.on_grains() || output.checkpoint_every_s == 0 || run.concealed) {
        places.resume.reset();
      }
      return places;
    }
    if (!output.out.empty()) {
      throw UserError("--out " + path.string() + ": another run of this name is under way");
    }
    // Another run was given this default name at the same moment; there is a next one.
  }
}

/// As it may be known: a concealed run's settings are those of the nominal plant.
const sim::Settings& shown_settings(const RunSettings& run) {
  return run.concealed ? run.declared : run.tree;
}

void write_truth(const RunSettings& run, const RunOutput& output) {
  const bool told = std::any_of(
      run.declared.entries().begin(), run.declared.entries().end(), [](const auto& entry) {
        return entry.first.starts_with("effects.") || entry.first.starts_with("setup.");
      });
  if (told) {
    throw UserError(
        "--conceal: the settings themselves tell effects; only those of --effects FILE "
        "can be withheld");
  }
  if (std::filesystem::exists(output.truth) && !output.force) {
    throw UserError("--conceal " + output.truth.string() + ": exists; --force replaces it");
  }
  write_file(output.truth,
             effects_toml(run, "Withheld from the folder of a " + run.kind + " run."));
}

class Run {
 public:
  Run(const RunSettings& run, const RunOutput& output, Places places)
      : run_(run),
        output_(output),
        folder_(std::move(places.run)),
        resume_(std::move(places.resume)),
        style_(choose_progress_style(output.quiet)) {}

  void go() {
    for (const auto& removed : folder_->removed()) {
      note("removed " + removed.string() + ", which a killed run left half-written");
    }
    try {
      perform();
    } catch (const UserError& error) {
      throw UserError(error.what() + how_to_resume());
    }
    const std::filesystem::path path = folder_->commit();
    if (resume_) resume_->remove();
    if (!output_.silent) std::cout << path.string() << std::endl;
  }

 private:
  /// Before anything is built: a firmware that is not there is told at once.
  void connect() {
    try {
      bus_.emplace(run_, output_.bus, [this] { return stop_.requested(); });
    } catch (const UserError&) {
      throw;
    } catch (const std::runtime_error& error) {
      if (stop_.requested()) throw Interrupted(error.what(), stop_.exit_status());
      throw CannotFinish(error.what());
    }
  }

  /// All but moving the folder to its place.
  void perform() {
    const Clock::time_point start = Clock::now();
    connect();
    // Of a resumed run as it was written first, with the origin of each value.
    write_file(folder_->file("settings.toml"),
               resume_ ? resume_->settings_toml() : shown_settings(run_).to_toml());
    experiment_ = build();
    journal_ = dynamic_cast<sim::JournaledTerrain*>(&experiment_->plant().terrain());
    const double built_s = seconds_since(start);
    const sim::SandBed* sand = find_sand(experiment_->plant().terrain());
    if (run_.keeps_fields()) fields_.emplace(run_, *experiment_);
    sim::BedState untouched;
    if (sand != nullptr) untouched = sand->state();
    recorder_ =
        std::make_unique<Recorder>(run_, bus_->wires_name(), folder_->working_path(), output_.live);
    const bridge::SessionResult session = drive();
    if (session.interrupted) save_for_resuming();
    recorder_->close();
    nlohmann::ordered_json result = summarise(run_, *experiment_, session, *recorder_);
    if (const auto bus = bus_->report(); !bus.is_null()) result["bus"] = bus;
    if (fields_) fields_->write(folder_->working_path(), result);
    write_result_json(folder_->file("result.json"), result);
    if (sand != nullptr && !run_.concealed) {
      write_file(folder_->file("section.svg"),
                 draw_section(untouched, sand->state(), experiment_->plant().rig(),
                              run_.bed.d50_m(), cut_y_m(run_)));
    }
    // Apart from the results, which are the same every time: how long it took here and now.
    write_result_json(folder_->file("timing.json"), {{"build_s", built_s},
                                                     {"run_s", seconds_since(start) - built_s},
                                                     {"threads", run_.threads}});
    write_report(folder_->working_path());
    if (session.interrupted) interrupt("the results up to that moment");
    if (!output_.silent) print(result);
  }

  void note(const std::string& text) {
    if (output_.quiet) return;
    if (progress_) progress_->finish();
    std::cerr << "hoof: " << text << "\n";
    // What came before tells nothing about how long the rest takes.
    if (progress_) progress_.emplace(run_.kind, style_, std::cerr);
  }

  std::optional<sim::JournalSettings> journal_settings() {
    if (!resume_) return {};
    return sim::JournalSettings{resume_->path(),
                                resume_->key(),
                                output_.checkpoint_every_s,
                                [this](const std::string& text) { note(text); },
                                [this] { return fields_ ? fields_->seen() : std::string(); },
                                [this](std::string_view bytes) {
                                  if (fields_) fields_->see_again(bytes);
                                }};
  }

  std::unique_ptr<sim::Experiment> build() {
    ProgressLine progress("settling", style_, std::cerr);
    const auto show = [&](double share) {
      progress.update(share);
      return !stop_.requested();
    };
    try {
      auto experiment = make_experiment(
          run_, show, [this](const std::string& text) { note(text); }, journal_settings());
      progress.finish();
      return experiment;
    } catch (const std::runtime_error&) {
      progress.finish();
      if (stop_.requested()) {
        throw Interrupted("stopped while the bed was settling; nothing was kept" + how_to_resume(),
                          stop_.exit_status());
      }
      throw;
    }
  }

  bridge::SessionResult drive() {
    progress_.emplace(run_.kind, style_, std::cerr);
    const auto log = [this](int bus, const hal::CanFrame& frame) { recorder_->frame(bus, frame); };
    const auto observe = [&](const bridge::TickRecord& record) {
      recorder_->tick(record);
      // Answers of the journal are of a bed that is not there; what was seen in it comes with the
      // checkpoint.
      if (fields_ && !(journal_ != nullptr && journal_->replaying())) fields_->tick(record.plant);
      if (record.plant.phase != sim::Phase::kFinished) {
        progress_->update(experiment_->progress(), moment(record.plant));
      }
      return !stop_.requested();
    };
    bridge::FaultTimeline faults(run_.faults, run_.has_drives());
    bridge::SessionSettings settings = session_settings(run_);
    if (!run_.faults.empty()) settings.faults = &faults;
    try {
      bridge::Wires& wires = bus_->start(log);
      const bridge::SessionResult result = bridge::run_session(
          *experiment_, bus_->firmware(), wires, settings, observe, bus_->pace());
      progress_->finish();
      return result;
    } catch (const UserError&) {
      progress_->finish();
      throw;
    } catch (const std::system_error& error) {
      // Output that cannot be written, for instance on a full disk: nothing half-written is kept.
      progress_->finish();
      throw UserError(error.what());
    } catch (const std::runtime_error& error) {
      progress_->finish();
      recorder_->close();
      std::cerr << bus_->text();  // in real time, how late the machine was may be the reason
      const std::filesystem::path kept = folder_->keep_as("failed");
      throw CannotFinish(std::string(error.what()) + "; samples and bus log are kept in " +
                         kept.string() + checkpoint_kept());
    }
  }

  /// What was done since the last checkpoint is not lost either.
  void save_for_resuming() {
    if (journal_ == nullptr) return;
    // The ground is still as it was at the start, and its part of the results would be wrong.
    if (journal_->replaying()) {
      throw Interrupted("stopped while going over what was done before" + how_to_resume(),
                        stop_.exit_status());
    }
    try {
      journal_->write_checkpoint();
    } catch (const std::runtime_error& error) {
      note(std::string(error.what()) + "; what was done since the checkpoint before it is lost");
    }
  }

  bool has_checkpoint() const { return resume_ && resume_->has_checkpoint(); }

  std::string how_to_resume() const {
    if (!has_checkpoint()) return "";
    return "; to finish the run: " + resume_command(run_.kind, resume_->path()) +
           (output_.force ? " --force" : "");
  }

  std::string checkpoint_kept() const {
    return has_checkpoint() ? ", the last checkpoint in " + resume_->path().string() : "";
  }

  [[noreturn]] void interrupt(const std::string& what) {
    const std::filesystem::path kept = folder_->keep_as("interrupted");
    throw Interrupted("stopped; " + what + " are kept in " + kept.string() + how_to_resume(),
                      stop_.exit_status());
  }

  void print(const nlohmann::ordered_json& r) const {
    const auto mm = [&](const char* key) { return r.at(key).get<double>() * 1e3; };
    const auto deg = [&](const char* key) { return r.at(key).get<double>() * 57.29577951308232; };
    if (run_.is_sinkage()) {
      std::printf(
          "%s foot, %.1f N, %.2g m/s: sank %.2f mm (at rest %.2f mm), the sole %.2f mm below first "
          "contact%s\n",
          run_.foot_name.c_str(), run_.sinkage.load_N, run_.sinkage.speed_m_s, mm("max_depth_m"),
          mm("final_depth_m"), mm("max_sole_depth_m"),
          r.at("rested").get<bool>() ? "" : ", not yet at rest");
    } else {
      const auto& coefficient = r.at("traction_coefficient");
      char ratio[48] = "none (nothing carries the foot then)";
      if (coefficient.is_number()) {
        std::snprintf(ratio, sizeof ratio, "%.3f", coefficient.get<double>());
      }
      std::printf(
          "%s foot, %.3g Hz: Fx peak %.1f N, Fz there %.1f N, traction coefficient %s, off the "
          "ellipse by %.1f mm\n",
          run_.foot_name.c_str(), run_.traction.frequency_Hz, r.at("fx_peak_N").get<double>(),
          r.at("fz_at_fx_peak_N").get<double>(), ratio, mm("ellipse_error_m"));
    }
    if (run_.concealed) {
      std::printf("what was added to the plant stands in %s\n", output_.truth.string().c_str());
    } else {
      for (const EffectText& effect : effect_texts(run_)) {
        std::printf("with %s: %s\n", effect.name.c_str(), effect.values.c_str());
      }
      for (const auto& [name, value] : run_.setup) {
        std::printf("with %s = %s\n", name.c_str(), format_number(value).c_str());
      }
    }
    if (run_.foot.has_toes && !run_.concealed) {
      std::printf("toes: ordered %.2f deg, reached %.2f, moved by the sand at most %.2f\n",
                  deg("toe_command_rad"), deg("toe_reached_rad"), deg("toe_deflection_rad"));
    }
    print_faults(r);
    if (run_.terrain == "rft") std::printf("%s\n", soil_line(run_).c_str());
    if (!run_.concealed) print_limited(r);
    std::fputs(bus_->text().c_str(), stdout);
    if (r.contains("resolution")) {
      for (const auto& claim : r["resolution"]["claims_refused"]) {
        std::printf("cannot say: %s\n", claim.get<std::string>().c_str());
      }
    }
  }

  static void print_limited(const nlohmann::ordered_json& r) {
    for (const auto& [joint, limited_s] : r.at("torque_limited_s").items()) {
      if (limited_s.get<double>() > 0) {
        std::printf("%s drive: at its torque limit for %.2f s\n", joint.c_str(),
                    limited_s.get<double>());
      }
    }
  }

  const RunSettings& run_;
  const RunOutput& output_;
  StopRequest stop_;
  std::unique_ptr<RunFolder> folder_;
  std::unique_ptr<ResumeFolder> resume_;
  ProgressStyle style_;
  std::optional<ProgressLine> progress_;
  std::optional<RunBus> bus_;
  std::unique_ptr<sim::Experiment> experiment_;
  sim::JournaledTerrain* journal_ = nullptr;  // null where the run cannot be resumed
  std::unique_ptr<Recorder> recorder_;
  std::optional<RunFields> fields_;
};

}  // namespace

void run_experiment(RunSettings run, const RunOutput& output) {
  run.concealed = !output.truth.empty();
  if (run.concealed) write_truth(run, output);
  Run(run, output, new_places(run, output)).go();
}

void resume_experiment(const std::string& kind, const std::filesystem::path& folder,
                       RunOutput output) {
  Places places;
  places.resume = ResumeFolder::open(folder, kind);
  const RunSettings run = read_run_settings(places.resume->settings_file().string(), {});
  output.out = places.resume->run_path();
  places.run = std::make_unique<RunFolder>(RunFolderOptions{kind, output.out, output.force});
  Run(run, output, std::move(places)).go();
}

}  // namespace hoof::tools
