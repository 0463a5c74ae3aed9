// What the report's view in three dimensions shows: grains near the foot, chains, foot; small.
#pragma once

#include <nlohmann/json.hpp>

#include "tools/fields/field_scene.h"

namespace hoof::tools {

/// Gathers moments into the object that tools/report/assets/view.js draws. Grains are whole numbers
/// of 16 bits, seven each (x, y, z, radius, speed, displacement, force), as are chains (both ends,
/// force) and the pressure of triangles: shares of the ranges that stand beside them. Bytes are in
/// base64, little-endian.
class FieldView {
 public:
  /// Most grains of a moment: 12,000 are 230 kB of text. Where there are more, the nearest to the
  /// foot are taken.
  static constexpr std::size_t kMostGrains = 12000, kMostChains = 6000;

  explicit FieldView(const FieldSetting& setting) : setting_(setting) {}

  void add(const FieldScene& scene, const FieldMoment& contact);
  nlohmann::ordered_json finish() const;

 private:
  struct Grain {
    Eigen::Vector3d p_m;
    double radius_m, speed_m_s, displacement_m, force_N;
  };
  struct Chain {
    Eigen::Vector3d from_m, to_m;
    double force_N;
  };
  struct Moment {
    std::string name;
    double time_s;
    std::vector<Grain> grains;
    std::vector<Chain> chains;
    std::vector<sim::Pose> poses;
    std::vector<double> pressure_Pa;
  };

  const FieldSetting& setting_;
  std::vector<Moment> moments_;
};

/// @param bytes any  @return base64 of RFC 4648, padded
std::string base64(std::string_view bytes);

}  // namespace hoof::tools
