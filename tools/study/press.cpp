#include "tools/study/press.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

#include "sim/terrain/bed_report.h"
#include "sim/terrain/bed_store.h"
#include "tools/report/sample_table.h"
#include "tools/run/csv_writer.h"
#include "tools/run/errors.h"

namespace hoof::tools {
namespace {

/// A tenth of the window that forces are read over.
constexpr double kSampleWay_m = 0.1e-3;
/// The indenter starts this far above the level sand, which no grain tops.
constexpr double kGap_m = 0.1e-3;
/// Without friction the sand beside walls slumps by some 0.1 mm when it is switched off; 20 ms at
/// 0.1 m/s are a tenth of the settling.
constexpr double kSmoothGap_m = 2e-3;

double gap_m(const PressCase& c) {
  return c.smooth ? kSmoothGap_m : kGap_m;
}

sim::DemSettings engine_settings(const PressCase& c, const sim::Materials& materials, int threads) {
  sim::DemSettings s = sim::dem_settings(c.bed, materials, threads);
  s.dt_s = c.step_s();
  s.cell_m = c.cell_m;
  if (c.smooth) s.grain_wall.static_friction = s.grain_wall.rolling_friction = 0;
  return s;
}

/// The parts of an indenter in the bed, all at one velocity.
class Descent {
 public:
  Descent(const PressCase& c, sim::SandBed& bed) : bed_(bed) {
    const double start_z_m = gap_m(c) - c.indenter.lowest_m();
    for (const Indenter::Part& part : c.indenter.parts) {
      sim::MeshMotion motion;
      motion.p_WB_m = part.p_WB_m + Eigen::Vector3d(c.offset_x_m, 0, start_z_m);
      motion.q_WB = Eigen::AngleAxisd(part.yaw_rad, Eigen::Vector3d::UnitZ());
      motion.v_WB_m_s = {0, 0, -c.speed_m_s};
      meshes_.push_back(bed.add_mesh(part.mesh, motion.p_WB_m, motion.q_WB));
      motions_.push_back(motion);
    }
    for (std::size_t i = 0; i < meshes_.size(); ++i) bed.set_motion(meshes_[i], motions_[i]);
  }

  double take_impulse_z_Ns() {
    double sum = 0;
    for (const int mesh : meshes_) sum += bed_.take_load(mesh).impulse_W_Ns.z();
    return sum;
  }

