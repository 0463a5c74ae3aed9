#include "tools/diagnose/quality.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "tools/diagnose/noise.h"
#include "tools/diagnose/quality_checks.h"
#include "tools/diagnose/series.h"
#include "tools/diagnose/verdict_text.h"

namespace hoof::tools {
namespace {

/// More recordings than that with the same finding, and it is said once.
constexpr std::size_t kMostAlike = 2;
// In noise sigma: 98 % of normal noise lies within 4.7, and all of 1e6 samples within 10.
constexpr double kMovesMostly = 6, kMovesOnce = 12;

std::vector<QualityNote> merged(const std::vector<QualityFinding>& findings) {
  std::vector<QualityNote> notes;
  std::vector<bool> done(findings.size());
  for (std::size_t i = 0; i < findings.size(); ++i) {
    if (done[i]) continue;
    std::vector<std::size_t> alike;
    for (std::size_t j = i; j < findings.size(); ++j) {
      const bool same = findings[j].kind == findings[i].kind &&
                        findings[j].note.channel == findings[i].note.channel;
      if (same) alike.push_back(j);
    }
    if (alike.size() <= kMostAlike) {
      notes.push_back(findings[i].note);
      continue;
    }
    std::size_t worst = i;
    bool serious = false;
    for (const std::size_t j : alike) {
      done[j] = true;
      serious = serious || findings[j].note.serious;
      if (findings[j].weight > findings[worst].weight) worst = j;
    }
    QualityNote note = findings[worst].note;
    note.serious = serious;
    std::set<std::string> recordings;
    for (const std::size_t j : alike) recordings.insert(findings[j].note.recording);
    note.text += " (worst of " + std::to_string(recordings.size()) + " recordings where it is so)";
    notes.push_back(std::move(note));
  }
  std::stable_partition(notes.begin(), notes.end(), [](const auto& n) { return n.serious; });
  return notes;
}

}  // namespace

std::string quality_number(double value, const std::string& unit) {
  return with_unit(value, unit);
}

void QualityCase::say(const std::string& kind, const std::string& channel, double weight,
                      bool serious, const std::string& text) const {
  findings.push_back({kind, {recording.name, channel, text, serious}, weight});
}

double QualityCase::noise(const std::string& channel) const {
  const auto stated = set.noise.find(channel);
  if (stated != set.noise.end()) return stated->second;
  const auto values = recording.channels.find(channel);
  return values == recording.channels.end() ? 0 : estimate_noise(recording.time_s, values->second);
}

bool QualityCase::moves(const std::string& channel) const {
  const auto values = recording.channels.find(channel);
  if (values == recording.channels.end()) return false;
  const Series& x = values->second;
  const double sigma = noise(channel);
  return quantile(x, 0.99) - quantile(x, 0.01) > kMovesMostly * sigma ||
         range_of(x) > kMovesOnce * sigma;
}

std::string QualityCase::unit(const std::string& channel) const {
  return channel_unit(set.rig, channel);
}

std::vector<QualityNote> check_quality(const DataSet& set) {
  if (set.rig == RigKind::kFootHil) return {};  // this project's own bus, checked as it is recorded
  std::vector<QualityFinding> findings;
  for (const Recording& recording : set.recordings) {
    const QualityCase c{set, recording, findings};
    check_time(c);
    check_samples(c);
    check_velocity(c);
    check_units(c);
    check_motion(c);
  }
  check_duplicates(set, findings);
  return merged(findings);
}

}  // namespace hoof::tools
