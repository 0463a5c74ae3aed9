#include "tools/materials/starting_text.h"

#include <cmath>
#include <numbers>

#include "tools/calibrate/heap_lab.h"
#include "tools/calibrate/lab_text.h"

namespace hoof::tools {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kAlike_deg = 3;
constexpr double kAlikeShare = 0.1;
// Quartz, feldspar and basalt lie within this of quartz.
constexpr double kMineralShare = 0.15;

/// What would tell one coefficient alone.
const std::vector<std::string> kTests = {"rebound of a grain from a grain (e)",
                                         "a drum or a roll of grains on a bed of them (mu_r)",
                                         "a shear box, or grains tilted on a bed of them (mu_s)"};

std::string left_text(const Valley& v, const std::vector<Factor>& factors) {
  std::string out = "  a second test of one coefficient alone leaves:\n";
  const auto most = std::size_t(v.most_telling());
  for (std::size_t f = 0; f < factors.size(); ++f) {
    out += text("    %-5s to +- %-6.3g %5.1f %% of the set; of their ranges",
                factors[f].name.c_str(), v.left[f].doubt, 100 * v.left[f].share);
    for (std::size_t o = 0; o < factors.size(); ++o) {
      if (o != f) out += text(" %s %.0f %%", factors[o].name.c_str(), 100 * v.left[f].width[o]);
    }
    out += f == most ? "   <- narrows it most\n" : "\n";
  }
  // A set that is long in one coefficient is cut most by knowing that one, which may tell nothing
  // of the others: both are said.
  const auto others = [&v](std::size_t f) {
    double sum = 0;
    for (std::size_t o = 0; o < v.left[f].width.size(); ++o) sum += o == f ? 0 : v.left[f].width[o];
    return sum;
  };
  std::size_t least = 0;
  for (std::size_t f = 1; f < factors.size(); ++f) {
    if (others(f) < others(least)) least = f;
  }
  return out + "  so measure next: " + kTests[most] + " for the smallest set;\n  " + kTests[least] +
         " to tell most of the other two\n";
}

std::string alike(const std::string& name, const std::string& about,
                  const std::optional<sim::Measured>& repose,
                  const std::optional<sim::Measured>& bulk, const StartingRequest& request) {
  const bool angle = repose && std::abs(repose->value / kDegree - request.repose_deg) <= kAlike_deg;
  const bool dense = bulk && std::abs(bulk->value / request.bulk_density_kg_m3 - 1) <= kAlikeShare;
  if (!angle && !dense) return "";
  std::string out = "  " + name + ":";
  if (repose) out += text(" %.4g degrees", repose->value / kDegree);
  if (bulk) out += text(" %.0f kg/m3 in bulk", bulk->value);
  return out + "; " + about + "\n";
}

}  // namespace

std::string density_text(const StartingRequest& request) {
  const double grain = request.grain_density_kg_m3();
  std::string out = text(
      "Grain density %.0f kg/m3: %.0f kg/m3 in bulk over %.3f, the solid share of a bed of this "
      "engine\nat the paper's size (hoof bed make --bed paper). Grains of quartz, %.0f kg/m3, "
      "would "
      "fill %.3f.\n",
      grain, request.bulk_density_kg_m3, kSolidShare, kQuartz_kg_m3,
      request.bulk_density_kg_m3 / kQuartz_kg_m3);
  if (std::abs(grain / kQuartz_kg_m3 - 1) > kMineralShare) {
    out +=
        "Warning: hardly a mineral's. The sand lies looser or denser than our beds; measure its "
        "grain density.\n";
  }
  if (request.d50_m) {
    const double d50_m = heap_geometry({}).d50_m;
    out += text(
        "Grains of d50 %.3g mm stand for yours of %.3g mm, %.3g times as large; the height of "
        "fall counts in grains too.\n",
        1e3 * d50_m, 1e3 * *request.d50_m, d50_m / *request.d50_m);
  }
  return out;
}

std::string range_text(const ReposeSurface& s, const StartingRequest& request,
                       const StartingRange& range) {
  std::string out = "By " + s.name + " (" + s.made_of + "):\n";
  if (!range.covered) {
    out += text(
        "  Warning: %.4g degrees lie outside the %.1f to %.1f of these heaps; what follows is "
        "extrapolated.\n",
        request.repose_deg, s.lowest_deg, s.highest_deg);
  }
  if (range.members.empty()) {
    return out +
           text(
               "  nothing with e 0.1 to 0.8, mu_r 0.1 to 0.4, mu_s 0.2 to 0.9 gives %.4g +- %.3g "
               "degrees\n",
               request.repose_deg, request.tolerance_deg);
  }
  const Valley& v = range.valley;
  const std::vector<Factor>& factors = s.surface.factors();
  out += text("  %.4g +- %.3g degrees: %.1f %% of the box cannot be told apart\n",
              request.repose_deg, request.tolerance_deg, 100 * v.share);
  for (std::size_t f = 0; f < factors.size(); ++f) {
    out += text("    %-5s from %.3f to %.3f, %.0f %% of its range\n", factors[f].name.c_str(),
                v.low[f], v.high[f],
                100 * (v.high[f] - v.low[f]) / (factors[f].high - factors[f].low));
  }
  out += "  to begin with, its middle and two far apart:\n";
  for (const StartingRange::Member& m : range.members) {
    out += text("    e %.3f  mu_r %.3f  mu_s %.3f   %.2f +- %.2f degrees by the surface (95 %%)\n",
                m.restitution, m.rolling_friction, m.static_friction, m.angle_deg, m.half95_deg);
  }
  return out + left_text(v, factors);
}

std::string alike_text(const Shelf& shelf, const StartingRequest& request) {
  std::string out;
  for (const sim::MaterialCard& c : shelf.cards) {
    out += alike(c.name, c.about, c.repose_rad, c.bulk_density_kg_m3, request);
  }
  for (const Shelf::MeasuredSand& s : shelf.measured) {
    out += alike(s.id, s.about, s.repose_rad, s.bulk_density_kg_m3, request);
  }
  return "Sands like it (within 3 degrees, or a tenth of the bulk density):\n" +
         (out.empty() ? "  none\n" : out);
}

}  // namespace hoof::tools
