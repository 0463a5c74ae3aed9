// Whether there is enough in a recording, and whether it is there only once.
#include <algorithm>
#include <cmath>

#include "tools/diagnose/quality_checks.h"
#include "tools/diagnose/series.h"

namespace hoof::tools {
namespace {

constexpr double kLeastLength_s = 1;
constexpr std::size_t kLeastSamples = 50;

/// Said already.
bool is_dead(const QualityCase& c, const std::string& channel) {
  const auto found = c.recording.channels.find(channel);
  return found == c.recording.channels.end() || range_of(found->second) == 0;
}

void check_excitation(const QualityCase& c) {
  const std::vector<std::string> driving = {
      "position", "position_goal", "velocity_goal", "torque_ff", "torque", "current", "force"};
  const bool any = std::any_of(driving.begin(), driving.end(),
                               [&c](const std::string& channel) { return c.moves(channel); });
  if (!any) {
    c.say("still", "", 1, true,
          "nothing moves by more than its noise: there is nothing to learn from it");
  } else if (c.set.rig != RigKind::kServoPendulum && !c.moves("force") && !is_dead(c, "force")) {
    c.say("still", "force", 1, true, "stays within its noise: no contact?");
  } else if (c.set.rig == RigKind::kPlateSand && !c.moves("position")) {
    c.say("still", "position", 1, true, "stays within its noise: no press");
  }
}

std::string other_name(const Recording& a, const Recording& b) {
  return a.name == b.name ? "another window of the same file" : b.name;
}

/// The same samples under two names, or windows of one file that share samples.
bool share_samples(const Recording& a, const Recording& b) {
  const auto pa = a.channels.find("position"), pb = b.channels.find("position");
  if (pa == a.channels.end() || pb == b.channels.end()) return false;
  if (a.path == b.path) {
    return a.time_s.front() <= b.time_s.back() && b.time_s.front() <= a.time_s.back();
  }
  const auto same = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  return range_of(pa->second) > 0 && pa->second.size() == pb->second.size() &&
         std::equal(pa->second.begin(), pa->second.end(), pb->second.begin(), same);
}

}  // namespace

void check_motion(const QualityCase& c) {
  const Series& t = c.recording.time_s;
  const double length_s = t.back() - t.front();
  if (length_s < kLeastLength_s) {
    c.say("short", "", 1 / length_s, true, "is only " + quality_number(length_s, "s") + " long");
  } else if (t.size() < kLeastSamples) {
    c.say("short", "", 1.0 / double(t.size()), true,
          "has only " + std::to_string(t.size()) + " samples");
  }
  check_excitation(c);
}

void check_duplicates(const DataSet& set, std::vector<QualityFinding>& findings) {
  for (std::size_t i = 0; i < set.recordings.size(); ++i) {
    for (std::size_t j = i + 1; j < set.recordings.size(); ++j) {
      const Recording &a = set.recordings[i], &b = set.recordings[j];
      if (!share_samples(a, b)) continue;
      const bool leak = a.holdout != b.holdout;
      findings.push_back({"duplicate",
                          {a.name, "",
                           "shares its samples with " + other_name(a, b) +
                               (leak ? ", one of them to fit and one held out: what is held out "
                                       "proves nothing"
                                     : ": they count twice"),
                           leak},
                          leak ? 2.0 : 1.0});
    }
  }
}

}  // namespace hoof::tools
