// A plate pressed into level sand, or against a rigid block: force over height, travel over force.
//
// Symbol     Meaning                                                    Unit
// A          area of the plate                                          m2
// b          its smaller dimension; the radius of a disc                m
// k_c k_phi  Bekker's moduli                          N/m^(n+1), N/m^(n+2)
// n          Bekker's exponent                                          1
// z          depth = surface height - height of the plate               m
//
// Bekker: Introduction to terrain-vehicle systems. University of Michigan Press, 1969.
#pragma once

#include <span>
#include <vector>

#include "sim/effects/soil_effect.h"

namespace hoof::sim {

struct PlateSize {
  double area_m2 = 0;  // A
  double width_m = 0;  // b
};

PlateSize disc(double diameter_m);
PlateSize rectangle(double width_m, double length_m);

struct BekkerSoil {
  double k_c = 0;
  double k_phi = 0;
  double n = 1;
};

/// A (k_c/b + k_phi), N/m^n; zero where negative.
double plate_stiffness(const PlateSize& plate, const BekkerSoil& soil);

/// What the carriage did, one entry per sample.
struct PressPath {
  std::vector<double> time_s;     // since the recording began
  std::vector<double> height_m;   // up positive
  std::vector<double> speed_m_s;  // downward
  std::vector<int> press;         // how many presses of the sand went before
};

struct PressBench {
  PlateSize plate;
  BekkerSoil soil;
  double surface_height_m = 0;
  double wall_distance_m = 0;  // 0: not known
};

/// Push force at each sample: A (k_c/b + k_phi) z^n below the surface, the same when drawn back,
/// zero above, and what effects make of it. Where the rig travels under its force, z is what is
/// left: z = surface_height - height - travel(force).
std::vector<double> press_sand_N(const PressBench& bench, const PressPath& path,
                                 SoilEffects effects);

/// Height of the carriage on a rigid block under each force: it stays at the height of contact,
/// less what the rig itself travels.
std::vector<double> press_block_m(double contact_height_m, std::span<const double> force_N,
                                  SoilEffects effects);

}  // namespace hoof::sim
