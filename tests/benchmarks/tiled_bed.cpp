#include "tests/benchmarks/tiled_bed.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace hoof::benchmarks {

using hoof::sim::BedState;
using hoof::sim::DemSettings;
using hoof::sim::Grain;
using hoof::sim::GrainContact;

PeriodicBed read_periodic_bed(const std::string& file, double period_x_m, double period_y_m) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot read " + file);
  PeriodicBed bed;
  bed.period_x_m = period_x_m;
  bed.period_y_m = period_y_m;
  std::string line;
  std::getline(in, line);
  if (line != "d,x,y,z,vx,vy,vz,wx,wy,wz") {
    throw std::runtime_error(file + ":1: columns must be d,x,y,z,vx,vy,vz,wx,wy,wz");
  }
  for (int number = 2; std::getline(in, line); ++number) {
    std::array<double, 10> c{};
    std::istringstream cells(line);
    char comma = ',';
    for (std::size_t i = 0; i < c.size(); ++i) {
      if ((i > 0 && !(cells >> comma)) || comma != ',' || !(cells >> c[i])) {
        throw std::runtime_error(file + ":" + std::to_string(number) + ": ten numbers expected");
      }
    }
    Grain g;
    g.id = std::uint32_t(bed.state.grains.size());
    g.radius_m = c[0] / 2;
    g.p_m = {c[1], c[2], c[3]};
    g.v_m_s = {c[4], c[5], c[6]};
    g.w_rad_s = {c[7], c[8], c[9]};
    bed.surface_m = std::max(bed.surface_m, g.p_m.z() + g.radius_m);
    bed.state.grains.push_back(g);
  }
  return bed;
}

PeriodicBed tiled(const PeriodicBed& tile, int nx, int ny) {
  PeriodicBed bed = tile;
  bed.period_x_m = nx * tile.period_x_m;
  bed.period_y_m = ny * tile.period_y_m;
  bed.state = {};
  const auto n = std::uint32_t(tile.state.grains.size());
  const auto number = [&](int x, int y) { return std::uint32_t(y * nx + x); };
  for (int y = 0; y < ny; ++y) {
    for (int x = 0; x < nx; ++x) {
      for (Grain g : tile.state.grains) {
        g.id += number(x, y) * n;
        g.p_m.x() += x * tile.period_x_m;
        g.p_m.y() += y * tile.period_y_m;
        bed.state.grains.push_back(g);
      }
      for (const GrainContact& c : tile.state.contacts) {
        GrainContact copy = c;
        copy.i += number(x, y) * n;
        if (c.j < GrainContact::kWallContact) {
          // The partner may be the nearest image in the tile beside.
          const Eigen::Vector3d d = tile.state.grains[c.j].p_m - tile.state.grains[c.i].p_m;
          const int at_x = (x - int(std::lround(d.x() / tile.period_x_m)) + nx) % nx;
          const int at_y = (y - int(std::lround(d.y() / tile.period_y_m)) + ny) % ny;
          copy.j += number(at_x, at_y) * n;
          if (copy.j < copy.i) {
            std::swap(copy.i, copy.j);
            copy.xi_m = -copy.xi_m;
          }
        }
        bed.state.contacts.push_back(copy);
      }
    }
  }
  std::sort(bed.state.contacts.begin(), bed.state.contacts.end(),
            [](const GrainContact& a, const GrainContact& b) {
              return a.i != b.i ? a.i < b.i : a.j < b.j;
            });
  return bed;
}

DemSettings settings_for(const PeriodicBed& bed, hoof::sim::Precision precision, int threads) {
  DemSettings s;
  s.low_m = {0, 0, -0.01};
  s.high_m = {bed.period_x_m, bed.period_y_m, bed.surface_m + 0.1};
  s.periodic = {true, true, false};
  s.walls = {{Eigen::Vector3d::UnitZ(), 0}};
  // Sand and ABS of the paper, table 2 (see sim/config/materials/paper.toml).
  s.grain_material = {178.5e6, 0.25, 2650};
  s.wall_material = {2.02e9, 0.37, 1050};
  s.grain_grain = {0.54, 0.52, 0.34};
  s.grain_wall = {0.5636, 0.5929, 0.0408};
  s.dt_s = 2.8e-6;
  s.precision = precision;
  s.threads = threads;
  return s;
}

}  // namespace hoof::benchmarks
