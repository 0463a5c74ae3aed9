#include "tools/conceal/alike.h"

#include "tools/conceal/sand_case.h"
#include "tools/conceal/servo_alike.h"

namespace hoof::tools::conceal {

CaseRequest alike_request(const std::string& rig, std::size_t index) {
  if (rig == "plate_sand") return sand_alike_request();
  return servo_alike_request(index);
}

CaseData make_alike_case(const std::string& name, const DealtCase& dealt,
                         const RandomStream& random) {
  if (dealt.rig == "plate_sand") return make_sand_case(name, dealt.request, random);
  return make_servo_alike_case(name, dealt.request, random);
}

}  // namespace hoof::tools::conceal
