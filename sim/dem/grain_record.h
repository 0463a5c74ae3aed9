// What the step reads and writes, laid out for the memory bus.
//
// One grain is one record: a single cache line in mixed precision, two in double. Positions are
// fixed point, the whole domain being 2^32 steps wide (2^64 in double): differences are exact,
// periodic wrap is free and the precision does not fall with the distance from the origin. Two
// buffers: a step reads one and writes the other, so no grain sees a half-updated neighbour and any
// number of threads gives the same bytes. Records beat separate arrays because a neighbour's data
// then come with one miss.
#pragma once

#include <cstdint>

namespace hoof::sim {

inline constexpr int kLanes = 16;            // rows of one group, on every instruction set
inline constexpr int kGroupsPerWindow = 16;  // groups of one window, the unit of bookkeeping

/// Four words of a record at a time are moved in and out of the lanes ("quads").
template <typename Real>
struct GrainRecord;

template <>
struct alignas(64) GrainRecord<float> {
  using Steps = std::int32_t;
  Steps x, y, z;  // position in steps of the domain's lsb
  float radius_m;
  float vx, vy, vz;  // m/s, at half a step before the position (leapfrog)
  float mass_kg;
  float wx, wy, wz;  // rad/s, likewise
  std::uint32_t id;
  float rx, ry, rz;  // part of the position below one step, in steps
  std::uint32_t unused;
};
static_assert(sizeof(GrainRecord<float>) == 64);

template <>
struct alignas(128) GrainRecord<double> {
  using Steps = std::int64_t;
  Steps x, y, z;  // a step is some 3e-20 m: nothing below it matters
  double radius_m;
  double vx, vy, vz;
  double mass_kg;
  double wx, wy, wz;
  std::uint32_t id;
  std::uint32_t unused[9];
};
static_assert(sizeof(GrainRecord<double>) == 128);

/// The k-th neighbour of the 16 rows of a group. Rows of a group lie side by side, so one load
/// takes one word of all lanes. An empty place names the row itself.
template <typename Real>
struct alignas(64) EllSlot {
  std::int32_t neighbour[kLanes];
  Real xi_x[kLanes], xi_y[kLanes], xi_z[kLanes];  // tangential displacement, m; zero when apart
};

/// Force, torque and sum of mu_r F_n R that walls and meshes put on the rows of one group.
template <typename Real>
struct alignas(64) BoundaryForce {
  Real fx[kLanes], fy[kLanes], fz[kLanes];
  Real tx[kLanes], ty[kLanes], tz[kLanes];
  Real rolling_N[kLanes];  // sum of mu_r F_n (times the grain's own radius: a torque)
};

}  // namespace hoof::sim
