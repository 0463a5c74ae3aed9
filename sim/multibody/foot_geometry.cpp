#include "sim/multibody/foot_geometry.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace hoof::sim {
namespace {

/// Facets of a rounded bottom edge: the polygon lies at most r (1 - cos(pi/16)) = 0.15 mm inside
/// the arc of 8 mm, a seventh of the smallest grain's radius.
constexpr int kArcFacets = 4;
/// Longest triangle side along a sole: short enough that a triangle's bounding box holds few grains
/// that do not touch it.
constexpr double kFacetLength_m = 0.025;
/// How far a spine reaches into the sole, so that no gap opens between the two surfaces.
constexpr double kSpineSunk_m = 0.001;

using Corners = std::array<Eigen::Vector2d, 4>;

/// The corners of a convex quadrangle (counter-clockwise) with all sides moved inward by d.
Corners inset(const Corners& corners, double d) {
  Corners result;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector2d before = (corners[i] - corners[(i + 3) % 4]).normalized();
    const Eigen::Vector2d after = (corners[(i + 1) % 4] - corners[i]).normalized();
    // Both moved sides pass at distance d: c + d (after - before) / (before x after).
    const double cross = before.x() * after.y() - before.y() * after.x();
    result[i] = corners[i] + d * (after - before) / cross;
  }
  return result;
}

/// Builds a block with rounded bottom edges over a quadrangle, as levels of rings and two caps.
class BlockMesher {
 public:
  BlockMesher(const Corners& corners, double height_m, double radius_m)
      : columns_(facets((corners[1] - corners[0]).norm())),
        rows_(facets((corners[0] - corners[3]).norm())) {
    constexpr double kQuarterTurn_rad = 1.5707963267948966;
    for (int i = 0; i <= kArcFacets; ++i) {
      const double angle = kQuarterTurn_rad * i / kArcFacets;
      add_level(inset(corners, radius_m * (1.0 - std::sin(angle))),
                radius_m * (1.0 - std::cos(angle)));
    }
    add_level(corners, height_m);
    add_sides();
    add_cap(0, inset(corners, radius_m), 0.0, false);
    add_cap(kArcFacets + 1, corners, height_m, true);
  }

  TriangleMesh take() { return std::move(mesh_); }

 private:
  static int facets(double length_m) {
    return static_cast<int>(std::ceil(length_m / kFacetLength_m - 1e-9));
  }

  int ring_size() const { return 2 * (columns_ + rows_); }

  static Eigen::Vector3d bilinear(const Corners& c, double u, double v, double z) {
    const Eigen::Vector2d point =
        (1 - v) * ((1 - u) * c[0] + u * c[1]) + v * ((1 - u) * c[3] + u * c[2]);
    return {point.x(), point.y(), z};
  }

  /// Position on the ring of the grid point (column, row) of the quadrangle's border.
  int ring_index(int column, int row) const {
    if (row == 0) return column;
    if (column == columns_) return columns_ + row;
    if (row == rows_) return columns_ + rows_ + (columns_ - column);
    return 2 * columns_ + rows_ + (rows_ - row);
  }

  void add_level(const Corners& corners, double z) {
    const std::size_t first = mesh_.vertices_m.size();
    mesh_.vertices_m.resize(first + ring_size());
    for (int row = 0; row <= rows_; ++row) {
      for (int column = 0; column <= columns_; ++column) {
        if (!on_border(column, row)) continue;
        mesh_.vertices_m[first + ring_index(column, row)] =
            bilinear(corners, double(column) / columns_, double(row) / rows_, z);
      }
    }
  }

  bool on_border(int column, int row) const {
    return column == 0 || column == columns_ || row == 0 || row == rows_;
  }

  void add_sides() {
    const int n = ring_size();
    for (int level = 0; level <= kArcFacets; ++level) {
      for (int i = 0; i < n; ++i) {
        const int low = level * n + i;
        const int low_next = level * n + (i + 1) % n;
        add_quad(low, low_next, low_next + n, low + n);
      }
    }
  }

