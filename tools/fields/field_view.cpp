#include "tools/fields/field_view.h"

#include <algorithm>
#include <cmath>

#include "tools/fields/sand_motion.h"
#include "tools/fields/sole_pressure.h"

namespace hoof::tools {
namespace {

using Json = nlohmann::ordered_json;

class Shorts {
 public:
  /// `value` between low and high as 0 to 65535; what is beyond is at the end.
  void add(double value, double low, double high) {
    const double share = high > low ? std::clamp((value - low) / (high - low), 0.0, 1.0) : 0.0;
    const auto step = std::uint16_t(std::lround(65535 * share));
    bytes_.push_back(char(step & 0xff)), bytes_.push_back(char(step >> 8));
  }
  void add(const Eigen::Vector3d& p_m, const Eigen::AlignedBox3d& box_m) {
    for (int axis = 0; axis < 3; ++axis) add(p_m[axis], box_m.min()[axis], box_m.max()[axis]);
  }
  std::string text() const { return base64(bytes_); }

 private:
  std::string bytes_;
};

/// What all but one in two hundred stay below.
double most_of(std::vector<double> values) {
  if (values.empty()) return 1;
  std::sort(values.begin(), values.end());
  const double most = values[std::size_t(0.995 * double(values.size() - 1))];
  return most > 0 ? most : std::max(values.back(), 1e-12);
}

Json numbers(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

/// Tenths of a micrometre are enough for a picture.
double rounded(double value_m) {
  return std::round(value_m * 1e7) / 1e7;
}

}  // namespace

std::string base64(std::string_view bytes) {
  constexpr char kLetters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8 | (k < left ? std::uint8_t(bytes[i + k]) : 0);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= left ? kLetters[bits >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

void FieldView::add(const FieldScene& scene, const FieldMoment& contact) {
  const FieldMoment& m = scene.moment;
  const std::vector<sim::Grain>& all = m.sand.grains;
  Moment moment{m.name, m.time_s, {}, {}, m.poses, triangle_pressure_Pa(scene)};
  Eigen::AlignedBox3d box;
  for (const FootTriangle& t : scene.foot.triangles) {
    for (const Eigen::Vector3d& p : t.corners_m) box.extend(p);
  }
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t i = 0; i < all.size(); ++i)
    near.push_back({box.exteriorDistance(all[i].p_m), i});
  std::sort(near.begin(), near.end());
  if (near.size() > kMostGrains) near.resize(kMostGrains);
  std::vector<bool> is_shown(all.size());
  const auto ways = displacements_m(contact, m);
  std::vector<double> force_N(all.size());  // the largest of a grain's contacts
  for (const ForceLine& line : scene.lines) {
    for (const std::int32_t end : {line.i, line.j}) {
      if (end < 0) continue;
      force_N[std::size_t(end)] = std::max(force_N[std::size_t(end)], line.f_normal_N);
    }
  }
  for (const auto& [distance, i] : near) {
    is_shown[i] = true;
    moment.grains.push_back(
        {all[i].p_m, all[i].radius_m, all[i].v_m_s.norm(), ways[i].norm(), force_N[i]});
  }
  for (const ForceLine& line : scene.lines) {
    if (line.j == ForceLine::kWall || !is_shown[std::size_t(line.i)]) continue;
    if (line.j >= 0 && !is_shown[std::size_t(line.j)]) continue;
    moment.chains.push_back({line.from_m, line.to_m, line.f_normal_N});
  }
  std::stable_sort(moment.chains.begin(), moment.chains.end(),
                   [](const Chain& a, const Chain& b) { return a.force_N > b.force_N; });
  if (moment.chains.size() > kMostChains) moment.chains.resize(kMostChains);
  moments_.push_back(std::move(moment));
}

Json FieldView::finish() const {
  std::vector<double> speed, displacement, force, pressure, radius;
  for (const Moment& m : moments_) {
    for (const Grain& g : m.grains) {
      speed.push_back(g.speed_m_s), displacement.push_back(g.displacement_m);
      radius.push_back(g.radius_m);
    }
    for (const Chain& c : m.chains) force.push_back(c.force_N);
    for (const double p_Pa : m.pressure_Pa) {
      if (p_Pa > 0) pressure.push_back(p_Pa);
    }
  }
  const double most_speed = most_of(speed), most_way = most_of(displacement),
               most_force = most_of(force), most_pressure = most_of(pressure),
               most_radius = radius.empty() ? 1 : *std::max_element(radius.begin(), radius.end());
  const Eigen::AlignedBox3d& box = setting_.region_m;
  Json j;
  j["low_m"] = numbers(box.min()), j["high_m"] = numbers(box.max());
  j["radius_m"] = most_radius;
  j["speed_m_s"] = most_speed, j["displacement_m"] = most_way;
  j["force_N"] = most_force, j["pressure_Pa"] = most_pressure;
  j["bodies"] = Json::array();
  for (const sim::TriangleMesh& mesh : setting_.shape.meshes) {
    Json vertices = Json::array(), triangles = Json::array();
    for (const Eigen::Vector3d& v : mesh.vertices_m) {
      for (const double x : v) vertices.push_back(rounded(x));
    }
    for (const auto& t : mesh.triangles) {
      for (const std::int32_t corner : t) triangles.push_back(corner);
    }
    j["bodies"].push_back({{"vertices_m", vertices}, {"triangles", triangles}});
  }
  j["moments"] = Json::array();
  for (const Moment& m : moments_) {
    Shorts grains, chains, pressures;
    for (const Grain& g : m.grains) {
      grains.add(g.p_m, box);
      grains.add(g.radius_m, 0, most_radius), grains.add(g.speed_m_s, 0, most_speed);
      grains.add(g.displacement_m, 0, most_way), grains.add(g.force_N, 0, most_force);
    }
    for (const Chain& c : m.chains) {
      chains.add(c.from_m, box), chains.add(c.to_m, box), chains.add(c.force_N, 0, most_force);
    }
    for (const double p_Pa : m.pressure_Pa) pressures.add(p_Pa, 0, most_pressure);
    Json poses = Json::array();
    for (const sim::Pose& p : m.poses) {
      poses.push_back({rounded(p.p_WB_m.x()), rounded(p.p_WB_m.y()), rounded(p.p_WB_m.z()),
                       rounded(p.q_WB.x()), rounded(p.q_WB.y()), rounded(p.q_WB.z()),
                       rounded(p.q_WB.w())});
    }
    j["moments"].push_back({{"name", m.name},
                            {"time_s", m.time_s},
                            {"grains", grains.text()},
                            {"chains", chains.text()},
                            {"pressure", pressures.text()},
                            {"poses", poses}});
  }
  return j;
}

}  // namespace hoof::tools
