#include "tools/conceal/servo_terms.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <stdexcept>

namespace hoof::tools::conceal {
namespace {

using Fields = std::vector<std::pair<const char*, double ServoTerms::*>>;
using T = ServoTerms;

const std::map<std::string, Fields>& fields_of_effects() {
  static const std::map<std::string, Fields> fields = {
      {"stribeck_friction", {{"extra", &T::stribeck_extra}, {"speed", &T::stribeck_speed}}},
      {"load_dependent_friction", {{"coefficient", &T::load_coefficient}}},
      {"directional_friction", {{"asymmetry", &T::asymmetry}}},
      {"backlash", {{"gap", &T::gap}}},
      {"joint_compliance", {{"stiffness", &T::stiffness}}},
      {"cogging_torque",
       {{"amplitude", &T::cogging}, {"order", &T::cogging_order}, {"phase", &T::cogging_phase}}},
      {"torque_ceiling", {{"ceiling", &T::ceiling}}},
      {"supply_sag", {{"resistance", &T::sag_resistance}}},
      {"thermal_derating",
       {{"fraction", &T::derating},
        {"time_constant", &T::heat_time},
        {"_reference", &T::heat_reference}}},
      {"actuator_lag", {{"time_constant", &T::lag_time}}},
      {"transport_delay", {{"delay", &T::delay}}},
      {"encoder_eccentricity",
       {{"amplitude", &T::eccentricity}, {"phase", &T::eccentricity_phase}}},
      {"parasitic_spring", {{"stiffness", &T::spring}, {"rest", &T::spring_rest}}},
      {"frame_loss", {{"probability", &T::loss_probability}, {"burst", &T::loss_burst}}},
      {"quadratic_drag", {{"coefficient", &T::drag}}},
      {"rough_spot_friction",
       {{"share", &T::rough}, {"order", &T::rough_order}, {"phase", &T::rough_phase}}},
      {"presliding_bristles", {{"slip", &T::bristle_slip}}},
      {"torque_dead_zone", {{"width", &T::dead_zone}}},
      {"sliding_payload", {{"at", &T::slide_at}, {"by", &T::slide_by}}},
      {"dropped_payload", {{"at", &T::drop_at}, {"by", &T::drop_by}}},
      {"hardening_spring", {{"coefficient", &T::hardening}, {"rest", &T::hardening_rest}}},
      {"periodic_disturbance", {{"amplitude", &T::hum}, {"frequency", &T::hum_frequency}}},
      {"drifting_friction", {{"growth", &T::wear_in}, {"time", &T::wear_time}}},
      {"uneven_motor", {{"share", &T::uneven}}},
      {"speed_loss", {{"share", &T::fast_loss}, {"speed", &T::fast_speed}}},
      {"end_stop", {{"at", &T::stop_at}, {"stiffness", &T::stop_stiffness}}},
      {"torque_ripple", {{"share", &T::ripple}, {"order", &T::ripple_order}}},
      {"swinging_load", {{"share", &T::swing_share}, {"frequency", &T::swing_frequency}}},
      {"magnetic_detent",
       {{"amplitude", &T::detent}, {"at", &T::detent_at}, {"width", &T::detent_width}}},
      {"late_sensor", {{"delay", &T::late_sensor}}},
  };
  return fields;
}

/// How far motor and link go apart, as torque: of the link's inertia and of its gravity.
double parting(const ServoTerms&, const ServoMachine& m, const ServoMoment& s) {
  return std::abs(m.link_inertia_kgm2() * (s.acceleration - s.link_acceleration)) +
         std::abs(m.gravity_torque_Nm() * (std::sin(s.position) - std::sin(s.link_position)));
}

double lost_torque(const ServoTerms&, const ServoMachine&, const ServoMoment& s) {
  return std::abs(s.commanded_Nm - s.delivered_Nm);
}

using Strength = std::function<double(const T&, const ServoMachine&, const ServoMoment&)>;

const std::map<std::string, Strength>& listed_strengths() {
  using M = ServoMachine;
  using S = ServoMoment;
  static const std::map<std::string, Strength> strengths = {
      {"stribeck_friction",
       [](const T& e, const M&, const S& s) {
         const double x = s.velocity / e.stribeck_speed;
         return e.stribeck_extra * std::exp(-x * x);
       }},
      {"load_dependent_friction",
       [](const T& e, const M&, const S& s) {
         return e.load_coefficient * std::abs(s.delivered_Nm - s.outer_Nm);
       }},
      // The same size both ways: it matters where the joint moves, most where it turns round.
      {"directional_friction",
       [](const T& e, const M& m, const S& s) {
         return e.asymmetry * m.coulomb_Nm * std::tanh(std::abs(s.velocity) / 0.05) +
                1e-3 * std::abs(s.acceleration) * m.inertia_kgm2();
       }},
      {"backlash", parting},
      {"joint_compliance", parting},
      {"cogging_torque",
       [](const T& e, const M&, const S& s) {
         return std::abs(e.cogging * std::sin(e.cogging_order * s.position + e.cogging_phase));
       }},
      {"torque_ceiling", lost_torque},
      {"supply_sag",
       [](const T&, const M&, const S& s) { return std::abs(s.unsagged_Nm - s.commanded_Nm); }},
      {"thermal_derating", lost_torque},
      {"actuator_lag", lost_torque},
      {"transport_delay",
       [](const T&, const M&, const S& s) { return std::abs(s.goal - s.seen_goal); }},
      {"encoder_eccentricity",
       [](const T& e, const M&, const S& s) {
         return std::abs(e.eccentricity * std::sin(s.position + e.eccentricity_phase));
       }},
      {"parasitic_spring",
       [](const T& e, const M&, const S& s) {
         return std::abs(e.spring * (s.link_position - e.spring_rest));
       }},
      {"frame_loss", [](const T&, const M&, const S& s) { return std::abs(s.goal - s.seen_goal); }},
  };
  return strengths;
}

}  // namespace

ServoTerms terms_of(const std::vector<HiddenEffect>& hidden) {
  ServoTerms terms;
  for (const HiddenEffect& effect : hidden) {
    const auto fields = fields_of_effects().find(effect.name);
    if (fields == fields_of_effects().end()) {
      throw std::logic_error("the servo plant knows no effect " + effect.name);
    }
    for (const auto& [name, field] : fields->second) terms.*field = effect.at(name);
  }
  return terms;
}

double strength(const std::string& effect, const ServoTerms& terms, const ServoMachine& machine,
                const ServoMoment& moment) {
  const auto found = listed_strengths().find(effect);
  return found == listed_strengths().end() ? 0.0 : found->second(terms, machine, moment);
}

}  // namespace hoof::tools::conceal