  void add_cap(int level, const Corners& corners, double z, bool upward) {
    std::vector<std::int32_t> index((columns_ + 1) * (rows_ + 1));
    for (int row = 0; row <= rows_; ++row) {
      for (int column = 0; column <= columns_; ++column) {
        std::int32_t& vertex = index[row * (columns_ + 1) + column];
        if (on_border(column, row)) {
          vertex = level * ring_size() + ring_index(column, row);
          continue;
        }
        vertex = static_cast<std::int32_t>(mesh_.vertices_m.size());
        mesh_.vertices_m.push_back(
            bilinear(corners, double(column) / columns_, double(row) / rows_, z));
      }
    }
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) {
        const int at = row * (columns_ + 1) + column;
        const int above = at + columns_ + 1;
        if (upward) {
          add_quad(index[at], index[at + 1], index[above + 1], index[above]);
        } else {
          add_quad(index[at], index[above], index[above + 1], index[at + 1]);
        }
      }
    }
  }

  void add_quad(std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
    mesh_.triangles.push_back({a, b, c});
    mesh_.triangles.push_back({a, c, d});
  }

  int columns_;
  int rows_;
  TriangleMesh mesh_;
};

/// Adds a spine whose axis meets the sole at (x, y).
void add_spine(TriangleMesh& mesh, const SpineGeometry& spine, double x, double y) {
  const auto first = static_cast<std::int32_t>(mesh.vertices_m.size());
  const double depth = spine.length_m * std::cos(spine.rake_rad);
  for (const double z : {-depth, kSpineSunk_m}) {
    const double half = 0.5 * (spine.base_m + (spine.base_m - spine.tip_m) * z / depth);
    const double centre_x = x + std::tan(spine.rake_rad) * z;
    mesh.vertices_m.push_back({centre_x - half, y - half, z});
    mesh.vertices_m.push_back({centre_x + half, y - half, z});
    mesh.vertices_m.push_back({centre_x + half, y + half, z});
    mesh.vertices_m.push_back({centre_x - half, y + half, z});
  }
  const auto quad = [&mesh, first](int a, int b, int c, int d) {
    mesh.triangles.push_back({first + a, first + b, first + c});
    mesh.triangles.push_back({first + a, first + c, first + d});
  };
  for (int i = 0; i < 4; ++i) quad(i, (i + 1) % 4, (i + 1) % 4 + 4, i + 4);
  quad(0, 3, 2, 1);
  quad(4, 5, 6, 7);
}

void require(bool holds, const char* name, double value_m, const std::string& rule) {
  if (holds) return;
  std::ostringstream text;
  text << name << " = " << value_m * 1e3 << " mm: must be " << rule;
  throw std::invalid_argument(text.str());
}

std::string at_most_mm(const char* what, double bound_m) {
  std::ostringstream text;
  text << "at most " << what << ", " << bound_m * 1e3 << " mm";
  return text.str();
}

void validate_sole(const SoleGeometry& sole) {
  require(sole.length_m >= sole.width_m && sole.width_m > 0.0, "middle.length", sole.length_m,
          "at least the width, which must be above 0");
  const double radius_bound = std::min(0.45 * sole.width_m, 0.9 * sole.height_m);
  require(sole.edge_radius_m > 0.0 && sole.edge_radius_m <= radius_bound, "middle.edge_radius",
          sole.edge_radius_m,
          "above 0 and " + at_most_mm("0.45 of the width and 0.9 of the height", radius_bound));
}

void validate_toe(const ToeGeometry& toe, const SoleGeometry& sole) {
  require(toe.tip_width_m > 0.0 && toe.tip_width_m <= toe.width_m, "toe.tip_width", toe.tip_width_m,
          "above 0 and " + at_most_mm("the width", toe.width_m));
  const double radius_bound = std::min(0.45 * toe.tip_width_m, 0.9 * toe.height_m);
  require(toe.edge_radius_m > 0.0 && toe.edge_radius_m <= radius_bound, "toe.edge_radius",
          toe.edge_radius_m,
          "above 0 and " + at_most_mm("0.45 of the tip width and 0.9 of the height", radius_bound));
  require(toe.hinge_lateral_m - 0.5 * toe.width_m >= 0.5 * sole.width_m, "toe.hinge_lateral",
          toe.hinge_lateral_m, "so large that the closed toe is clear of the middle segment");
}

