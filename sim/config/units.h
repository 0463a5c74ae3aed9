// Units of the keys of settings files, each with its factor to SI.
#pragma once

#include <numbers>
#include <string_view>

namespace hoof::sim {

/// value_SI = value * numerator / denominator. A ratio, because 175 mm / 1000 is exactly the double
/// nearest to 0.175 m while 175 * 0.001 is not.
struct Unit {
  /// As it ends a key: "mm" in width_mm. Empty where a number has no unit.
  std::string_view suffix;
  double numerator = 1.0;
  double denominator = 1.0;

  constexpr double to_si(double value) const { return value * numerator / denominator; }
};

inline constexpr Unit kUnitless{""};
inline constexpr Unit kMetre{"m"};
inline constexpr Unit kMillimetre{"mm", 1.0, 1e3};
inline constexpr Unit kMicrometre{"um", 1.0, 1e6};
inline constexpr Unit kDegree{"deg", std::numbers::pi, 180.0};
inline constexpr Unit kRadian{"rad"};
inline constexpr Unit kSecond{"s"};
inline constexpr Unit kMillisecond{"ms", 1.0, 1e3};
inline constexpr Unit kMicrosecond{"us", 1.0, 1e6};
inline constexpr Unit kHertz{"Hz"};
inline constexpr Unit kKilogram{"kg"};
inline constexpr Unit kGram{"g", 1.0, 1e3};
inline constexpr Unit kKilogramPerCubicMetre{"kg_m3"};
inline constexpr Unit kGramSquareCentimetre{"g_cm2", 1.0, 1e7};
inline constexpr Unit kNewton{"N"};
inline constexpr Unit kNewtonPerCubicMetre{"N_m3"};
inline constexpr Unit kNewtonPerMetre{"N_m"};
inline constexpr Unit kNewtonSecondPerMetre{"N_s_m"};
inline constexpr Unit kNewtonMetre{"Nm"};
inline constexpr Unit kNewtonMetrePerRadian{"Nm_rad"};
inline constexpr Unit kNewtonMetreSecondPerRadian{"Nm_s_rad"};
inline constexpr Unit kPascal{"Pa"};
inline constexpr Unit kMegapascal{"MPa", 1e6};
inline constexpr Unit kGigapascal{"GPa", 1e9};
inline constexpr Unit kMetrePerSecond{"m_s"};
inline constexpr Unit kMillimetrePerSecond{"mm_s", 1.0, 1e3};
inline constexpr Unit kMetrePerSecondSquared{"m_s2"};
inline constexpr Unit kRadianPerSecond{"rad_s"};
inline constexpr Unit kRevolutionPerMinute{"rpm", 2.0 * std::numbers::pi, 60.0};
inline constexpr Unit kWattPerSquareNewtonMetre{"W_Nm2"};
inline constexpr Unit kKelvinPerWatt{"K_W"};
inline constexpr Unit kJoulePerKelvin{"J_K"};
inline constexpr Unit kCelsius{"C"};
inline constexpr Unit kJoule{"J"};

/// Acceleration of free fall, used for "kg" of load, the bodies and the grains alike. The paper
/// rounds to 9.81; its settled results differ by less than 0.04 % from 9.80665.
inline constexpr double kGravity_m_s2 = 9.81;

}  // namespace hoof::sim
