// recording.json: what a bus log does not say and a replay must know.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "firmware/app/parameters.h"

namespace hoof::bridge {

inline constexpr char kRecordingFactsFile[] = "recording.json";

/// How the frames of a run came to the firmware. Written at the start of a run, so that one that is
/// killed can be replayed, too.
struct RecordingFacts {
  /// Raised when the meaning of an entry changes or a replay needs one more; readers refuse a
  /// format that is above theirs.
  static constexpr int kFormat = 1;

  int format = kFormat;
  std::string wires = "in_process";  // or the SocketCAN interfaces
  std::int64_t exchange_ns = 0;      // the firmware was polled at every multiple of it, from 0 on
  int mailboxes = 3;                 // of the firmware on each bus; a full set refuses frames
  std::uint32_t protocol_hash = 0;   // of the dictionary
  std::uint32_t parameter_table_hash = 0;
  firmware::app::Parameters parameters;
  /// Faults put into the run that reached the firmware without the bus showing it: from the first
  /// of them on its answers need not be those of a replay.
  std::vector<std::string> unseen_faults;

  /// Remarks of read_recording_facts(): parameters that only one of the two firmwares has.
  std::vector<std::string> notes;
};

/// Of a run on this program's own dictionary and parameters.
RecordingFacts recording_facts(std::string wires, double exchange_s,
                               const firmware::app::Parameters& parameters);

/// Every parameter by name, as the shortest text that reads back as the same float.
std::string to_json(const RecordingFacts& facts);

/// @param source name of the text in errors
/// @throws std::invalid_argument naming source, key and what is wrong
RecordingFacts parse_recording_facts(const std::string& text, const std::string& source);

}  // namespace hoof::bridge
