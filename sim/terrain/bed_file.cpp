#include "sim/terrain/bed_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <system_error>

namespace hoof::sim {
namespace {

constexpr char kMagic[] = "hoof bed 1\n";

/// Written number by number: Eigen's vectors as three doubles, without padding between members.
void put(ByteWriter& w, const Eigen::Vector3d& v) {
  w.put(v.x()), w.put(v.y()), w.put(v.z());
}
Eigen::Vector3d get_vector(ByteReader& r) {
  const double x = r.get<double>(), y = r.get<double>(), z = r.get<double>();
  return {x, y, z};
}

KeptBed parse(const std::string& bytes) {
  const std::size_t magic = sizeof kMagic - 1;
  if (bytes.compare(0, magic, kMagic) != 0) throw std::runtime_error("is not a bed file");
  if (bytes.size() < magic + sizeof(std::uint64_t)) throw std::runtime_error("is truncated");
  const std::size_t body = bytes.size() - sizeof(std::uint64_t);
  if (ByteReader(std::string_view(bytes).substr(body)).get<std::uint64_t>() !=
      fnv1a(bytes.data(), body)) {
    throw std::runtime_error("is damaged or truncated: its checksum does not match");
  }
  const std::size_t end_of_key = bytes.find('\n', magic);
  if (end_of_key == std::string::npos) throw std::runtime_error("says not what it was made from");
  ByteReader state(std::string_view(bytes).substr(0, body).substr(end_of_key + 1));
  return {bytes.substr(magic, end_of_key - magic), get_state(state)};
}

/// All bytes or no file.
void write_whole(const std::filesystem::path& file, const std::string& bytes) {
  const std::filesystem::path temporary = file.string() + ".part-" + std::to_string(getpid());
  std::error_code error;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), error);
  if (!error) {
    errno = 0;
    std::ofstream out(temporary, std::ios::binary);
    out.write(bytes.data(), std::streamsize(bytes.size()));
    out.close();
    if (!out) error.assign(errno != 0 ? errno : EIO, std::generic_category());
  }
  if (!error) std::filesystem::rename(temporary, file, error);
  if (!error) return;
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
  throw std::runtime_error("cannot write " + file.string() + ": " + error.message());
}

}  // namespace

std::uint64_t fnv1a(const void* bytes, std::size_t size, std::uint64_t hash) {
  const auto* p = static_cast<const unsigned char*>(bytes);
  for (std::size_t i = 0; i < size; ++i) hash = (hash ^ p[i]) * 0x100000001b3u;
  return hash;
}

void put_state(ByteWriter& w, const BedState& state) {
  w.put(std::uint64_t(state.grains.size()));
  w.put(std::uint64_t(state.contacts.size()));
  for (const Grain& g : state.grains) {
    w.put(g.id), w.put(g.radius_m), put(w, g.p_m), put(w, g.v_m_s), put(w, g.w_rad_s);
  }
  for (const GrainContact& c : state.contacts) w.put(c.i), w.put(c.j), put(w, c.xi_m);
}

BedState get_state(ByteReader& r) {
  BedState state;
  const auto grains = r.get<std::uint64_t>(), contacts = r.get<std::uint64_t>();
  for (std::uint64_t i = 0; i < grains; ++i) {
    Grain g;
    r.get(g.id), r.get(g.radius_m);
    g.p_m = get_vector(r), g.v_m_s = get_vector(r), g.w_rad_s = get_vector(r);
    state.grains.push_back(g);
  }
  for (std::uint64_t i = 0; i < contacts; ++i) {
    GrainContact c;
    r.get(c.i), r.get(c.j);
    c.xi_m = get_vector(r);
    state.contacts.push_back(c);
  }
  return state;
}

void write_bed_file(const std::filesystem::path& file, const std::string& key,
                    const BedState& state) {
  ByteWriter numbers;
  put_state(numbers, state);
  std::string bytes = kMagic + key + "\n" + numbers.take();
  ByteWriter checksum;
  checksum.put(fnv1a(bytes.data(), bytes.size()));
  write_whole(file, bytes += checksum.bytes());
}

void require_writable(const std::filesystem::path& file) {
  const std::filesystem::path trial = file.string() + ".trial";
  write_whole(trial, "");
  std::filesystem::remove(trial);
}

KeptBed read_bed_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + file.string() + ": " + std::strerror(errno));
  std::stringstream bytes;
  bytes << in.rdbuf();
  try {
    return parse(bytes.str());
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(file.string() + " " + e.what());
  }
}

BedState read_bed_file(const std::filesystem::path& file, const std::string& key) {
  KeptBed bed = read_bed_file(file);
  if (bed.key != key) throw std::runtime_error(file.string() + " was made from other settings");
  return std::move(bed.state);
}

}  // namespace hoof::sim
