// SPDX-License-Identifier: BSD-3-Clause
// A record of the format is an opcode, a length and little-endian fields.
#include "report/export/mcap_writer.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace ergocast {
namespace {

enum class Op : std::uint8_t {
  kHeader = 1,
  kFooter = 2,
  kSchema = 3,
  kChannel = 4,
  kMessage = 5,
  kChunk = 6,
  kMessageIndex = 7,
  kChunkIndex = 8,
  kStatistics = 11,
  kMetadata = 12,
  kMetadataIndex = 13,
  kDataEnd = 15,
};

constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);
constexpr std::size_t kChunkBytes = 1 << 20;

/// The content of a record.
class Fields {
 public:
  template <class Number>
  Fields& number(Number value) {
    for (std::size_t i = 0; i < sizeof value; ++i)
      text_.push_back(static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xff));
    return *this;
  }
  Fields& raw(std::string_view bytes) {
    text_ += bytes;
    return *this;
  }
  /// Appends a text with its length before it.
  Fields& text(std::string_view bytes) {
    return number(static_cast<std::uint32_t>(bytes.size())).raw(bytes);
  }
  Fields& texts(const std::map<std::string, std::string>& entries) {
    Fields pairs;
    for (const auto& [key, value] : entries) pairs.text(key).text(value);
    return text(pairs.text_);
  }
  template <class Key, class Value>
  Fields& numbers(const std::map<Key, Value>& entries) {
    Fields pairs;
    for (const auto& [key, value] : entries) pairs.number(key).number(value);
    return text(pairs.text_);
  }
  const std::string& str() const { return text_; }

 private:
  std::string text_;
};

std::string record(Op op, const Fields& content) {
  return Fields()
      .number(static_cast<std::uint8_t>(op))
      .number(static_cast<std::uint64_t>(content.str().size()))
      .raw(content.str())
      .str();
}

std::array<std::uint32_t, 256> crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    table[i] = i;
    for (int bit = 0; bit < 8; ++bit)
      table[i] = table[i] >> 1 ^ ((table[i] & 1) != 0 ? 0xEDB88320U : 0U);
  }
  return table;
}

}  // namespace

std::uint32_t crc32(std::string_view bytes, std::uint32_t before) {
  static const auto table = crc_table();
  std::uint32_t crc = ~before;
  for (const char c : bytes) crc = table[(crc ^ static_cast<unsigned char>(c)) & 0xff] ^ crc >> 8;
  return ~crc;
}

McapWriter::McapWriter(const std::filesystem::path& file, McapEncoding encoding)
    : path_(file),
      encoding_(std::move(encoding)),
      file_(std::fopen(file.c_str(), "wb"), &std::fclose) {
  write(std::string(kMagic));
  write(record(Op::kHeader, Fields().text(encoding_.profile).text("ergocast")));
}

void McapWriter::write(const std::string& bytes) {
  at_ += bytes.size();
  failed_ =
      failed_ || !file_ || std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size();
}

McapWriter::Channel McapWriter::add_channel(const std::string& topic, const std::string& schema,
                                            std::string_view schema_text) {
  const auto next = static_cast<std::uint16_t>(schemas_.size() + 1);
  const auto [known, is_new] = schemas_.try_emplace(schema, next);
  if (is_new) {
    const std::string text = record(
        Op::kSchema, Fields().number(next).text(schema).text(encoding_.schema).text(schema_text));
    schema_records_ += text;
    chunk_ += text;
  }
  const auto channel = static_cast<Channel>(counts_.size());
  counts_.push_back(0);
  const std::string text = record(
      Op::kChannel,
      Fields().number(channel).number(known->second).text(topic).text(encoding_.message).texts({}));
  channel_records_ += text;
  chunk_ += text;
  return channel;
}

void McapWriter::add_message(Channel channel, std::uint64_t time_ns, std::string_view message) {
  if (index_.empty()) open_.start_ns = open_.end_ns = time_ns;
  open_.start_ns = std::min(open_.start_ns, time_ns);
  open_.end_ns = std::max(open_.end_ns, time_ns);
  index_[channel].emplace_back(time_ns, chunk_.size());
  const auto sequence = static_cast<std::uint32_t>(counts_[channel]++);
  chunk_ += record(
      Op::kMessage,
      Fields().number(channel).number(sequence).number(time_ns).number(time_ns).raw(message));
  if (chunk_.size() >= kChunkBytes) end_chunk();
}

