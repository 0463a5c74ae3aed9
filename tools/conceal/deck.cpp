#include "tools/conceal/deck.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/conceal/alike.h"
#include "tools/conceal/sand_bench.h"
#include "tools/conceal/servo_sizes.h"

namespace hoof::tools::conceal {
namespace {

constexpr double kServoShare = 0.8;

struct KindShare {
  const char* kind;
  double share;
};
/// Section 5 of the contract.
constexpr KindShare kKinds[] = {{"none", 0.15},    {"none_wrong_parameters", 0.15},
                                {"one", 0.35},     {"pair", 0.15},
                                {"unknown", 0.15}, {"not_decidable", 0.05}};

/// Goes round a list in an order that is shuffled each time anew.
class Round {
 public:
  Round(std::vector<std::string> names, RandomStream random)
      : names_(std::move(names)), random_(random) {}

  std::string next() {
    if (at_ == 0) random_.shuffle(names_);
    const std::string name = names_[at_];
    at_ = (at_ + 1) % names_.size();
    return name;
  }

 private:
  std::vector<std::string> names_;
  RandomStream random_;
  std::size_t at_ = 0;
};

std::vector<DealtCase> deal_rig(const std::string& rig, int count, RandomStream random) {
  const bool servo = rig == "servo_pendulum";
  const std::vector<std::string>& listed = servo ? listed_servo_effects() : listed_sand_effects();
  Round one(listed, random.branch(0)), pair(listed, random.branch(1));
  Round unlisted(servo ? unlisted_servo_effects() : unlisted_sand_effects(), random.branch(2));
  std::vector<double> shares;
  for (const KindShare& k : kKinds) shares.push_back(k.share);
  const std::vector<int> counts = apportion(count, shares);
  std::vector<DealtCase> cases;
  std::size_t alike = 0;
  for (std::size_t k = 0; k < counts.size(); ++k) {
    for (int i = 0; i < counts[k]; ++i) {
      CaseRequest request;
      request.kind = kKinds[k].kind;
      if (request.kind == "one") request.effects = {one.next()};
      if (request.kind == "unknown") request.effects = {unlisted.next()};
      if (request.kind == "pair") {
        request.effects = {pair.next()};
        while (request.effects.size() < 2) {
          const std::string other = pair.next();
          if (other != request.effects[0]) request.effects.push_back(other);
        }
      }
      if (request.kind == "not_decidable") request = alike_request(rig, alike++);
      request.stiff = random.chance(0.4);
      cases.push_back({rig, request});
    }
  }
  return cases;
}

}  // namespace

std::vector<int> apportion(int count, const std::vector<double>& shares) {
  std::vector<int> counts;
  std::vector<std::pair<double, std::size_t>> remainders;
  int dealt = 0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const double exact = shares[i] * count;
    counts.push_back(int(std::floor(exact + 1e-9)));
    dealt += counts.back();
    remainders.push_back({-(exact - counts.back()), i});
  }
  std::stable_sort(remainders.begin(), remainders.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first - 1e-9; });
  for (std::size_t i = 0; dealt < count; ++i, ++dealt) ++counts[remainders[i].second];
  return counts;
}

std::vector<DealtCase> deal(int count, const std::string& rig, RandomStream random) {
  const int servo = rig == "all"          ? int(std::lround(kServoShare * count))
                    : rig == "plate_sand" ? 0
                                          : count;
  std::vector<DealtCase> cases = deal_rig("servo_pendulum", servo, random.branch(0));
  const std::vector<DealtCase> sand = deal_rig("plate_sand", count - servo, random.branch(1));
  cases.insert(cases.end(), sand.begin(), sand.end());
  random.branch(2).shuffle(cases);
  return cases;
}

}  // namespace hoof::tools::conceal
