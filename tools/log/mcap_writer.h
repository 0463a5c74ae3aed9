// MCAP files, written after the public specification (https://mcap.dev/spec, version 0): what
// PlotJuggler 4, Foxglove and the `mcap` tool open.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/app/crc32.h"
#include "tools/run/output_file.h"

namespace hoof::tools {

/// JSON messages with a JSON schema, in uncompressed chunks that are indexed by time and channel; a
/// summary with statistics; every CRC that the format knows. Messages come in the order of time.
class McapWriter {
 public:
  using Metadata = std::map<std::string, std::string>;

  /// A chunk ends once it holds this much: small enough to seek in, large enough that indices are
  /// few.
  static constexpr std::size_t kChunkBytes = 256 * 1024;

  /// @throws UserError where the file cannot be written, as all functions here
  explicit McapWriter(const std::filesystem::path& path);

  /// @param json_schema JSON Schema of the messages, an object
  /// @return number of the channel, for message()
  std::uint16_t add_channel(const std::string& topic, const std::string& schema_name,
                            const std::string& json_schema, const Metadata& metadata = {});

  /// A named table of texts about the whole file.
  void metadata(const std::string& name, const Metadata& values);

  /// @param time_ns Unix time
  void message(std::uint16_t channel, std::int64_t time_ns, std::string_view json);

  /// Ends the file with summary and footer. A file without is no MCAP file that can be indexed.
  void close();

  std::uint64_t messages() const { return message_count_; }

 private:
  struct Channel {
    std::string record;         // its Channel record, for the summary
    std::string schema_record;  // its Schema record
    std::uint32_t sequence = 0;
    std::uint64_t count = 0;
    std::string index;  // (time, offset) of its messages in the open chunk
    bool announced = false;
  };
  struct Chunk {
    std::uint64_t first_ns = 0, last_ns = 0;
    std::uint64_t offset = 0, length = 0, index_length = 0, size = 0;
    std::map<std::uint16_t, std::uint64_t> index_offsets;
  };
  struct MetadataPlace {
    std::uint64_t offset = 0, length = 0;
    std::string name;
  };

  void put(std::string_view bytes);
  void end_chunk();
  std::string summary(std::string& offsets) const;
  std::string statistics() const;

  OutputFile file_;
  std::uint64_t position_ = 0;
  firmware::app::Crc32 data_crc_;
  std::vector<Channel> channels_;  // channel n is number n + 1
  std::string chunk_;              // records of the open chunk
  std::uint64_t chunk_first_ns_ = 0, chunk_last_ns_ = 0;
  std::uint64_t first_ns_ = 0, last_ns_ = 0, message_count_ = 0;
  std::vector<Chunk> chunks_;
  std::vector<MetadataPlace> metadata_;
};

}  // namespace hoof::tools
