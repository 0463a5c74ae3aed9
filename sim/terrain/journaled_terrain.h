// A ground that is dear to compute, with a memory on disk: a run that was cut off is gone through
// again from its beginning, the ground answering from its journal up to the last checkpoint.
//
// The rest of a run (rig, drives, firmware, bus, files) is cheap and gives the same bytes each
// time. So nothing but the ground needs to be kept, and no file has to be continued in the middle.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/terrain/checkpoint_file.h"
#include "sim/terrain/interval_journal.h"
#include "sim/terrain/resumable_terrain.h"

namespace hoof::sim {

struct JournalSettings {
  std::filesystem::path folder;  // of journal and checkpoints; exists
  std::string key;               // identity of the run: settings and program
  /// Time by the clock between checkpoints, s; 0: only when asked for. At most what a kill loses.
  /// Default: a checkpoint of the paper's bed (190 MB) takes about 1 s, so 0.3 % of the time.
  double checkpoint_every_s = 300;
  /// Something the user should know; may be empty.
  std::function<void(const std::string&)> note;
  /// What others saw in the ground before a checkpoint, they cannot see again: their bytes are kept
  /// with it and given back when the ground goes on from it. Both may be empty.
  std::function<std::string()> seen;
  std::function<void(std::string_view)> see_again;

  /// @throws std::invalid_argument naming the first broken rule
  void validate() const;
};

class JournaledTerrain final : public Terrain {
 public:
  /// Looks for a journal and checkpoints in the folder once the first interval is asked for; notes
  /// what it resumes from and what it refuses.
  JournaledTerrain(std::unique_ptr<ResumableTerrain> ground, JournalSettings settings);

  WrenchTime wrench_time() const override { return ground_->wrench_time(); }
  int add_body(const TriangleMesh& mesh, const Pose& pose) override;

  /// Writes a checkpoint at the end where it is time; one that cannot be written is noted and the
  /// run goes on. @throws std::runtime_error as the ground; and where the bodies move otherwise
  /// than in the run that wrote the journal
  void advance(double interval_s, std::span<const BodyMotion> motions,
               std::span<Wrench> wrenches) override;

  double surface_height_m() const override { return ground_->surface_height_m(); }
  double work_on_bodies_J() const override { return work_J_; }

  /// Between two intervals. Does nothing before the first and while the journal answers: there is
  /// nothing new. @throws std::runtime_error naming file and cause
  void write_checkpoint();

  /// True while answers come from the journal.
  bool replaying() const { return resume_from_.has_value(); }
  /// True once there is a checkpoint to resume from.
  bool can_be_resumed() const { return last_checkpoint_.has_value(); }
  const ResumableTerrain& ground() const { return *ground_; }

 private:
  void open();
  void replay(std::span<Wrench> wrenches);
  void go_on();
  bool is_time() const;
  void note(const std::string& text) const;

  std::unique_ptr<ResumableTerrain> ground_;
  JournalSettings settings_;
  CheckpointFiles checkpoints_;
  std::optional<IntervalJournal> journal_;
  std::optional<Checkpoint> resume_from_;
  std::optional<std::uint64_t> last_checkpoint_;  // its interval
  std::uint64_t told_ = 0;                        // IntervalJournal::Answer::told
  std::uint64_t intervals_ = 0;
  double time_s_ = 0;
  double work_J_ = 0;
  int bodies_ = 0;
  double next_checkpoint_s_ = 0;  // by the clock
};

}  // namespace hoof::sim