void validate_spines(const FootGeometry& g) {
  const SpineGeometry& s = g.spines;
  require(s.length_m > 0.0, "spines.length", s.length_m, "above 0");
  require(s.tip_m > 0.0 && s.tip_m <= s.base_m, "spines.tip", s.tip_m,
          "above 0 and " + at_most_mm("the base", s.base_m));
  const double flat_y = 0.5 * g.middle.width_m - g.middle.edge_radius_m - 0.5 * s.base_m;
  require(s.middle_row_offset_m >= 0.5 * s.base_m && s.middle_row_offset_m <= flat_y,
          "spines.middle_row_offset", s.middle_row_offset_m,
          "at least half a base and " + at_most_mm("what the flat of the sole allows", flat_y));
  const double half_span = 0.5 * (s.middle_count_row - 0.5) * s.middle_pitch_m + 0.5 * s.base_m;
  const double flat_x = 0.5 * g.middle.length_m - g.middle.edge_radius_m;
  require(half_span <= flat_x, "spines.middle_pitch", s.middle_pitch_m,
          "so small that the rows fit on the flat of the sole");
  require(s.middle_pitch_m > s.base_m, "spines.middle_pitch", s.middle_pitch_m,
          "above the base of a spine");
  if (!g.has_toes) return;
  require(s.toe_pitch_m > s.base_m, "spines.toe_pitch", s.toe_pitch_m, "above the base of a spine");
  require(0.5 * (s.toe_count - 1) * s.toe_pitch_m + 0.5 * s.base_m <=
              0.5 * g.toe.length_m - g.toe.edge_radius_m,
          "spines.toe_pitch", s.toe_pitch_m, "so small that the row fits on the flat of a toe");
  require(0.5 * s.base_m <= 0.5 * g.toe.tip_width_m - g.toe.edge_radius_m, "spines.base", s.base_m,
          "at most the flat width of the toe's tip");
}

}  // namespace

void FootGeometry::validate() const {
  validate_sole(middle);
  if (has_toes) validate_toe(toe, middle);
  if (has_spines) validate_spines(*this);
}

TriangleMesh make_middle(const FootGeometry& geometry) {
  const SoleGeometry& sole = geometry.middle;
  const double x = 0.5 * sole.length_m;
  const double y = 0.5 * sole.width_m;
  const Corners corners = {{{-x, -y}, {x, -y}, {x, y}, {-x, y}}};
  TriangleMesh mesh = BlockMesher(corners, sole.height_m, sole.edge_radius_m).take();
  if (!geometry.has_spines) return mesh;

  const SpineGeometry& spine = geometry.spines;
  for (const double side : {-1.0, 1.0}) {
    for (int i = 0; i < spine.middle_count_row; ++i) {
      const double along = (i - 0.5 * (spine.middle_count_row - 1) + 0.25 * side);
      add_spine(mesh, spine, along * spine.middle_pitch_m, side * spine.middle_row_offset_m);
    }
  }
  return mesh;
}

TriangleMesh make_toe(const FootGeometry& geometry) {
  const ToeGeometry& toe = geometry.toe;
  const double y = 0.5 * toe.width_m;
  const double tip_y = 0.5 * toe.tip_width_m;
  const Corners corners = {{{0, -y}, {toe.length_m, -tip_y}, {toe.length_m, tip_y}, {0, y}}};
  TriangleMesh mesh = BlockMesher(corners, toe.height_m, toe.edge_radius_m).take();
  if (!geometry.has_spines) return mesh;

  const SpineGeometry& spine = geometry.spines;
  for (int i = 0; i < spine.toe_count; ++i) {
    const double along = (i - 0.5 * (spine.toe_count - 1)) * spine.toe_pitch_m;
    add_spine(mesh, spine, 0.5 * toe.length_m + along, 0.0);
  }
  return mesh;
}

}  // namespace hoof::sim
