// Which grains are near walls and meshes: the search over the bed and the lists made from it.
#include <algorithm>
#include <cmath>

#include "sim/dem/boundary.h"

namespace hoof::sim {
namespace {

// The search looks this many skins far. It reads every grain, so it should come seldom: with a skin
// of 0.2 mm it is good for 3 mm of travel, a thousand steps of a grain that is shot away at 1 m/s,
// while the candidates stay few.
constexpr double kSearchedSkins = 15;

/// Calls visit for every image of p across the periodic sides that lies in the box.
template <typename Visit>
void visit_images(const Eigen::Vector3d& p, const Eigen::AlignedBox3d& box, const Domain& domain,
                  const Visit& visit) {
  for (int axis = 0; axis < 3; ++axis) {  // most points are told off here
    if (domain.periodic[std::size_t(axis)]) continue;
    if (p[axis] < box.min()[axis] || p[axis] > box.max()[axis]) return;
  }
  std::array<int, 3> first{}, last{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = std::size_t(axis);
    if (!domain.periodic[i]) continue;
    const double length_m = domain.length_m(axis);
    first[i] = int(std::ceil((box.min()[axis] - p[axis]) / length_m));
    last[i] = int(std::floor((box.max()[axis] - p[axis]) / length_m));
  }
  for (int z = first[2]; z <= last[2]; ++z) {
    for (int y = first[1]; y <= last[1]; ++y) {
      for (int x = first[0]; x <= last[0]; ++x) {
        visit(p + Eigen::Vector3d(x * domain.length_m(0), y * domain.length_m(1),
                                  z * domain.length_m(2)));
      }
    }
  }
}

Eigen::AlignedBox3d grown(const Eigen::AlignedBox3d& box, double by_m) {
  const Eigen::Vector3d by = Eigen::Vector3d::Constant(by_m);
  return {box.min() - by, box.max() + by};
}

}  // namespace

/// Box around the mesh, along the world's axes.
Eigen::AlignedBox3d Boundary::world_box(const Mesh& m) {
  const Eigen::Vector3d middle = m.now.origin_m + m.now.R_WB * m.surface.box().center();
  const Eigen::Vector3d half = m.now.R_WB.cwiseAbs() * (0.5 * m.surface.box().sizes());
  return {middle - half, middle + half};
}

/// No point of any mesh has moved further than this since it had the pose `since`.
double Boundary::mesh_travel_m(Pose Mesh::*since) const {
  double furthest_m = 0;
  for (const Mesh& m : meshes_) {
    const Pose& then = m.*since;
    // Two rotations differ by a matrix that stretches nothing more than its Frobenius norm over
    // sqrt(2): that is 2 sin(angle / 2).
    const double turn = (m.now.R_WB - then.R_WB).norm() / std::sqrt(2.0);
    furthest_m =
        std::max(furthest_m, (m.now.origin_m - then.origin_m).norm() + turn * m.surface.radius_m());
  }
  return furthest_m;
}

template <typename Real>
double Boundary::furthest_candidate_m(const GrainRecord<Real>* records,
                                      const Domain& domain) const {
  double furthest2 = 0;
  for (const Candidate& c : candidates_) {
    furthest2 = std::max(furthest2, domain.moved_m(records[c.row], c.listed_at).squaredNorm());
  }
  return std::sqrt(furthest2);
}

/// The fastest grain bounds the travel; only when the bound is used up are the displacements
/// themselves looked at, so that a single rattling grain does not set the pace.
template <typename Real>
void Boundary::prepare(const GrainRecord<Real>* records, std::uint32_t count, const Domain& domain,
                       double time_s) {
  place_meshes(time_s);
  const double search_margin_m = kSearchedSkins * settings_.skin_m;
  if (!searched_ || travel_since_search_m_ + mesh_travel_m(&Mesh::at_search) > search_margin_m) {
    search(records, count, domain);
  }
  const double mesh_m = listed_ ? mesh_travel_m(&Mesh::at_listing) : 0;
  if (listed_ && travel_since_listing_m_ + mesh_m > settings_.skin_m) {
    travel_since_listing_m_ = furthest_candidate_m(records, domain);
    // Not for the last bit of the skin: the next look would come too soon.
    listed_ = travel_since_listing_m_ + mesh_m < 0.75 * settings_.skin_m;
  }
  if (!listed_) list(records, count, domain);
}

void Boundary::advance(double furthest_m) {
  travel_since_search_m_ += furthest_m;
  travel_since_listing_m_ += furthest_m;
}

template <typename Real>
void Boundary::search(const GrainRecord<Real>* records, std::uint32_t count, const Domain& domain) {
  candidates_.clear();
  const double margin_m = kSearchedSkins * settings_.skin_m;
  std::array<Eigen::AlignedBox3d, kMaxMeshes> boxes;
  for (std::size_t m = 0; m < meshes_.size(); ++m) boxes[m] = world_box(meshes_[m]);
  const bool none = settings_.walls.empty() && meshes_.empty();
  for (std::uint32_t row = 0; row < count && !none; ++row) {
    const Eigen::Vector3d p_m = domain.position_m(records[row]);
    const double reach_m = double(records[row].radius_m) + margin_m;
    Candidate c{row, 0, 0, {}};
    for (std::size_t w = 0; w < settings_.walls.size(); ++w) {
      const Wall& wall = settings_.walls[w];
      if (wall.normal.dot(p_m) - wall.offset_m < reach_m) c.walls |= 1u << w;
    }
    for (std::size_t m = 0; m < meshes_.size(); ++m) {
      const Mesh& mesh = meshes_[m];
      visit_images(p_m, grown(boxes[m], reach_m), domain, [&](const Eigen::Vector3d& image_m) {
        const Eigen::Vector3d p_B_m = mesh.now.R_WB.transpose() * (image_m - mesh.now.origin_m);
        if (mesh.surface.maybe_near(p_B_m, reach_m)) c.meshes |= 1u << m;
      });
    }
    if (c.walls != 0 || c.meshes != 0) candidates_.push_back(c);
  }
  for (Mesh& m : meshes_) m.at_search = m.now;
  travel_since_search_m_ = 0;
  searched_ = true;
  listed_ = false;
}

void Boundary::append_walls(std::uint32_t walls, const Eigen::Vector3d& p_m, double reach_m) {
  for (std::size_t w = 0; w < settings_.walls.size(); ++w) {
    if (!(walls >> w & 1)) continue;
    const Wall& wall = settings_.walls[w];
    if (wall.normal.dot(p_m) - wall.offset_m < reach_m) {
      wall_contacts_.push_back({std::int32_t(w), 0, {}});
    }
  }
}

void Boundary::append_patches(std::uint32_t meshes, const Eigen::Vector3d& p_m, double reach_m,
                              const Domain& domain) {
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    if (!(meshes >> m & 1)) continue;
    const Mesh& mesh = meshes_[m];
    const Eigen::AlignedBox3d box = grown(world_box(mesh), reach_m);
    visit_images(p_m, box, domain, [&](const Eigen::Vector3d& image_m) {
      const auto first = std::uint32_t(near_facets_.size());
      mesh.surface.append_near(mesh.now.R_WB.transpose() * (image_m - mesh.now.origin_m), reach_m,
                               near_facets_);
      const auto last = std::uint32_t(near_facets_.size());
      if (last == first) return;
      patches_.push_back(
          {std::uint32_t(m), first, last, {image_m.x(), image_m.y(), image_m.z()}, {}});
    });
  }
}

