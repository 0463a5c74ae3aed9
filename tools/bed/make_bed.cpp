#include "tools/bed/make_bed.h"

#include <chrono>
#include <cstdio>
#include <iostream>

#include "sim/terrain/bed_file.h"
#include "sim/terrain/bed_maker.h"
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
  Making(const ChosenBed& chosen, bool quiet)
      : chosen_(chosen),
        bed_(chosen.bed, chosen.materials, chosen.seed, chosen.threads),
        progress_("making the bed '" + chosen.bed.name + "'", choose_progress_style(quiet),
                  std::cerr) {}

  void go() {
    while (bed_.advance()) {
      progress_.update(bed_.share_done(), std::string(bed_.stage_name()));
      if (stop_.requested()) stop();
    }
    progress_.update(1);
    progress_.finish();
    sim::write_bed_file(chosen_.file, chosen_.key(), bed_.bed());
    write_making(chosen_.file,
                 {{"wall_s", wall_s()}, {"threads", chosen_.threads}, {"steps", bed_.steps()}});
  }

 private:
  double wall_s() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

  [[noreturn]] void stop() {
    progress_.finish();
    throw Interrupted(
        "stopped while the bed was " + std::string(bed_.stage_name()) + "; nothing was kept",
        stop_.exit_status());
  }

  const ChosenBed& chosen_;
  StopRequest stop_;
  sim::BedMaking bed_;
  ProgressLine progress_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

void make_bed(const MakeBedOptions& options) {
  ChosenBed chosen = choose_bed(options.bed);
  if (!options.out.empty()) chosen.file = options.out;
  if (!is_there(chosen, options.force)) {
    require_place(chosen.file);
    Making(chosen, options.quiet).go();
  }
  const sim::BedState state = sim::read_bed_file(chosen.file, chosen.key());
  std::fputs(bed_text(chosen, sim::inspect_bed(chosen.bed, chosen.materials, state)).c_str(),
             stdout);
  std::cout << chosen.file.string() << std::endl;
}

}  // namespace hoof::tools
