#include "tools/log/mcap_writer.h"

#include <algorithm>
#include <functional>

#include "tools/run/version.h"

namespace hoof::tools {
namespace {

using firmware::app::Crc32;

constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);

enum class Op : unsigned char {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

/// The format's types: little-endian numbers, texts and arrays behind their length in bytes.
class Bytes {
 public:
  Bytes& u8(unsigned value) { return number(value, 1); }
  Bytes& u16(std::uint64_t value) { return number(value, 2); }
  Bytes& u32(std::uint64_t value) { return number(value, 4); }
  Bytes& u64(std::uint64_t value) { return number(value, 8); }
  Bytes& raw(std::string_view bytes) {
    text_ += bytes;
    return *this;
  }
  Bytes& text(std::string_view bytes) { return u32(bytes.size()).raw(bytes); }
  Bytes& table(const McapWriter::Metadata& values) {
    Bytes inside;
    for (const auto& [key, value] : values) inside.text(key).text(value);
    return text(inside.text_);
  }
  const std::string& str() const { return text_; }

 private:
  Bytes& number(std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) text_ += char(value >> (8 * i) & 0xFF);
    return *this;
  }
  std::string text_;
};

std::string record(Op op, const Bytes& content) {
  return Bytes().u8(unsigned(op)).u64(content.str().size()).raw(content.str()).str();
}

std::uint32_t crc_of(std::string_view bytes) {
  return Crc32().add(bytes).value();
}

}  // namespace

McapWriter::McapWriter(const std::filesystem::path& path) : file_(path) {
  put(kMagic);
  const std::string library = "hoof " + std::string(build_version().code);
  put(record(Op::kHeader, Bytes().text("").text(library)));
}

void McapWriter::put(std::string_view bytes) {
  file_.write(bytes);
  data_crc_.add(bytes);
  position_ += bytes.size();
}

std::uint16_t McapWriter::add_channel(const std::string& topic, const std::string& schema_name,
                                      const std::string& json_schema, const Metadata& metadata) {
  const auto id = std::uint16_t(channels_.size() + 1);  // a schema of its own, of the same number
  Channel channel;
  channel.schema_record =
      record(Op::kSchema, Bytes().u16(id).text(schema_name).text("jsonschema").text(json_schema));
  channel.record =
      record(Op::kChannel, Bytes().u16(id).u16(id).text(topic).text("json").table(metadata));
  channels_.push_back(std::move(channel));
  return id;
}

void McapWriter::metadata(const std::string& name, const Metadata& values) {
  end_chunk();
  const std::string text = record(Op::kMetadata, Bytes().text(name).table(values));
  metadata_.push_back({position_, text.size(), name});
  put(text);
}

void McapWriter::message(std::uint16_t id, std::int64_t time_ns, std::string_view json) {
  Channel& channel = channels_.at(id - 1u);
  const auto at_ns = std::uint64_t(time_ns);
  if (!channel.announced) {
    chunk_ += channel.schema_record + channel.record;
    channel.announced = true;
  }
  if (chunk_first_ns_ == 0) chunk_first_ns_ = at_ns;
  if (message_count_ == 0) first_ns_ = at_ns;
  chunk_last_ns_ = last_ns_ = at_ns;
  channel.index += Bytes().u64(at_ns).u64(chunk_.size()).str();
  chunk_ +=
      record(Op::kMessage, Bytes().u16(id).u32(channel.sequence++).u64(at_ns).u64(at_ns).raw(json));
  ++channel.count;
  ++message_count_;
  if (chunk_.size() >= kChunkBytes) end_chunk();
}

void McapWriter::end_chunk() {
  if (chunk_.empty()) return;
  Chunk chunk{chunk_first_ns_, chunk_last_ns_, position_, 0, 0, chunk_.size(), {}};
  put(record(Op::kChunk, Bytes()
                             .u64(chunk.first_ns)
                             .u64(chunk.last_ns)
                             .u64(chunk_.size())
                             .u32(crc_of(chunk_))
                             .text("")  // not compressed
                             .u64(chunk_.size())
                             .raw(chunk_)));
  chunk.length = position_ - chunk.offset;
  const std::uint64_t indices = position_;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if (channels_[i].index.empty()) continue;
    const auto id = std::uint16_t(i + 1);
    chunk.index_offsets[id] = position_;
    put(record(Op::kMessageIndex, Bytes().u16(id).text(channels_[i].index)));
    channels_[i].index.clear();
  }
  chunk.index_length = position_ - indices;
  chunks_.push_back(std::move(chunk));
  chunk_.clear();
  chunk_first_ns_ = 0;
}

std::string McapWriter::statistics() const {
  Bytes counts;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if (channels_[i].count > 0) counts.u16(i + 1).u64(channels_[i].count);
  }
  const auto used = std::uint64_t(std::count_if(channels_.begin(), channels_.end(),
                                                [](const Channel& c) { return c.announced; }));
  return record(Op::kStatistics, Bytes()
                                     .u64(message_count_)
                                     .u16(used)
                                     .u32(used)
                                     .u32(0)  // attachments
                                     .u32(metadata_.size())
                                     .u32(chunks_.size())
                                     .u64(first_ns_)
                                     .u64(last_ns_)
                                     .text(counts.str()));
}

/// @param offsets gets one SummaryOffset record for each group of records
std::string McapWriter::summary(std::string& offsets) const {
  std::string all;
  const auto group = [&](Op op, const std::string& records) {
    if (records.empty()) return;
    offsets += record(Op::kSummaryOffset,
                      Bytes().u8(unsigned(op)).u64(position_ + all.size()).u64(records.size()));
    all += records;
  };
  std::string schemas, channels, chunks, metadata;
  for (const Channel& channel : channels_) {
    if (!channel.announced) continue;
    schemas += channel.schema_record;
    channels += channel.record;
  }
  for (const Chunk& c : chunks_) {
    Bytes places;
    for (const auto& [id, offset] : c.index_offsets) places.u16(id).u64(offset);
    chunks += record(Op::kChunkIndex, Bytes()
                                          .u64(c.first_ns)
                                          .u64(c.last_ns)
                                          .u64(c.offset)
                                          .u64(c.length)
                                          .text(places.str())
                                          .u64(c.index_length)
                                          .text("")
                                          .u64(c.size)
                                          .u64(c.size));
  }
  for (const MetadataPlace& m : metadata_) {
    metadata += record(Op::kMetadataIndex, Bytes().u64(m.offset).u64(m.length).text(m.name));
  }
  group(Op::kSchema, schemas);
  group(Op::kChannel, channels);
  group(Op::kStatistics, statistics());
  group(Op::kChunkIndex, chunks);
  group(Op::kMetadataIndex, metadata);
  return all;
}

void McapWriter::close() {
  end_chunk();
  put(record(Op::kDataEnd, Bytes().u32(data_crc_.value())));
  std::string offsets;
  const std::string summary_records = summary(offsets);
  const std::uint64_t summary_start = position_;
  const std::uint64_t offset_start = summary_start + summary_records.size();
  // The footer's CRC covers summary, offsets and the footer itself up to that CRC.
  std::string covered =
      summary_records + offsets +
      Bytes().u8(unsigned(Op::kFooter)).u64(8 + 8 + 4).u64(summary_start).u64(offset_start).str();
  covered += Bytes().u32(crc_of(covered)).str();
  put(covered);
  put(kMagic);
  file_.close();
}

}  // namespace hoof::tools
