#include "sim/terrain/journaled_terrain.h"

#include <chrono>
#include <cmath>
#include <stdexcept>

#include "sim/dem/byte_archive.h"

namespace hoof::sim {
namespace {

constexpr char kJournalName[] = "journal";

double clock_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void put(ByteWriter& w, const Pose& pose) {
  w.put(pose.p_WB_m);
  w.put(pose.q_WB);
}

std::string milliseconds(double time_s) {
  return std::to_string(std::llround(time_s * 1e3)) + " ms";
}

}  // namespace

void JournalSettings::validate() const {
  if (!(checkpoint_every_s >= 0) || !std::isfinite(checkpoint_every_s)) {
    throw std::invalid_argument("checkpoint_every_s = " + std::to_string(checkpoint_every_s) +
                                " must be 0 or above");
  }
}

JournaledTerrain::JournaledTerrain(std::unique_ptr<ResumableTerrain> ground,
                                   JournalSettings settings)
    : ground_(std::move(ground)),
      settings_(std::move(settings)),
      checkpoints_(settings_.folder, settings_.key) {
  settings_.validate();
}

int JournaledTerrain::add_body(const TriangleMesh& mesh, const Pose& pose) {
  ByteWriter w;
  w.put_all(mesh.vertices_m);
  w.put_all(mesh.triangles);
  put(w, pose);
  told_ = checksum64(w.bytes(), told_);
  ++bodies_;
  return ground_->add_body(mesh, pose);
}

void JournaledTerrain::open() {
  journal_.emplace(settings_.folder / kJournalName, settings_.key, std::size_t(bodies_));
  CheckpointSearch search = checkpoints_.read_newest(journal_->size());
  for (const std::string& refused : search.refused) note(refused + "; it is not used");
  resume_from_ = std::move(search.found);
  if (resume_from_) {
    last_checkpoint_ = resume_from_->step;
    note("going over what was done, up to the checkpoint at " + milliseconds(resume_from_->time_s) +
         " in the ground");
  } else if (!search.refused.empty()) {
    note("no checkpoint can be used; the run begins anew");
  }
  journal_->cut(last_checkpoint_.value_or(0));
  next_checkpoint_s_ = clock_s() + settings_.checkpoint_every_s;
}

void JournaledTerrain::advance(double interval_s, std::span<const BodyMotion> motions,
                               std::span<Wrench> wrenches) {
  if (!journal_) open();
  ByteWriter w;
  w.put(interval_s);
  for (const BodyMotion& motion : motions) put(w, motion.start), put(w, motion.end);
  told_ = checksum64(w.bytes(), told_);
  if (replaying()) {
    replay(wrenches);
  } else {
    ground_->advance(interval_s, motions, wrenches);
    work_J_ = ground_->work_on_bodies_J();
    journal_->append({told_, work_J_}, wrenches);
  }
  ++intervals_;
  time_s_ += interval_s;
  if (replaying() && intervals_ == resume_from_->step) {
    go_on();
    next_checkpoint_s_ = clock_s() + settings_.checkpoint_every_s;
  } else if (is_time()) {
    next_checkpoint_s_ = clock_s() + settings_.checkpoint_every_s;
    try {
      write_checkpoint();
    } catch (const std::runtime_error& error) {
      note(std::string(error.what()) + "; the run goes on without this checkpoint");
    }
  }
}

void JournaledTerrain::replay(std::span<Wrench> wrenches) {
  const IntervalJournal::Answer answer = journal_->read(intervals_, wrenches);
  if (answer.told != told_) {
    throw std::runtime_error(
        "after " + milliseconds(time_s_) +
        " in the ground the bodies move otherwise than in the run that wrote " +
        (settings_.folder / kJournalName).string() + ": that was another run or another build");
  }
  work_J_ = answer.work_J;
}

/// A checkpoint's payload: the ground, what others saw, and the length of that.
void JournaledTerrain::go_on() {
  std::string_view bytes = resume_from_->payload;
  std::uint64_t seen = 0;
  if (bytes.size() < sizeof seen) throw std::runtime_error("the checkpoint is truncated");
  ByteReader(bytes.substr(bytes.size() - sizeof seen)).get(seen);
  bytes.remove_suffix(sizeof seen);
  if (bytes.size() < seen) throw std::runtime_error("the checkpoint is truncated");
  ground_->restore(bytes.substr(0, bytes.size() - seen));
  if (settings_.see_again) settings_.see_again(bytes.substr(bytes.size() - seen));
  resume_from_.reset();
  note("the ground goes on from its checkpoint");
}

bool JournaledTerrain::is_time() const {
  return !replaying() && settings_.checkpoint_every_s > 0 && clock_s() >= next_checkpoint_s_;
}

void JournaledTerrain::write_checkpoint() {
  if (intervals_ == 0 || replaying() || last_checkpoint_ == intervals_) return;
  // The journal first: a checkpoint is of no use without all answers before it.
  journal_->save();
  std::string payload = ground_->snapshot();
  const std::string seen = settings_.seen ? settings_.seen() : std::string();
  ByteWriter length;
  length.put(std::uint64_t(seen.size()));
  payload += seen;
  payload += length.bytes();
  checkpoints_.write(intervals_, time_s_, payload);
  last_checkpoint_ = intervals_;
}

void JournaledTerrain::note(const std::string& text) const {
  if (settings_.note) settings_.note(text);
}

}  // namespace hoof::sim
