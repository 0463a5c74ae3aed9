// LIGGGHTS as a child process: its input files, a run, and what it wrote.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "sim/dem/sand_bed.h"

namespace hoof::sim::test {

/// One grain in one line of a dump. Velocities are those at the step itself.
struct GrainMotion {
  Eigen::Vector3d p_m, v_m_s, w_rad_s;
};

/// What LIGGGHTS wrote: step -> grain id -> motion.
using Dump = std::map<int, std::map<std::uint32_t, GrainMotion>>;

/// True where a program named liggghts is on the path (Debian package liggghts).
bool liggghts_is_installed();

/// A file for the command read_data: all grains of type 1; ids are ours plus one, as its ids begin
/// at one. `low_m` and `high_m` bound the box.
void write_data_file(const std::filesystem::path& file, const std::vector<Grain>& grains,
                     const Eigen::Vector3d& low_m, const Eigen::Vector3d& high_m);

/// ASCII STL for the command fix mesh/surface.
void write_stl(const std::filesystem::path& file, const TriangleMesh& mesh);

/// Runs a script of this folder in `folder` with the given variables.
/// @throws std::runtime_error with the end of its output where it fails
void run_liggghts(const std::string& script, const std::filesystem::path& folder,
                  const std::map<std::string, std::string>& variables);

/// Reads a custom dump "id x y z vx vy vz omegax omegay omegaz"; ids become ours again.
Dump read_dump(const std::filesystem::path& file);

/// The same as CSV, for tests/data/dem/liggghts.
void write_record(const std::filesystem::path& file, const Dump& dump);
/// @throws std::runtime_error where the file is missing or not such a CSV
Dump read_record(const std::filesystem::path& file);

/// Rows of a file of numbers, lines beginning with # or a letter skipped.
std::vector<std::vector<double>> read_numbers(const std::filesystem::path& file, char separator);

}  // namespace hoof::sim::test
