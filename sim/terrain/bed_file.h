// A settled bed on disk: text header, then raw little-endian numbers, then a checksum of it all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "sim/dem/byte_archive.h"
#include "sim/dem/grain.h"

namespace hoof::sim {

/// FNV-1a, 64 bits.
std::uint64_t fnv1a(const void* bytes, std::size_t size, std::uint64_t hash = 0xcbf29ce484222325u);

/// A state as numbers in a row. @throws std::runtime_error "is truncated"
void put_state(ByteWriter& writer, const BedState& state);
BedState get_state(ByteReader& reader);

/// Writes to a temporary file beside and renames it: a bed file is whole or not there.
/// @param key what the bed was made from; read_bed_file can ask for it
/// @throws std::runtime_error naming the file and the cause (no room, no permission)
void write_bed_file(const std::filesystem::path& file, const std::string& key,
                    const BedState& state);

/// For finding out before a bed is settled, which may take hours.
/// @throws std::runtime_error as write_bed_file where the file's folder takes no files
void require_writable(const std::filesystem::path& file);

/// @throws std::runtime_error naming the file: not a bed, truncated, damaged, or made from another
/// key
BedState read_bed_file(const std::filesystem::path& file, const std::string& key);

struct KeptBed {
  std::string key;  // what it was made from
  BedState state;
};

/// Any bed, whatever it was made from. @throws std::runtime_error naming the file
KeptBed read_bed_file(const std::filesystem::path& file);

}  // namespace hoof::sim