 private:
  sim::SandBed& bed_;
  std::vector<int> meshes_;
  std::vector<sim::MeshMotion> motions_;
};

}  // namespace

double PressCase::steps() const {
  return (gap_m(*this) - indenter.lowest_m() + depth_m) / speed_m_s / step_s();
}

std::string PressCase::name() const {
  char text[160];
  std::snprintf(text, sizeof text, "%s%s %gx %gx%gx%g seed %llu", indenter.name.c_str(),
                offset_x_m != 0 ? "-half" : "", bed.grain_scale, bed.box_length_m * 1e3,
                bed.box_width_m * 1e3, bed.depth_m * 1e3, static_cast<unsigned long long>(seed));
  return text;
}

std::string PressCase::key(const sim::Materials& materials) const {
  std::string k = sim::BedStore::key(bed, materials, seed) + " indenter=" + indenter.name;
  for (const Indenter::Part& part : indenter.parts) {
    // The meshes themselves: their lengths come from settings that anybody may change.
    for (const Eigen::Vector3d& v : part.mesh.vertices_m) {
      k += " " + format_number(v.x()) + "," + format_number(v.y()) + "," + format_number(v.z());
    }
    k += " yaw_rad=" + format_number(part.yaw_rad);
  }
  const auto add = [&k](const char* name, double value) {
    k += std::string(" ") + name + "=" + format_number(value);
  };
  add("offset_x_m", offset_x_m), add("speed_m_s", speed_m_s), add("depth_m", depth_m);
  add("dt_s", step_s()), add("cell_m", cell_m), add("smooth", smooth);
  return k;
}

double PressCurve::force_at_N(double depth_m, double half_window_m) const {
  double sum = 0;
  int n = 0;
  for (const PressSample& s : samples) {
    if (std::abs(s.depth_m - depth_m) <= half_window_m) sum += s.force_N, ++n;
  }
  const bool reached =
      !samples.empty() && samples.back().depth_m >= depth_m + half_window_m - kSampleWay_m;
  return n > 0 && reached ? sum / n : std::numeric_limits<double>::quiet_NaN();
}

PressCurve press(const PressCase& c, const sim::Materials& materials, const sim::BedState& state,
                 int threads, const sim::BedProgress& progress) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  PressCurve curve;
  curve.grain_count = double(state.grains.size());
  curve.solid_share = sim::inspect_bed(c.bed, materials, state).solid_share;
  sim::SandBed bed(engine_settings(c, materials, threads), state);
  Descent descent(c, bed);
  const double dt_s = c.step_s();
  const int interval = std::max(1, int(std::lround(kSampleWay_m / (c.speed_m_s * dt_s))));
  const double sole_start_m = c.indenter.lowest_m() - gap_m(c);  // depth of the sole
  for (double done = 0; done < c.steps() && curve.blow_up.empty(); done += interval) {
    try {
      bed.advance(interval);
    } catch (const std::runtime_error& e) {
      curve.blow_up = e.what();
    }
    const sim::BedHealth health = bed.health();
    const double middle_s = (done + 0.5 * interval) * dt_s;
    const double force_N = descent.take_impulse_z_Ns() / (interval * dt_s);
    curve.samples.push_back(
        {sole_start_m + c.speed_m_s * middle_s,
         curve.blow_up.empty() ? force_N : std::numeric_limits<double>::quiet_NaN(),
         health.fastest_m_s, health.deepest_boundary_ratio, double(health.rebuilds),
         std::chrono::duration<double>(Clock::now() - start).count()});
    if (progress && !progress(std::min(1.0, (done + interval) / c.steps()))) {
      throw std::runtime_error("stopped");
    }
  }
  return curve;
}

void write_curve(const std::filesystem::path& file, const PressCurve& curve) {
  std::filesystem::path partial = file;
  partial += ".partial";
  CsvWriter csv(partial, {"depth_m", "force_N", "fastest_m_s", "overlap_ratio", "rebuild_count",
                          "wall_s", "grain_count", "solid_share_ratio", "blow_up_name"});
  // What is no number keeps to what a cell may hold.
  std::string blow_up = curve.blow_up;
  std::replace_if(
      blow_up.begin(), blow_up.end(), [](char ch) { return ch == ',' || ch == '"' || ch == '\n'; },
      ' ');
  for (const PressSample& s : curve.samples) {
    csv.row({s.depth_m, s.force_N, s.fastest_m_s, s.overlap_ratio, s.rebuild_count, s.wall_s,
             curve.grain_count, curve.solid_share, std::string_view(blow_up)});
  }
  csv.close();
  std::filesystem::rename(partial, file);
}

PressCurve read_curve(const std::filesystem::path& file) {
  const SampleTable table = read_samples(file);
  const auto column = [&](const char* name) -> const SampleColumn& {
    if (const SampleColumn* found = table.find(name)) return *found;
    throw UserError(file.string() + ":1: no column " + name + "; delete the file to run it again");
  };
  const auto& depth = column("depth_m").numbers;
  PressCurve curve;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    curve.samples.push_back({depth[i], column("force_N").numbers[i],
                             column("fastest_m_s").numbers[i], column("overlap_ratio").numbers[i],
                             column("rebuild_count").numbers[i], column("wall_s").numbers[i]});
    curve.grain_count = column("grain_count").numbers[i];
    curve.solid_share = column("solid_share_ratio").numbers[i];
    curve.blow_up = column("blow_up_name").texts[i];
  }
  return curve;
}

}  // namespace hoof::tools
