// What the ground answered in each exchange interval, kept on disk so that a run that was cut off
// can be gone through again without the ground.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "sim/terrain/terrain.h"

namespace hoof::sim {

/// A file of records of one size that only grows. Each record's checksum takes in the one before,
/// so that what was torn off in the middle, or damaged, ends the journal there.
class IntervalJournal {
 public:
  /// Reads what the file holds, up to the first record that is not whole.
  /// @param key identity of the run
  /// @throws std::runtime_error naming the file: is no journal, or is another run's
  IntervalJournal(std::filesystem::path file, const std::string& key, std::size_t bodies);

  /// Number of records, those not yet on disk included.
  std::uint64_t size() const { return bytes_.size() / record_bytes_; }

  struct Answer {
    /// Running checksum of all that the ground was told up to this interval.
    std::uint64_t told = 0;
    double work_J = 0;  // Terrain::work_on_bodies_J after the interval
  };
  /// @param wrenches out, one per body
  Answer read(std::uint64_t interval, std::span<Wrench> wrenches) const;

  /// Into memory only.
  void append(const Answer& answer, std::span<const Wrench> wrenches);

  /// Forgets all records from `size` on.
  void cut(std::uint64_t size);

  /// Has all records on the disk. @throws std::filesystem::filesystem_error; may be tried again
  void save();

 private:
  std::uint64_t last_check() const;

  std::filesystem::path file_;
  std::string header_;
  std::size_t record_bytes_;
  std::string bytes_;              // of all records
  std::uint64_t bytes_saved_ = 0;  // of header and records, known to be on the disk
};

}  // namespace hoof::sim
