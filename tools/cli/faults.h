// What `hoof faults` prints of a foot's fault log.
#pragma once

#include <iosfwd>

#include "firmware/app/fault_record.h"
#include "hil_bridge/service_client.h"

namespace hoof::tools {

/// All records, newest last: fault, mode, tick; with `with_trace` each with the ticks before it.
void print_fault_log(bridge::ServiceClient& client, bool with_trace, std::ostream& out);

/// One record as text.
void print_fault(const firmware::app::FaultRecord& record, bool with_trace, std::ostream& out);

}  // namespace hoof::tools
