#include "sim/terrain/interval_journal.h"

#include <algorithm>
#include <cassert>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "sim/dem/byte_archive.h"
#include "sim/terrain/checkpoint_file.h"
#include "sim/terrain/disk_file.h"

namespace hoof::sim {
namespace {

constexpr char kMagic[] = "hoof journal 1\n";
constexpr std::size_t kCheckBytes = sizeof(std::uint64_t);

std::string header_of(const std::string& key, std::size_t bodies) {
  ByteWriter w;
  w.put(checksum64(key));
  w.put(std::uint64_t(bodies));
  return kMagic + w.take();
}

}  // namespace

IntervalJournal::IntervalJournal(std::filesystem::path file, const std::string& key,
                                 std::size_t bodies)
    : file_(std::move(file)),
      header_(header_of(key, bodies)),
      record_bytes_(sizeof(Answer::told) + sizeof(Answer::work_J) + bodies * 6 * sizeof(double) +
                    kCheckBytes) {
  std::ifstream in(file_, std::ios::binary);
  const std::string there{std::istreambuf_iterator<char>(in), {}};
  // Shorter than its header: cut off while it was begun.
  if (there.size() < header_.size() && header_.starts_with(there)) return;
  if (!there.starts_with(kMagic)) throw std::runtime_error(file_.string() + " is not a journal");
  if (!there.starts_with(header_)) {
    throw std::runtime_error(file_.string() + " is of a run with other settings");
  }
  bytes_saved_ = header_.size();
  for (std::size_t at = header_.size(); at + record_bytes_ <= there.size(); at += record_bytes_) {
    const std::string_view record(there.data() + at, record_bytes_ - kCheckBytes);
    const auto check =
        ByteReader({there.data() + at + record.size(), kCheckBytes}).get<std::uint64_t>();
    if (check != checksum64(record, last_check())) break;
    bytes_.append(there, at, record_bytes_);
    bytes_saved_ += record_bytes_;
  }
}

std::uint64_t IntervalJournal::last_check() const {
  if (bytes_.empty()) return checksum64(header_);
  return ByteReader({bytes_.data() + bytes_.size() - kCheckBytes, kCheckBytes})
      .get<std::uint64_t>();
}

IntervalJournal::Answer IntervalJournal::read(std::uint64_t interval,
                                              std::span<Wrench> wrenches) const {
  assert(interval < size());
  ByteReader r({bytes_.data() + interval * record_bytes_, record_bytes_});
  Answer answer;
  r.get(answer.told);
  r.get(answer.work_J);
  for (Wrench& w : wrenches) r.get(w.f_W_N), r.get(w.tau_Bo_W_Nm);
  return answer;
}

void IntervalJournal::append(const Answer& answer, std::span<const Wrench> wrenches) {
  ByteWriter w;
  w.put(answer.told);
  w.put(answer.work_J);
  for (const Wrench& wrench : wrenches) w.put(wrench.f_W_N), w.put(wrench.tau_Bo_W_Nm);
  w.put(checksum64(w.bytes(), last_check()));
  assert(w.bytes().size() == record_bytes_);
  bytes_ += w.bytes();
}

void IntervalJournal::cut(std::uint64_t size) {
  assert(size <= this->size());
  bytes_.resize(size * record_bytes_);
  bytes_saved_ = std::min<std::uint64_t>(bytes_saved_, header_.size() + bytes_.size());
}

void IntervalJournal::save() {
  DiskFile out(file_, DiskFile::Mode::kUpdate);
  out.cut(bytes_saved_);
  if (bytes_saved_ == 0) out.write(header_);
  const std::uint64_t records_saved = bytes_saved_ == 0 ? 0 : bytes_saved_ - header_.size();
  out.write(std::string_view(bytes_).substr(records_saved));
  out.sync();
  bytes_saved_ = header_.size() + bytes_.size();
}

}  // namespace hoof::sim
