#include "sim/terrain/bed_store.h"

#include <cstdio>
#include <stdexcept>

#include "sim/terrain/bed_file.h"
#include "sim/terrain/bed_key.h"

namespace hoof::sim {

std::string BedStore::key(const BedSettings& bed, const Materials& materials, std::uint64_t seed) {
  return bed_key(bed, materials, seed);
}

std::filesystem::path BedStore::file(const BedSettings& bed, const Materials& materials,
                                     std::uint64_t seed) const {
  const std::string k = key(bed, materials, seed);
  char hash[17];
  std::snprintf(hash, sizeof hash, "%016llx",
                static_cast<unsigned long long>(fnv1a(k.data(), k.size())));
  return folder_ / (bed.name + "-" + std::to_string(seed) + "-" + hash + ".bed");
}

StoredBed BedStore::get(const BedSettings& bed, const Materials& materials, std::uint64_t seed,
                        int threads, const BedProgress& progress) const {
  StoredBed stored;
  stored.file = file(bed, materials, seed);
  const std::string k = key(bed, materials, seed);
  if (std::filesystem::exists(stored.file)) {
    try {
      stored.state = read_bed_file(stored.file, k);
      return stored;
    } catch (const std::runtime_error& e) {
      stored.discarded = e.what();  // said by the caller; the bed is made anew
    }
  }
  require_writable(stored.file);
  stored.state = make_bed(bed, materials, seed, threads, progress);
  stored.made = true;
  write_bed_file(stored.file, k, stored.state);
  return stored;
}

}  // namespace hoof::sim
