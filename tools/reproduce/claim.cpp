#include "tools/reproduce/claim.h"

#include <algorithm>
#include <cmath>

#include "tools/reproduce/paper.h"

namespace hoof::tools {
namespace {

using Runs = std::vector<Outcome>;

const std::string kSpined = "bionic-toe0", kPlain = "bionic-plain-toe0", kSole = "traditional";
const std::vector<std::string> kSpeeds = {"0.1m_s", "0.4m_s"}, kLoads = {"10kg", "40kg"},
                               kSteps = {"0.45Hz", "1.12Hz"};
const std::vector<std::pair<std::string, std::string>> kFeet = {
    {kSpined, "spined"}, {kPlain, "plain"}, {kSole, "traditional"}};

std::string sinkage(const std::string& foot, const std::string& load, const std::string& speed) {
  return "sinkage-" + foot + "-" + load + "-" + speed;
}
std::string traction(const std::string& foot, const std::string& step) {
  return "traction-" + foot + "-" + step;
}
std::string open(int deg) {
  return "bionic-toe" + std::to_string(deg);
}

using Value = double Outcome::*;

/// Infinite where something is over nothing; NaN where both are nothing or one is not known.
double ratio_of(double above, double below) {
  return below != 0 || above > 0 ? above / below : NAN;
}

double paper_value(const std::string& condition, Value value) {
  if (value == &Outcome::sinkage_mm) return paper_sinkage_mm(condition);
  if (condition.starts_with("sinkage")) return NAN;
  if (value == &Outcome::fx_peak_s) return NAN;  // it gives no times
  const PaperTraction stated = paper_traction(condition);
  const double number = value == &Outcome::coefficient       ? stated.coefficient
                        : value == &Outcome::fz_at_fx_peak_N ? stated.fz_at_fx_peak_N
                                                             : stated.fx_peak_N;
  return number > 0 ? number : NAN;
}

/// One condition's value over another's, claimed to be below or above 1.
Contrast ratio(const std::string& name, const std::string& above, const std::string& under,
               Value value, bool below) {
  return {name,
          {above, under},
          [value](const Runs& runs) { return ratio_of(runs[0].*value, runs[1].*value); },
          below,
          1,
          ratio_of(paper_value(above, value), paper_value(under, value)),
          true};
}

Claim best_opening() {
  Claim claim{"30-best", "at 60 kg the foot sinks least with its toes opened by 30 degrees", {}};
  for (const int deg : {0, 10, 20, 40}) {
    claim.contrasts.push_back(
        ratio("sinkage at 30 over " + std::to_string(deg) + " degrees, 60 kg, 0.1 m/s",
              sinkage(open(30), "60kg", "0.1m_s"), sinkage(open(deg), "60kg", "0.1m_s"),
              &Outcome::sinkage_mm, true));
  }
  return claim;
}

Claim opening_helps() {
  Claim claim{
      "opening-helps", "opened by 30 degrees the foot sinks less than closed, at 60 kg", {}};
  for (const std::string& speed : kSpeeds) {
    claim.contrasts.push_back(ratio("sinkage at 30 over 0 degrees, 60 kg, " + speed,
                                    sinkage(open(30), "60kg", speed),
                                    sinkage(open(0), "60kg", speed), &Outcome::sinkage_mm, true));
  }
  return claim;
}

/// Sinkage of one foot under another's at both loads and speeds.
Claim sinks_less(const std::string& name, const std::string& statement, const std::string& foot,
                 const std::string& than, const std::string& words) {
  Claim claim{name, statement, {}};
  for (const std::string& load : kLoads) {
    for (const std::string& speed : kSpeeds) {
      claim.contrasts.push_back(ratio("sinkage, " + words + ", " + load + ", " + speed,
                                      sinkage(foot, load, speed), sinkage(than, load, speed),
                                      &Outcome::sinkage_mm, true));
    }
  }
  return claim;
}

Claim speed_effect() {
  Claim claim{"faster-deeper", "every foot sinks deeper at 0.4 than at 0.1 m/s", {}};
  for (const auto& [foot, words] : kFeet) {
    for (const std::string& load : kLoads) {
      claim.contrasts.push_back(ratio("sinkage at 0.4 over 0.1 m/s, " + words + ", " + load,
                                      sinkage(foot, load, "0.4m_s"), sinkage(foot, load, "0.1m_s"),
                                      &Outcome::sinkage_mm, false));
    }
  }
  return claim;
}

/// A value of one foot against another's at both step frequencies.
Claim pulls(const std::string& name, const std::string& statement, const std::string& what,
            const std::string& foot, const std::string& than, Value value, bool below) {
  Claim claim{name, statement, {}};
  for (const std::string& step : kSteps) {
    claim.contrasts.push_back(
        ratio(what + ", " + step, traction(foot, step), traction(than, step), value, below));
  }
  return claim;
}

Claim frequency_effect() {
  Claim claim{"frequency-force", "forces are greater at 1.12 than at 0.45 Hz, for every foot", {}};
  for (const auto& [foot, words] : kFeet) {
    for (const auto& [value, force] :
         {std::pair{&Outcome::fx_peak_N, "Fx"}, {&Outcome::fz_at_fx_peak_N, "Fz"}}) {
      claim.contrasts.push_back(ratio(std::string(force) + " at 1.12 over 0.45 Hz, " + words,
                                      traction(foot, "1.12Hz"), traction(foot, "0.45Hz"), value,
                                      false));
    }
  }
  return claim;
}

Claim flat_in_angle() {
  Claim claim{
      "T-flat", "the traction coefficient hardly changes with the opening (within 10 %)", {}};
  const auto range = [](const Runs& runs) {
    double least = INFINITY, most = -INFINITY, sum = 0;
    for (const Outcome& run : runs) {
      least = std::min(least, run.coefficient), most = std::max(most, run.coefficient);
      sum += run.coefficient;
    }
    return ratio_of((most - least) * double(runs.size()), sum);
  };
  for (const std::string& step : kSteps) {
    Contrast c{"range of T over openings by its mean, " + step, {}, range, true, 0.10, NAN};
    Runs stated;
    for (const int deg : {0, 10, 20, 30, 40}) {
      c.conditions.push_back(traction(open(deg), step));
      stated.emplace_back().coefficient = paper_traction(c.conditions.back()).coefficient;
    }
    c.paper = range(stated);
    claim.contrasts.push_back(c);
  }
  return claim;
}

Claim forces_by_angle() {
  Claim claim{"forces-20-30", "the peak of Fx is higher at 20 and 30 degrees than at 0 and 40", {}};
  for (const std::string& step : kSteps) {
    for (const int high : {20, 30}) {
      for (const int low : {0, 40}) {
        claim.contrasts.push_back(ratio(
            "Fx at " + std::to_string(high) + " over " + std::to_string(low) + " degrees, " + step,
            traction(open(high), step), traction(open(low), step), &Outcome::fx_peak_N, false));
      }
    }
  }
  return claim;
}

Claim best_pull() {
  Claim claim{"T-best-at-40", "the traction coefficient is highest at 40 degrees", {}};
  for (const std::string& step : kSteps) {
    for (const int deg : {0, 10, 20, 30}) {
      claim.contrasts.push_back(ratio("T at 40 over " + std::to_string(deg) + " degrees, " + step,
                                      traction(open(40), step), traction(open(deg), step),
                                      &Outcome::coefficient, false));
    }
  }
  return claim;
}

/// The paper states neither load nor threshold; the threshold here is that of tools/fields.
Claim pressure_share() {
  Contrast c = ratio("share of high pressure at 30 over 0 degrees, 60 kg, 0.1 m/s",
                     sinkage(open(30), "60kg", "0.1m_s"), sinkage(open(0), "60kg", "0.1m_s"),
                     &Outcome::high_pressure_share, true);
  c.paper = 23.77 / 32.48;
  return {
      "pressure-falls", "opened by 30 degrees less of the sole has high pressure than closed", {c}};
}

/// What would have to be so if an arch were the cause: it carries most at 30 degrees, and more sand
/// carries than the foot alone covers when closed.
Claim arch_bridge() {
  Claim claim{"arch-at-30", "an arch of sand between the toes makes 30 degrees the best", {}};
  const std::string at30 = sinkage(open(30), "60kg", "0.1m_s");
  claim.contrasts.push_back(
      ratio("area of sand that carries over the foot's, at 30 over 0 degrees, 60 kg, 0.1 m/s", at30,
            sinkage(open(0), "60kg", "0.1m_s"), &Outcome::support_area_ratio, false));
  for (const int deg : {20, 40}) {
    claim.contrasts.push_back(ratio("stress in the gap over that under the foot, at 30 over " +
                                        std::to_string(deg) + " degrees, 60 kg, 0.1 m/s",
                                    at30, sinkage(open(deg), "60kg", "0.1m_s"),
                                    &Outcome::gap_stress_ratio, false));
  }
  return claim;
}

Claim earlier_peak() {
  return pulls("spines-earlier", "with spines Fx peaks earlier in a stance than without",
               "time of the peak of Fx since first contact, spined over plain", kSpined, kPlain,
               &Outcome::fx_peak_s, true);
}

}  // namespace

const std::vector<Claim>& paper_claims() {
  static const std::vector<Claim> claims = {
      best_opening(),
      opening_helps(),
      sinks_less("bionic-sinks-less", "the bionic foot sinks less than the traditional one",
                 kSpined, kSole, "spined over traditional"),
      sinks_less("spines-stiffen", "with spines the foot sinks less than without", kSpined, kPlain,
                 "spined over plain"),
      speed_effect(),
      pulls("spines-raise-T", "spines raise the traction coefficient", "T, spined over plain",
            kSpined, kPlain, &Outcome::coefficient, false),
      pulls("bionic-raises-T", "the bionic foot has a higher traction coefficient",
            "T, spined over traditional", kSpined, kSole, &Outcome::coefficient, false),
      pulls("spines-lower-Fz", "spines lower Fz at the peak of Fx", "Fz, spined over plain",
            kSpined, kPlain, &Outcome::fz_at_fx_peak_N, true),
      pulls("plain-T-lower",
            "without spines the bionic foot's T is below the traditional one's (in its table)",
            "T, plain over traditional", kPlain, kSole, &Outcome::coefficient, true),
      earlier_peak(),
      frequency_effect(),
      flat_in_angle(),
      best_pull(),
      forces_by_angle(),
      pressure_share(),
      arch_bridge()};
  return claims;
}

std::optional<Evidence> weigh(const Contrast& contrast, const Outcomes& outcomes) {
  const auto first = outcomes.find(contrast.conditions.front());
  if (first == outcomes.end()) return {};
  Evidence evidence;
  std::vector<double> values;
  for (const auto& [bed, run] : first->second) {
    Runs runs;
    for (const std::string& condition : contrast.conditions) {
      const auto of = outcomes.find(condition);
      if (of == outcomes.end() || of->second.count(bed) == 0) break;
      runs.push_back(of->second.at(bed));
    }
    if (runs.size() != contrast.conditions.size()) continue;
    const double value = contrast.effect(runs);
    if (std::isinf(value)) ++evidence.infinite;
    if (!std::isfinite(value)) continue;
    values.push_back(value);
    evidence.beds.push_back(bed);
  }
  if (values.empty()) return {};
  evidence.logarithms = contrast.ratio && *std::min_element(values.begin(), values.end()) > 0;
  if (evidence.logarithms) {
    for (double& value : values) value = std::log(value);
  }
  evidence.sample = sample_of(values);
  return evidence;
}

double Evidence::mean() const {
  return logarithms ? std::exp(sample.mean) : sample.mean;
}

double Evidence::low() const {
  const double end = sample.mean - sample.confidence;
  return logarithms ? std::exp(end) : end;
}

double Evidence::high() const {
  const double end = sample.mean + sample.confidence;
  return logarithms ? std::exp(end) : end;
}

double Evidence::margin(const Contrast& contrast) const {
  const double bound = logarithms ? std::log(contrast.bound) : contrast.bound;
  return (contrast.below ? bound - sample.mean : sample.mean - bound) / sample.confidence;
}

bool holds(const Contrast& contrast, const Evidence& evidence) {
  if (contrast.below && evidence.infinite > 0) return false;
  // Comparisons with the NaN of a single bed are false.
  return contrast.below ? evidence.high() < contrast.bound : evidence.low() > contrast.bound;
}

Finding find(const Claim& claim, const Outcomes& outcomes) {
  Finding finding = Finding::kHolds;
  for (const Contrast& contrast : claim.contrasts) {
    const auto evidence = weigh(contrast, outcomes);
    // One bed neither shows an effect nor that there is none.
    if (!evidence || evidence->beds.size() < 2) {
      if (finding == Finding::kHolds) finding = Finding::kNotRun;
    } else if (!holds(contrast, *evidence)) {
      finding = Finding::kFails;
    }
  }
  return finding;
}

Verdict judge(Finding base, const std::vector<Finding>& varied) {
  if (base == Finding::kFails) return Verdict::kUnsupported;
  if (base == Finding::kNotRun) return Verdict::kOpen;
  const auto any = [&](Finding f) { return std::find(varied.begin(), varied.end(), f); };
  if (any(Finding::kFails) != varied.end()) return Verdict::kFragile;
  if (varied.empty() || any(Finding::kNotRun) != varied.end()) return Verdict::kOpen;
  return Verdict::kSupported;
}

std::string to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::kSupported:
      return "supported";
    case Verdict::kFragile:
      return "fragile";
    case Verdict::kUnsupported:
      return "unsupported";
    case Verdict::kOpen:
      return "open";
  }
  return "";
}

}  // namespace hoof::tools
