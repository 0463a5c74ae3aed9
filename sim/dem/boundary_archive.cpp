// The boundary's state as bytes.
#include <algorithm>
#include <stdexcept>

#include "sim/dem/boundary.h"

namespace hoof::sim {
namespace {

// Both directions read the same, so that one list of the members serves both.
void item(ByteWriter& out, const auto& value) {
  out.put(value);
}
void item(ByteReader& in, auto& value) {
  in.get(value);
}
void items(ByteWriter& out, const auto& values) {
  out.put_all(values);
}
void items(ByteReader& in, auto& values) {
  in.get_all(values);
}

}  // namespace

/// @param self a boundary, const where it is written
template <typename Archive, typename Self>
void Boundary::transfer(Archive& archive, Self& self) {
  for (auto& m : self.meshes_) {
    item(archive, m.motion.p_WB_m), item(archive, m.motion.q_WB);
    item(archive, m.motion.v_WB_m_s), item(archive, m.motion.w_WB_rad_s);
    for (auto* pose : {&m.at_search, &m.at_listing}) {
      item(archive, pose->origin_m), item(archive, pose->R_WB);
    }
    item(archive, m.load.impulse_W_Ns), item(archive, m.load.angular_impulse_Bo_W_Nms);
    item(archive, m.load.work_J);
  }
  item(archive, self.searched_), item(archive, self.listed_);
  item(archive, self.travel_since_search_m_), item(archive, self.travel_since_listing_m_);
  items(archive, self.candidates_);
  items(archive, self.grains_);
  items(archive, self.wall_contacts_), items(archive, self.wall_accounts_);
  items(archive, self.patches_), items(archive, self.near_facets_);
  items(archive, self.memories_), items(archive, self.memory_accounts_);
  items(archive, self.energies_);
  item(archive, self.lost_);
  item(archive, self.deepest_ratio_);
  items(archive, self.force_of_group_);
}

void Boundary::save(ByteWriter& out) const {
  out.put(settings_.account_energy);
  out.put(std::uint64_t(meshes_.size()));
  for (const Mesh& m : meshes_) out.put(std::uint64_t(m.surface.facet_count()));
  transfer(out, *this);
}

template <typename Real>
void Boundary::load(ByteReader& in) {
  if (in.get<bool>() != settings_.account_energy) {
    throw std::runtime_error("is of a bed that accounts energy otherwise");
  }
  bool same = in.get<std::uint64_t>() == meshes_.size();
  for (std::size_t m = 0; same && m < meshes_.size(); ++m) {
    same = in.get<std::uint64_t>() == meshes_[m].surface.facet_count();
  }
  if (!same) throw std::runtime_error("is of a bed with other meshes");
  transfer(in, *this);
  std::int32_t forces = 0;
  for (const std::int32_t f : force_of_group_) forces = std::max(forces, f + 1);
  forces_of<Real>().assign(std::size_t(forces), {});
}

template void Boundary::load<float>(ByteReader&);
template void Boundary::load<double>(ByteReader&);

}  // namespace hoof::sim