void McapWriter::end_chunk() {
  if (chunk_.empty()) return;
  const auto size = static_cast<std::uint64_t>(chunk_.size());
  open_.at = at_;
  open_.content_bytes = size;
  write(record(Op::kChunk, Fields()
                               .number(open_.start_ns)
                               .number(open_.end_ns)
                               .number(size)
                               .number(crc32(chunk_))
                               .text("")
                               .number(size)
                               .raw(chunk_)));
  open_.bytes = at_ - open_.at;
  for (auto& [channel, places] : index_) {
    open_.indexes[channel] = at_;
    std::stable_sort(places.begin(), places.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    Fields pairs;
    for (const auto& [time_ns, place] : places) pairs.number(time_ns).number(place);
    write(record(Op::kMessageIndex, Fields().number(channel).text(pairs.str())));
  }
  open_.index_bytes = at_ - open_.at - open_.bytes;
  chunks_.push_back(std::move(open_));
  open_ = {};
  index_.clear();
  chunk_.clear();
}

void McapWriter::add_metadata(const std::string& name,
                              const std::map<std::string, std::string>& entries) {
  end_chunk();
  const std::uint64_t before = at_;
  write(record(Op::kMetadata, Fields().text(name).texts(entries)));
  metadata_.push_back({before, at_ - before, name});
}

std::string McapWriter::statistics() const {
  std::uint64_t messages = 0, start_ns = 0, end_ns = 0;
  std::map<Channel, std::uint64_t> counts;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    messages += counts_[i];
    counts[static_cast<Channel>(i)] = counts_[i];
  }
  for (const Chunk& chunk : chunks_) {
    if (chunk.indexes.empty()) continue;
    start_ns = start_ns == 0 ? chunk.start_ns : std::min(start_ns, chunk.start_ns);
    end_ns = std::max(end_ns, chunk.end_ns);
  }
  return record(Op::kStatistics, Fields()
                                     .number(messages)
                                     .number(static_cast<std::uint16_t>(schemas_.size()))
                                     .number(static_cast<std::uint32_t>(counts_.size()))
                                     .number(std::uint32_t{0})
                                     .number(static_cast<std::uint32_t>(metadata_.size()))
                                     .number(static_cast<std::uint32_t>(chunks_.size()))
                                     .number(start_ns)
                                     .number(end_ns)
                                     .numbers(counts));
}

/// The summary and the footer, which begin at `at`.
std::string McapWriter::summary(std::uint64_t at) const {
  std::string text = schema_records_ + channel_records_ + statistics();
  for (const Chunk& chunk : chunks_) {
    text += record(Op::kChunkIndex, Fields()
                                        .number(chunk.start_ns)
                                        .number(chunk.end_ns)
                                        .number(chunk.at)
                                        .number(chunk.bytes)
                                        .numbers(chunk.indexes)
                                        .number(chunk.index_bytes)
                                        .text("")
                                        .number(chunk.content_bytes)
                                        .number(chunk.content_bytes));
  }
  for (const MetadataPlace& place : metadata_) {
    text +=
        record(Op::kMetadataIndex, Fields().number(place.at).number(place.bytes).text(place.name));
  }
  constexpr std::uint64_t kFooterBytes = 20, kNoOffsets = 0;
  text += Fields()
              .number(static_cast<std::uint8_t>(Op::kFooter))
              .number(kFooterBytes)
              .number(at)
              .number(kNoOffsets)
              .str();
  return text + Fields().number(crc32(text)).str();
}

std::optional<std::string> McapWriter::finish() {
  end_chunk();
  write(record(Op::kDataEnd, Fields().number(std::uint32_t{0})));
  write(summary(at_));
  write(std::string(kMagic));
  failed_ = failed_ || std::fflush(file_.get()) != 0;
  if (failed_) return path_.string() + ": " + std::strerror(errno);
  return std::nullopt;
}

void McapQueue::add(std::uint64_t time_ns, McapWriter::Channel channel, std::string message) {
  waiting_.push_back({time_ns, channel, std::move(message)});
}

void McapQueue::sort() { std::ranges::stable_sort(waiting_, {}, &Waiting::time_ns); }

void McapQueue::write_until(std::uint64_t time_ns, McapWriter& writer) {
  for (; next_ < waiting_.size() && waiting_[next_].time_ns <= time_ns; ++next_) {
    const Waiting& one = waiting_[next_];
    writer.add_message(one.channel, one.time_ns, one.message);
  }
}

}  // namespace ergocast