template <typename Real>
void Boundary::list(const GrainRecord<Real>* records, std::uint32_t count, const Domain& domain) {
  flush_loads();
  flush_energies();
  grains_.swap(old_grains_), wall_contacts_.swap(old_wall_contacts_);
  memories_.swap(old_memories_);
  wall_accounts_.swap(old_wall_accounts_), memory_accounts_.swap(old_memory_accounts_);
  grains_.clear(), wall_contacts_.clear(), memories_.clear();
  patches_.clear(), near_facets_.clear();
  for (Candidate& c : candidates_) {
    const GrainRecord<Real>& r = records[c.row];
    c.listed_at = {r.x, r.y, r.z};
    const double reach_m = double(r.radius_m) + settings_.skin_m;
    NearGrain b{};
    b.row = c.row;
    b.listed_at = c.listed_at;
    b.memory = -1;
    b.account = std::uint32_t(grains_.size());
    b.wall_begin = std::uint32_t(wall_contacts_.size());
    b.patch_begin = std::uint32_t(patches_.size());
    GrainRecord<Real> whole_steps = r;  // what is below one step is added when it is used
    if constexpr (sizeof(Real) == 4) whole_steps.rx = whole_steps.ry = whole_steps.rz = 0;
    append_walls(c.walls, domain.position_m(r), reach_m);
    append_patches(c.meshes, domain.position_m(whole_steps), reach_m, domain);
    b.wall_end = std::uint32_t(wall_contacts_.size());
    b.patch_end = std::uint32_t(patches_.size());
    if (b.wall_begin == b.wall_end && b.patch_begin == b.patch_end) continue;
    if (b.patch_begin != b.patch_end) {
      b.memory = std::int32_t(memories_.size());
      memories_.push_back({});
    }
    grains_.push_back(b);
  }
  if (settings_.account_energy) {
    wall_accounts_.assign(wall_contacts_.size(), {});
    memory_accounts_.assign(memories_.size(), {});
    energies_.assign(grains_.size(), {});
  }
  carry_memory();
  number_forces<Real>(count);
  for (Mesh& m : meshes_) m.at_listing = m.now;
  travel_since_listing_m_ = 0;
  listed_ = true;
}

