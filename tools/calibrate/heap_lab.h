// The repose laboratory: grains run through a funnel and build a heap, on a wide plate on which its
// foot is free, or on a dish with a rim that what is too much runs over. README.md says what of the
// two it makes.
#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "sim/config/materials.h"
#include "sim/dem/grain.h"
#include "sim/dem/triangle_mesh.h"

namespace hoof::tools {

/// A heap that tells no angle of repose. what() says why and what helps.
class NoAngle : public std::runtime_error {
 public:
  NoAngle(std::string kind, const std::string& why)
      : std::runtime_error("repose: " + why), kind_(std::move(kind)) {}

  /// In a word or three, as in a row of a table: "blocked".
  const std::string& kind() const { return kind_; }

 private:
  std::string kind_;
};

struct HeapTest {
  int grains = 3000;            // of the paper's grading, 2 to 6.4 mm
  std::uint64_t seed = 1;       // of their places and order above the funnel
  double outlet_m = 36 * 1e-3;  // diameter, 5.6 of the largest grains; the bits of --outlet 36
  double funnel_half_angle_rad = 0.5235987755982988;  // of the cone, to its axis
  double rim = 0;          // height of the dish's rim over d50 of the grading; 0: the wide plate
  double overflow = 2;     // grains poured over those that a cone of 38 degrees on the dish holds
  double drop = 1.8;       // height of the outlet over that of the tip of a heap of 55 degrees
  double step_s = 5.6e-6;  // 27 % of the Rayleigh time of the smallest grain
  double longest_s = 8;    // simulated time at most

  /// @throws std::invalid_argument naming the first broken rule, its value and bound
  void validate() const;
};

/// Lengths that follow from the test, m. The floor is z = 0, its middle the origin.
struct HeapGeometry {
  double base_radius_m = 0;  // of the plate, or of the dish's floor inside its rim
  double rim_m = 0;          // its height
  double d50_m = 0;          // of the grading
  double outlet_z_m = 0;
  double funnel_radius_m = 0;  // of its cylinder
  double cone_top_z_m = 0;
  double funnel_top_z_m = 0;
};
HeapGeometry heap_geometry(const HeapTest& test);

/// A closed surface of revolution about z: the polygon (r, z), counter-clockwise with r to the
/// right, turned in `segments` pieces. Points with r = 0 lie on the axis.
sim::TriangleMesh revolved(const std::vector<std::pair<double, double>>& polygon, int segments);

/// One heap on its way from the hopper to rest, worked on in pieces; one thread.
class HeapMaking {
 public:
  /// Sand is sand_sand; dish and funnel are sand_abs. @throws std::invalid_argument
  HeapMaking(const sim::Materials& materials, const HeapTest& test);
  ~HeapMaking();

  /// 10 ms of simulated time.
  /// @return false once the heap is at rest
  /// @throws NoAngle where grains block the funnel or do not come to rest in time, and where the
  /// heap at rest tells no angle: grown into the funnel, or a dish that did not run over
  bool advance();

  double time_s() const;
  /// Share of the grains that have left the funnel.
  double share_poured() const { return share_poured_; }

  /// Bytes from which restore() goes on to the same heap, bit by bit.
  std::string snapshot() const;
  /// @throws std::runtime_error where the bytes are none of this test's
  void restore(std::string_view snapshot);

  /// All grains, by id; those that ran over lie beside the base.
  std::vector<sim::Grain> grains() const;

 private:
  struct Parts;
  void require_room() const;
  void require_an_angle() const;
  std::string of_seed() const;

  std::unique_ptr<Parts> parts_;
  HeapTest test_;
  HeapGeometry geometry_;
  double share_poured_ = 0;
  int quiet_pieces_ = 0;
  int still_pieces_ = 0;  // in which nothing has left the funnel though grains are in it
};

}  // namespace hoof::tools
