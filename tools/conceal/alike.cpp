#include "tools/conceal/alike.h"

#include "tools/conceal/servo_alike.h"

namespace hoof::tools::conceal {

CaseRequest alike_request(const std::string&, std::size_t index) {
  return servo_alike_request(index);
}

CaseData make_alike_case(const std::string& name, const DealtCase& dealt,
                         const RandomStream& random) {
  return make_servo_alike_case(name, dealt.request, random);
}

}  // namespace hoof::tools::conceal