void Boundary::carry_memory() {
  auto old = old_grains_.begin();
  for (const NearGrain& b : grains_) {
    while (old != old_grains_.end() && old->row < b.row) ++old;
    if (old == old_grains_.end()) return;
    if (old->row != b.row) continue;
    if (b.memory >= 0 && old->memory >= 0) {
      memories_[std::size_t(b.memory)] = old_memories_[std::size_t(old->memory)];
      if (settings_.account_energy) {
        memory_accounts_[std::size_t(b.memory)] = old_memory_accounts_[std::size_t(old->memory)];
      }
    }
    for (std::uint32_t i = b.wall_begin; i < b.wall_end; ++i) {
      for (std::uint32_t k = old->wall_begin; k < old->wall_end; ++k) {
        if (old_wall_contacts_[k].wall != wall_contacts_[i].wall) continue;
        wall_contacts_[i] = old_wall_contacts_[k];
        if (settings_.account_energy) wall_accounts_[i] = old_wall_accounts_[k];
      }
    }
  }
}

/// Groups that have a boundary grain get a place in the forces, the lanes of others stay zero.
template <typename Real>
void Boundary::number_forces(std::uint32_t count) {
  force_of_group_.assign((count + kLanes - 1) / kLanes, -1);
  std::int32_t forces = 0;
  for (NearGrain& b : grains_) {
    std::int32_t& force = force_of_group_[b.row / kLanes];
    if (force < 0) force = forces++;
    b.force = force;
  }
  forces_of<Real>().assign(std::size_t(forces), {});
}

void Boundary::reorder(const std::vector<std::uint32_t>& old_row) {
  if (candidates_.empty() && grains_.empty()) return;
  flush_loads();
  std::vector<std::uint32_t> new_row(old_row.size());
  for (std::uint32_t row = 0; row < old_row.size(); ++row) new_row[old_row[row]] = row;
  const auto renumber = [&](auto& items) {
    for (auto& item : items) item.row = new_row[item.row];
    std::sort(items.begin(), items.end(),
              [](const auto& a, const auto& b) { return a.row < b.row; });
  };
  renumber(candidates_);
  renumber(grains_);
  listed_ = false;
}

template void Boundary::prepare<float>(const GrainRecord<float>*, std::uint32_t, const Domain&,
                                       double);
template void Boundary::prepare<double>(const GrainRecord<double>*, std::uint32_t, const Domain&,
                                        double);

}  // namespace hoof::sim
