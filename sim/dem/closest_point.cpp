#include "sim/dem/closest_point.h"

#include <Eigen/Geometry>

namespace hoof::sim {

Facet::Facet(const Eigen::Vector3d& corner_a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
    : a(corner_a),
      ab(b - corner_a),
      ac(c - corner_a),
      normal(ab.cross(ac).normalized()),
      ab2(ab.squaredNorm()),
      ab_ac(ab.dot(ac)),
      ac2(ac.squaredNorm()) {}

ClosestPoint closest_point(const Facet& f, const Eigen::Vector3d& p) {
  const Eigen::Vector3d ap = p - f.a;
  const double ab_ap = f.ab.dot(ap), ac_ap = f.ac.dot(ap);
  if (ab_ap <= 0 && ac_ap <= 0) return {ap, FacetPart::kCornerA};
  const double ab_bp = ab_ap - f.ab2, ac_bp = ac_ap - f.ab_ac;
  if (ab_bp >= 0 && ac_bp <= ab_bp) return {ap - f.ab, FacetPart::kCornerB};
  const double area_c = ab_ap * ac_bp - ab_bp * ac_ap;
  if (area_c <= 0 && ab_ap >= 0 && ab_bp <= 0) {
    return {ap - ab_ap / f.ab2 * f.ab, FacetPart::kEdgeAB};
  }
  const double ab_cp = ab_ap - f.ab_ac, ac_cp = ac_ap - f.ac2;
  if (ac_cp >= 0 && ab_cp <= ac_cp) return {ap - f.ac, FacetPart::kCornerC};
  const double area_b = ab_cp * ac_ap - ab_ap * ac_cp;
  if (area_b <= 0 && ac_ap >= 0 && ac_cp <= 0) {
    return {ap - ac_ap / f.ac2 * f.ac, FacetPart::kEdgeCA};
  }
  const double area_a = ab_bp * ac_cp - ab_cp * ac_bp;
  const double from_b = ac_bp - ab_bp, from_c = ab_cp - ac_cp;  // along BC
  if (area_a <= 0 && from_b >= 0 && from_c >= 0) {
    return {ap - f.ab - from_b / (from_b + from_c) * (f.ac - f.ab), FacetPart::kEdgeBC};
  }
  return {f.normal.dot(ap) * f.normal, FacetPart::kInside};
}

}  // namespace hoof::sim
