#include "sim/terrain/bed_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <type_traits>

namespace hoof::sim {
namespace {

constexpr char kMagic[] = "hoof bed 1\n";

class Writer {
 public:
  template <typename T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void put(const Eigen::Vector3d& v) { put(v.x()), put(v.y()), put(v.z()); }
  void text(const std::string& s) { bytes_ += s; }
  std::string& bytes() { return bytes_; }

 private:
  std::string bytes_;
};

class Cursor {
 public:
  explicit Cursor(const std::string& bytes, std::size_t at) : bytes_(bytes), at_(at) {}
  template <typename T>
  T get() {
    T value;
    if (at_ + sizeof value > bytes_.size()) throw std::runtime_error("is truncated");
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  Eigen::Vector3d vector() {
    const double x = get<double>(), y = get<double>(), z = get<double>();
    return {x, y, z};
  }

 private:
  const std::string& bytes_;
  std::size_t at_;
};

KeptBed parse(const std::string& bytes) {
  const std::size_t magic = sizeof kMagic - 1;
  if (bytes.compare(0, magic, kMagic) != 0) throw std::runtime_error("is not a bed file");
  if (bytes.size() < magic + sizeof(std::uint64_t)) throw std::runtime_error("is truncated");
  const std::size_t body = bytes.size() - sizeof(std::uint64_t);
  if (Cursor(bytes, body).get<std::uint64_t>() != fnv1a(bytes.data(), body)) {
    throw std::runtime_error("is damaged or truncated: its checksum does not match");
  }
  const std::size_t end_of_key = bytes.find('\n', magic);
  if (end_of_key == std::string::npos) throw std::runtime_error("says not what it was made from");
  Cursor cursor(bytes, end_of_key + 1);
  KeptBed bed{bytes.substr(magic, end_of_key - magic), {}};
  BedState& state = bed.state;
  const auto grains = cursor.get<std::uint64_t>(), contacts = cursor.get<std::uint64_t>();
  for (std::uint64_t i = 0; i < grains; ++i) {
    Grain g;
    g.id = cursor.get<std::uint32_t>();
    g.radius_m = cursor.get<double>();
    g.p_m = cursor.vector();
    g.v_m_s = cursor.vector();
    g.w_rad_s = cursor.vector();
    state.grains.push_back(g);
  }
  for (std::uint64_t i = 0; i < contacts; ++i) {
    GrainContact c;
    c.i = cursor.get<std::uint32_t>();
    c.j = cursor.get<std::uint32_t>();
    c.xi_m = cursor.vector();
    state.contacts.push_back(c);
  }
  return bed;
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

void write_bed_file(const std::filesystem::path& file, const std::string& key,
                    const BedState& state) {
  Writer w;
  w.text(kMagic);
  w.text(key + "\n");
  w.put(std::uint64_t(state.grains.size()));
  w.put(std::uint64_t(state.contacts.size()));
  for (const Grain& g : state.grains) {
    w.put(g.id), w.put(g.radius_m), w.put(g.p_m), w.put(g.v_m_s), w.put(g.w_rad_s);
  }
  for (const GrainContact& c : state.contacts) w.put(c.i), w.put(c.j), w.put(c.xi_m);
  w.put(fnv1a(w.bytes().data(), w.bytes().size()));

  write_whole(file, w.bytes());
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
