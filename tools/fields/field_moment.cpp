#include "tools/fields/field_moment.h"

namespace hoof::tools {
namespace {

// Both directions read the same, so that one list of the members serves both.
void item(sim::ByteWriter& out, const auto& value) {
  out.put(value);
}
void item(sim::ByteReader& in, auto& value) {
  in.get(value);
}
void text(sim::ByteWriter& out, const std::string& value) {
  out.put_all(value);
}
void text(sim::ByteReader& in, std::string& value) {
  in.get_all(value);
}

template <typename T>
void each(sim::ByteWriter& out, const std::vector<T>& values, const auto& member_list) {
  out.put(std::uint64_t(values.size()));
  for (const T& value : values) member_list(value);
}
template <typename T>
void each(sim::ByteReader& in, std::vector<T>& values, const auto& member_list) {
  values.clear();
  // One by one: a damaged length ends with "is truncated", not with a huge allocation.
  for (auto count = in.get<std::uint64_t>(); count > 0; --count) {
    member_list(values.emplace_back());
  }
}

template <typename Archive, typename Moment>
void transfer(Archive& archive, Moment& m) {
  const auto all = [&archive](auto&... values) { (item(archive, values), ...); };
  text(archive, m.name);
  all(m.time_s, m.depth_m, m.foot_m, m.ground_N);
  each(archive, m.poses, [&](auto& p) { all(p.p_WB_m, p.q_WB); });
  each(archive, m.sand.grains, [&](auto& g) { all(g.id, g.radius_m, g.p_m, g.v_m_s, g.w_rad_s); });
  each(archive, m.sand.contacts, [&](auto& c) { all(c.i, c.j, c.xi_m); });
  each(archive, m.touches, [&](auto& t) {
    all(t.grain, t.mesh, t.triangle, t.overlap_m, t.p_W_m, t.to_grain_m, t.f_normal_N,
        t.f_tangential_N);
  });
}

}  // namespace

void put(sim::ByteWriter& out, const FieldMoment& moment) {
  transfer(out, moment);
}

FieldMoment get_moment(sim::ByteReader& in) {
  FieldMoment moment;
  transfer(in, moment);
  return moment;
}

}  // namespace hoof::tools
