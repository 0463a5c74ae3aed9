// A recording in formats that other programs read.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "tools/log/bus_recording.h"
#include "tools/log/decoded_frame.h"

namespace hoof::tools {

/// One row for each frame with a wanted signal: time_s, then a column for each wanted signal that
/// occurs in the recording ("ToeReply.position_rad"), empty where the frame has none.
/// @param signals patterns; empty: all
void export_csv(const BusRecording& recording, const std::vector<std::string>& signals,
                std::ostream& out);

/// One JSON object a line for each frame: time, bus, identifier, bytes, and by the dictionary name
/// and signals; what is wrong with it, where something is.
void export_json(const BusRecording& recording, std::ostream& out);

/// candump -L lines with Unix time, as canplayer and log2asc read them.
void export_candump(const BusRecording& recording, std::ostream& out);

/// MCAP: /bus0, /bus1 the raw frames; /<message> each message of the dictionary by signals; from a
/// run's folder also /samples, the rows of samples.csv, and /telemetry, those of telemetry.lcm.
/// @param run_folder empty where there is none
/// @return number of messages
std::uint64_t export_mcap(const BusRecording& recording, const std::filesystem::path& run_folder,
                          const std::filesystem::path& path);

/// The JSON object of a frame that export_json writes.
std::string frame_json(const BusRecording& recording, const LoggedFrame& logged);
/// {"tick": 3, ...}: the signals alone.
std::string signals_json(const MessageSpec& message, const hal::CanFrame& frame);

}  // namespace hoof::tools
