#include "tools/calibrate/heap_runner.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "sim/terrain/bed_file.h"
#include "tools/run/csv_writer.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

namespace hoof::tools {
namespace {

namespace fs = std::filesystem;

/// Raised whenever the same settings would give another heap: kept ones are then made anew.
constexpr int kFormat = 2;
constexpr double kSettling = 0.15;  // of the work of a heap that comes after pouring

std::string hex(std::uint64_t value) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

std::uint64_t hash(const std::string& bytes) {
  return sim::fnv1a(bytes.data(), bytes.size());
}

fs::path file_of(const HeapCase& c, const fs::path& folder) {
  return folder / (c.name + "-" + hex(hash(heap_key(c))) + ".txt");
}

fs::path snapshot_of(const HeapCase& c, const fs::path& folder) {
  return file_of(c, folder).replace_extension(".snapshot");
}

/// Never half-written: through a neighbour that is renamed.
void write_whole(const fs::path& file, const std::string& bytes) {
  fs::path part = file;
  part += ".part";
  write_file(part, bytes);
  std::error_code error;
  fs::rename(part, file, error);
  if (error) throw UserError(file.string() + ": cannot be written: " + error.message());
}

const std::string kNone = "none ";

HeapResult without_angle(double time_s, const std::string& kind, const std::string& why) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  return {{kNaN, kNaN, kNaN, kNaN, kNaN, 0}, time_s, kind, why};
}

std::string to_text(const HeapResult& r) {
  if (!r.tells()) return kNone + format_number(r.time_s) + "\n" + r.no_angle + "\n" + r.why + "\n";
  return format_number(r.angle.ring_deg) + " " + format_number(r.angle.outline_deg) + " " +
         format_number(r.angle.sides_deg) + " " + format_number(r.angle.height_m) + " " +
         format_number(r.angle.radius_m) + " " + std::to_string(r.angle.grains_in_it) + " " +
         format_number(r.time_s) + "\n";
}

std::optional<HeapResult> read_result(const fs::path& file) {
  if (!fs::exists(file)) return {};
  HeapResult r;
  HeapAngle& a = r.angle;
  const std::string text = read_file(file);
  if (text.starts_with(kNone)) {
    std::istringstream lines(text.substr(kNone.size()));
    double time_s = 0;
    std::string kind, why;
    lines >> time_s >> std::ws;
    if (!std::getline(lines, kind) || !std::getline(lines, why) || kind.empty()) return {};
    return without_angle(time_s, kind, why);
  }
  if (std::sscanf(text.c_str(), "%lf %lf %lf %lf %lf %d %lf", &a.ring_deg, &a.outline_deg,
                  &a.sides_deg, &a.height_m, &a.radius_m, &a.grains_in_it, &r.time_s) != 7) {
    return {};  // damaged: made anew
  }
  return r;
}

/// The heap as it was left; from the beginning where nothing was kept, or what was kept is damaged
/// or of another version of the engine.
std::unique_ptr<HeapMaking> begin(const HeapCase& c, const fs::path& snapshot) {
  auto heap = std::make_unique<HeapMaking>(c.materials, c.test);
  if (!fs::exists(snapshot)) return heap;
  const std::string bytes = read_file(snapshot);  // a checksum, then the heap's
  std::uint64_t sum = 0;
  if (bytes.size() < sizeof sum) return heap;
  std::memcpy(&sum, bytes.data(), sizeof sum);
  const std::string rest = bytes.substr(sizeof sum);
  if (hash(rest) != sum) return heap;
  try {
    heap->restore(rest);
  } catch (const std::runtime_error&) {
    heap = std::make_unique<HeapMaking>(c.materials, c.test);
  }
  return heap;
}

void keep(const HeapMaking& heap, const fs::path& file) {
  const std::string bytes = heap.snapshot();
  const std::uint64_t sum = hash(bytes);
  std::string whole(sizeof sum, '\0');
  std::memcpy(whole.data(), &sum, sizeof sum);
  write_whole(file, whole + bytes);
}

HeapAngle angle_of(const std::vector<sim::Grain>& grains, const HeapTest& test) {
  const HeapGeometry g = heap_geometry(test);
  try {
    return heap_angle(grains, g.rim_m > 0 ? g.base_radius_m : heap_radius_m(grains, g.d50_m));
  } catch (const std::invalid_argument&) {
    return {};  // a layer: nowhere about the axis does it stand a grain high
  }
}

/// The cases that are still to be made, shared by the threads.
class Work {
 public:
  Work(const std::vector<HeapCase>& cases, const fs::path& folder, const HeapProgress& progress)
      : cases_(cases),
        folder_(folder),
        progress_(progress),
        results_(cases.size()),
        share_(cases.size(), 0.0) {
    for (std::size_t i = 0; i < cases.size(); ++i) {
      results_[i] = read_result(file_of(cases[i], folder));
      if (results_[i]) share_[i] = 1;
    }
  }

