#include "tools/bed/make_bed.h"

#include <chrono>
#include <cstdio>
#include <iostream>

#include "sim/terrain/bed_file.h"
#include "sim/terrain/bed_maker.h"
#include "sim/terrain/checkpoint_file.h"
#include "tools/bed/bed_text.h"
#include "tools/run/errors.h"
#include "tools/run/progress_line.h"
#include "tools/run/stop_request.h"

namespace hoof::tools {
namespace {

/// Whether the file holds this bed already. @throws UserError where it holds something else
bool is_there(const ChosenBed& chosen, bool force) {
  if (force || !std::filesystem::exists(chosen.file)) return false;
  try {
    sim::read_bed_file(chosen.file, chosen.key());
    return true;
  } catch (const std::runtime_error& error) {
    throw UserError(std::string(error.what()) + "; --force makes it anew");
  }
}

/// Found out before hours of work.
void require_place(const std::filesystem::path& file) {
  try {
    sim::require_writable(file);
  } catch (const std::runtime_error& error) {
    throw UserError(error.what());
  }
}

class Making {
 public:
  Making(const ChosenBed& chosen, const MakeBedOptions& options)
      : chosen_(chosen),
        quiet_(options.quiet),
        keep_every_s_(60 * options.checkpoint_every_min),
        bed_(chosen.bed, chosen.materials, chosen.seed, chosen.threads),
        checkpoints_(chosen.file.string() + ".making", chosen.key()),
        progress_("making the bed '" + chosen.bed.name + "'", choose_progress_style(options.quiet),
                  std::cerr) {}

  void go() {
    resume();
    while (bed_.advance()) {
      progress_.update(bed_.share_done(), std::string(bed_.stage_name()));
      if (stop_.requested()) stop();
      if (wall_s() - kept_at_s_ >= keep_every_s_) keep();
    }
    progress_.update(1);
    progress_.finish();
    sim::write_bed_file(chosen_.file, chosen_.key(), bed_.bed());
    write_making(chosen_.file,
                 {{"wall_s", wall_s()}, {"threads", chosen_.threads}, {"steps", bed_.steps()}});
    checkpoints_.remove();
  }

 private:
  double wall_s() const {
    return earlier_wall_s_ +
           std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

  void note(const std::string& text) const {
    if (!quiet_) std::cerr << "hoof: " << text << "\n";
  }

  /// Goes on where an earlier making of the same bed was cut off.
  void resume() {
    const sim::CheckpointSearch search = checkpoints_.read_newest();
    for (const std::string& refused : search.refused) note(refused);
    if (!search.found) return;
    sim::ByteReader payload(search.found->payload);
    std::string snapshot;
    payload.get(earlier_wall_s_);
    payload.get_all(snapshot);
    bed_.restore(snapshot);
    kept_ = true;
    kept_at_s_ = wall_s();
    note("going on with the bed '" + chosen_.bed.name + "': " + std::string(bed_.stage_name()) +
         ", step " + std::to_string(bed_.steps()));
  }

  void keep() {
    const std::string snapshot = bed_.snapshot();
    kept_at_s_ = wall_s();
    if (snapshot.empty()) return;
    sim::ByteWriter payload;
    payload.put(wall_s());
    payload.put_all(snapshot);
    checkpoints_.write(bed_.steps(), 0, payload.bytes());
    kept_ = true;
  }

  [[noreturn]] void stop() {
    keep();
    progress_.finish();
    throw Interrupted("stopped while the bed was " + std::string(bed_.stage_name()) +
                          (kept_ ? "; the same command goes on from there"
                                 : "; nothing is kept while grains are placed"),
                      stop_.exit_status());
  }

  const ChosenBed& chosen_;
  bool quiet_;
  double keep_every_s_;
  StopRequest stop_;
  sim::BedMaking bed_;
  sim::CheckpointFiles checkpoints_;
  ProgressLine progress_;
  bool kept_ = false;
  double earlier_wall_s_ = 0, kept_at_s_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

void make_bed(const ChosenBed& chosen, const MakeBedOptions& options) {
  if (is_there(chosen, options.force)) return;
  require_place(chosen.file);
  Making(chosen, options).go();
}

void make_bed(const MakeBedOptions& options) {
  ChosenBed chosen = choose_bed(options.bed);
  if (!options.out.empty()) chosen.file = options.out;
  make_bed(chosen, options);
  const sim::BedState state = sim::read_bed_file(chosen.file, chosen.key());
  std::fputs(bed_text(chosen, sim::inspect_bed(chosen.bed, chosen.materials, state)).c_str(),
             stdout);
  std::cout << chosen.file.string() << std::endl;
}

}  // namespace hoof::tools
