// What `hoof param` does once the bus is open.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "firmware/app/parameters.h"
#include "hil_bridge/service_client.h"

namespace hoof::tools {

/// Writes the whole table: name, unit, range, default, meaning; `client` null: no values.
void list_parameters(bridge::ServiceClient* client, std::ostream& out);

/// Prints "name = value unit" of each.
/// @throws UserError for a name that does not exist, with the nearest that does
void get_parameters(bridge::ServiceClient& client, const std::vector<std::string>& names,
                    std::ostream& out);

struct Assignment {
  std::uint8_t index;
  float value;
};

/// Reads "name=value"; checks name and range, so that nothing is written where one is wrong.
/// @throws UserError naming the text, the value and the bound
std::vector<Assignment> parse_assignments(const std::vector<std::string>& texts);

/// Writes them and reads them back.
void set_parameters(bridge::ServiceClient& client, const std::vector<Assignment>& assignments,
                    std::ostream& out);

/// @param joint toe, hip or knee
void calibrate_joint(bridge::ServiceClient& client, const std::string& joint, std::ostream& out);

}  // namespace hoof::tools
