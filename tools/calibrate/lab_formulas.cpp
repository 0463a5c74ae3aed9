#include "tools/calibrate/lab_formulas.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hoof::tools {

double rolling_acceleration_m_s2(double theta_rad, double mu_r, double inertia) {
  const double drive = std::sin(theta_rad) - mu_r * std::cos(theta_rad);
  return std::max(0.0, kGravity_m_s2 * drive / (1 + inertia));
}

double friction_to_roll(double theta_rad, double mu_r) {
  return (kSolidSphere * std::tan(theta_rad) + mu_r) / (1 + kSolidSphere);
}

double flight_travel_m(double vx_m_s, double vz_m_s, double fall_m) {
  const double time_s =
      (vz_m_s + std::sqrt(vz_m_s * vz_m_s + 2 * kGravity_m_s2 * fall_m)) / kGravity_m_s2;
  return vx_m_s * time_s;
}

double roll_travel_m(double theta_rad, double run_m, double fall_m, double mu_r, double inertia) {
  const double v = std::sqrt(2 * rolling_acceleration_m_s2(theta_rad, mu_r, inertia) * run_m);
  return flight_travel_m(v * std::cos(theta_rad), -v * std::sin(theta_rad), fall_m);
}

double rolling_friction_of(double travel_m, double theta_rad, double run_m, double fall_m,
                           double inertia) {
  double low = 0, high = std::tan(theta_rad);  // the travel falls from its largest to 0
  if (!(travel_m > 0 && travel_m <= roll_travel_m(theta_rad, run_m, fall_m, low, inertia))) {
    throw std::invalid_argument("no rolling friction gives this travel");
  }
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (roll_travel_m(theta_rad, run_m, fall_m, middle, inertia) > travel_m ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace hoof::tools