  void run(int threads) {
    std::vector<std::thread> team;
    for (int t = 1; t < threads; ++t) team.emplace_back([this] { work(); });
    work();
    for (std::thread& t : team) t.join();
    if (failure_) std::rethrow_exception(failure_);
  }

  std::vector<HeapResult> results() const {
    std::vector<HeapResult> all;
    for (const auto& r : results_) {
      if (!r) return {};
      all.push_back(*r);
    }
    return all;
  }

 private:
  void work() {
    for (;;) {
      const std::size_t i = next_.fetch_add(1);
      if (i >= cases_.size() || stop_) return;
      if (results_[i]) continue;
      try {
        results_[i] = make(i);
      } catch (...) {
        const std::lock_guard lock(mutex_);
        if (!failure_) failure_ = std::current_exception();
        stop_ = true;
      }
    }
  }

  std::optional<HeapResult> make(std::size_t i) {
    const HeapCase& c = cases_[i];
    const fs::path snapshot = snapshot_of(c, folder_);
    const auto heap = begin(c, snapshot);
    HeapResult result;
    try {
      while (heap->advance()) {
        if (tell(i, heap->share_poured() * (1 - kSettling))) continue;
        keep(*heap, snapshot);
        return {};
      }
      result = {angle_of(heap->grains(), c.test), heap->time_s(), "", ""};
    } catch (const NoAngle& none) {
      result = without_angle(heap->time_s(), none.kind(), none.what());
    }
    write_whole(file_of(c, folder_), to_text(result));
    std::error_code ignored;
    fs::remove(snapshot, ignored);
    tell(i, 1);
    return result;
  }

  /// @return false: stop
  bool tell(std::size_t i, double share) {
    const std::lock_guard lock(mutex_);
    share_[i] = share;
    double sum = 0;
    for (const double s : share_) sum += s;
    if (progress_ && !progress_(sum / double(cases_.size()), cases_[i].name)) stop_ = true;
    return !stop_;
  }

  const std::vector<HeapCase>& cases_;
  const fs::path& folder_;
  const HeapProgress& progress_;
  std::vector<std::optional<HeapResult>> results_;
  std::vector<double> share_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::exception_ptr failure_;
};

}  // namespace

std::string heap_key(const HeapCase& c) {
  std::string key = "heap " + std::to_string(kFormat);
  const auto add = [&key](double value) { key += " " + format_number(value); };
  for (const sim::Material* m : {&c.materials.sand, &c.materials.abs}) {
    add(m->young_Pa.value), add(m->poisson.value), add(m->density_kg_m3.value);
  }
  for (const sim::ContactPair* p : {&c.materials.sand_sand, &c.materials.sand_abs}) {
    add(p->restitution.value), add(p->static_friction.value), add(p->rolling_friction.value);
  }
  const HeapTest& t = c.test;
  add(t.grains), add(t.outlet_m), add(t.funnel_half_angle_rad), add(t.rim), add(t.overflow),
      add(t.drop);
  add(t.step_s), add(t.longest_s);
  return key + " seed " + std::to_string(t.seed);
}

std::vector<HeapResult> make_heaps(const std::vector<HeapCase>& cases, const fs::path& folder,
                                   int threads, const HeapProgress& progress) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw UserError(folder.string() + ": cannot be made: " + error.message());
  Work work(cases, folder, progress);
  work.run(std::max(1, threads));
  return work.results();
}

}  // namespace hoof::tools
