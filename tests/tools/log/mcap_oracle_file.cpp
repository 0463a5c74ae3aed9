// Writes an MCAP file of a recording, and the same frames as JSON lines by the other export.
// usage: hoof_mcap_oracle_file RUN FILE.mcap FRAMES.jsonl

#include <cstdio>
#include <fstream>

#include "tools/log/export.h"

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const hoof::tools::BusRecording recording = hoof::tools::read_bus_log(argv[1]);
  const auto count = hoof::tools::export_mcap(recording, argv[1], argv[2]);
  std::ofstream frames(argv[3]);
  hoof::tools::export_json(recording, frames);
  std::printf("%llu messages of %zu frames\n", static_cast<unsigned long long>(count),
              recording.frames.size());
}
