// Triangle meshes in STL files, binary and ASCII.
#pragma once

#include <filesystem>

#include "sim/config/units.h"
#include "sim/dem/triangle_mesh.h"

namespace hoof::sim {

/// Reads a closed surface. Vertices closer than 1 micrometre become one; triangles that this leaves
/// without area are dropped. Coordinates stay where the file has them.
/// @param unit of the file's coordinates, which STL itself does not state
/// @throws ConfigError naming file, triangle (counted from 1) and edge: missing or damaged file,
///         holes, turned or doubled triangles, normals inward
TriangleMesh read_stl(const std::filesystem::path& file, const Unit& unit);

enum class StlFormat { kBinary, kAscii };

/// Writes in millimetres. Binary coordinates are 32 bit floats.
/// @throws std::runtime_error when the file cannot be written
void write_stl(const TriangleMesh& mesh, const std::filesystem::path& file,
               StlFormat format = StlFormat::kBinary);

}  // namespace hoof::sim
