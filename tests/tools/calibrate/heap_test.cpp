#include <catch2/catch.hpp>
#include <cstdlib>
#include "tools/calibrate/repose.h"
#include "tools/calibrate/findings.h"
using namespace hoof;
using namespace hoof::tools;
TEST_CASE("heap probe", "[.]") {
  ReposeSettings s;
  if (const char* n = std::getenv("GRAINS")) s.test.grains = std::atoi(n);
  if (const char* n = std::getenv("OUTLET")) s.test.outlet_m = 1e-3 * std::atof(n);
  s.seeds = std::getenv("SEEDS") ? std::atoi(std::getenv("SEEDS")) : 1;
  CoefficientFlags f;
  if (const char* n = std::getenv("MUR")) f.rolling_friction = std::atof(n);
  const auto m = lab_materials("", f, &sim::Materials::sand_sand);
  const auto cases = repose_cases(m, s);
  const auto r = make_heaps(cases, "/tmp/calib-heaps", 1, [](double share, const std::string& w) {
    static int i = 0;
    if (++i % 10 == 0) std::fprintf(stderr, "%s %.3f\n", w.c_str(), share);
    return true;
  });
  WARN(findings_text(find_repose(m, s, cases, r)));
}
