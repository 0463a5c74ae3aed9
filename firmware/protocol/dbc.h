// The dictionary as a DBC file, for candump decoders and bus analysers. Host only.
#pragma once

#include <iosfwd>

namespace hoof::firmware::protocol {

/// Writes the whole dictionary, both buses; the same bytes on every call.
void write_dbc(std::ostream& out);

}  // namespace hoof::firmware::protocol
