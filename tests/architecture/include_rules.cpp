#include "tests/architecture/include_rules.h"

#include <algorithm>
#include <regex>
#include <string_view>

namespace hoof::tests {
namespace {

using Paths = std::vector<std::string_view>;

/// Files below `room` may include, of our own headers, those below `allowed` only. "hal/*" means
/// the files of hal itself, its interfaces, and not those of its subfolders.
struct RoomRule {
  std::string_view room;
  Paths allowed;
};

/// The first room that a path lies in holds, so the inner rooms stand first.
const std::vector<RoomRule> kRooms = {
    {"firmware/trajectory/", {"firmware/trajectory/"}},
    {"firmware/control/", {"firmware/control/", "firmware/trajectory/"}},
    // The gate judges what the controller wishes, in the controller's own types.
    {"firmware/safety/",
     {"firmware/safety/", "firmware/control/types.h", "firmware/control/math.h"}},
    // Bus load is reckoned with the same formula for the bits of a frame as the in-process bus.
    {"firmware/protocol/", {"firmware/protocol/", "hal/can_frame.h", "hal/can_timing.h"}},
    {"firmware/app/",
     {"firmware/app/", "firmware/control/", "firmware/safety/", "firmware/protocol/",
      "firmware/trajectory/", "firmware/update/", "hal/*"}},
    {"firmware/update/",
     {"firmware/update/", "firmware/control/types.h", "firmware/protocol/", "hal/*"}},
    {"firmware/board/", {"firmware/board/", "firmware/app/", "firmware/update/", "hal/"}},
    {"hal/", {"hal/"}},
    {"sim/dem/", {"sim/dem/"}},
    {"sim/", {"sim/"}},
    {"hil_bridge/",
     {"hil_bridge/", "sim/", "hal/", "firmware/protocol/", "firmware/app/", "firmware/update/"}},
    {"tools/", {"tools/", "hil_bridge/", "sim/", "hal/", "firmware/"}},
    {"tests/", {""}},
};

/// Blindness is a build rule: the examiner's answers are out of everyone's sight. Only the
/// command line, which starts the examiner, may know it.
constexpr std::string_view kExaminer = "tools/conceal/";
const Paths kMaySeeExaminer = {"tools/conceal/", "tools/cli/", "tests/"};

/// System headers that files below `room` must do without, with the reason.
struct SystemRule {
  Paths rooms;
  Paths headers;
  std::string_view reason;
};

const std::vector<SystemRule> kSystemRules = {
    {{"firmware/control/", "firmware/safety/", "firmware/update/", "firmware/app/"},
     {"cmath", "math.h"},
     "control code does without libm, so that host and board agree bit for bit"},
    {{"firmware/control/", "firmware/safety/", "firmware/update/", "firmware/app/"},
     {"deque", "forward_list", "functional", "list", "map", "memory", "queue", "set", "string",
      "unordered_map", "unordered_set", "vector", "fstream", "iostream", "sstream", "thread",
      "mutex", "exception", "stdexcept"},
     "control code has no heap, exceptions, threads or streams"},
    {{"firmware/", "sim/"}, {"linux/can.h", "linux/can/raw.h"}, "only hal/ knows SocketCAN"},
};

bool lies_in(std::string_view path, std::string_view room) {
  if (!room.ends_with('*')) return path.starts_with(room);
  const std::string_view folder = room.substr(0, room.size() - 1);
  return path.starts_with(folder) && path.find('/', folder.size()) == std::string_view::npos;
}

bool lies_in_any(std::string_view path, const Paths& rooms) {
  return std::any_of(rooms.begin(), rooms.end(),
                     [path](std::string_view room) { return lies_in(path, room); });
}

std::string broken_rule(std::string_view path, std::string_view included) {
  const auto rule = std::find_if(kRooms.begin(), kRooms.end(), [path](const RoomRule& candidate) {
    return lies_in(path, candidate.room);
  });
  if (rule == kRooms.end()) return "C++ outside the rooms of the house";
  if (!lies_in_any(included, rule->allowed)) {
    return std::string(rule->room) + " may not include " + std::string(included);
  }
  if (lies_in(included, kExaminer) && !lies_in_any(path, kMaySeeExaminer)) {
    return "nobody but its command may include " + std::string(kExaminer);
  }
  return "";
}

std::string broken_system_rule(std::string_view path, std::string_view header) {
  for (const SystemRule& rule : kSystemRules) {
    const bool named =
        std::find(rule.headers.begin(), rule.headers.end(), header) != rule.headers.end();
    if (named && lies_in_any(path, rule.rooms)) {
      return "<" + std::string(header) + ">: " + std::string(rule.reason);
    }
  }
  return "";
}

}  // namespace

std::vector<Finding> check_includes(const std::vector<SourceFile>& files) {
  static const std::regex kInclude(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
  std::vector<Finding> findings;
  for (const SourceFile& file : files) {
    if (!file.is_cpp()) continue;
    for (std::size_t i = 0; i < file.lines.size(); ++i) {
      std::smatch match;
      if (!std::regex_search(file.lines[i], match, kInclude)) continue;
      const std::string included = match[2];
      const std::string rule = match[1] == "\"" ? broken_rule(file.path, included)
                                                : broken_system_rule(file.path, included);
      if (!rule.empty()) findings.push_back({file.path, static_cast<int>(i) + 1, rule});
    }
  }
  return findings;
}

}  // namespace hoof::tests
