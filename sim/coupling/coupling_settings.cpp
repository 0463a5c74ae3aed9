#include "sim/coupling/coupling_settings.h"

#include <sstream>
#include <stdexcept>

namespace hoof::sim {

void CouplingSettings::validate() const {
  const auto positive = [](double value, const char* name) {
    if (value > 0.0) return;
    std::ostringstream text;
    text << name << " = " << value << ": must be above 0";
    throw std::invalid_argument(text.str());
  };
  positive(exchange_s, "exchange_s");
  positive(sleep_margin_m, "sleep_margin_m");
  positive(speed_limit_m_s, "speed_limit_m_s");
  positive(energy_error_limit_J, "energy_error_limit_J");
}

CouplingSettings read_coupling(Reader section) {
  CouplingSettings coupling;
  std::string name;
  section.text("name", name);
  // A control tick of 1 ms holds a whole number of exchanges; whoever builds the loop checks that.
  section.number("exchange_us", coupling.exchange_s, kMicrosecond, 1.0, 1000.0);
  section.number("sleep_margin_mm", coupling.sleep_margin_m, kMillimetre, 0.1, 100.0);
  section.number("speed_limit_m_s", coupling.speed_limit_m_s, kMetrePerSecond, 0.1, 1000.0);
  section.number("energy_error_limit_J", coupling.energy_error_limit_J, kJoule, 1e-3, 1e4);
  section.finish();
  section.check([&coupling] { coupling.validate(); });
  return coupling;
}

}  // namespace hoof::sim
