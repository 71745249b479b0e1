// SPDX-License-Identifier: BSD-3-Clause
// Writes MCAP files (https://mcap.dev/spec): indexed, in chunks without compression.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ergocast {

/// CRC-32 as in zip files; `before` is the value of the preceding bytes.
std::uint32_t crc32(std::string_view bytes, std::uint32_t before = 0);

/// How all messages of a file are written: names that the format's registry has.
struct McapEncoding {
  std::string profile, schema, message;
};
inline const McapEncoding kMcapJson{"", "jsonschema", "json"};
inline const McapEncoding kMcapRos2{"ros2", "ros2msg", "cdr"};

/// The file is complete only after finish().
class McapWriter {
 public:
  using Channel = std::uint16_t;

  McapWriter(const std::filesystem::path& file, McapEncoding encoding);

  /// @param schema  equal names have equal texts
  Channel add_channel(const std::string& topic, const std::string& schema,
                      std::string_view schema_text);
  /// @param time_ns  since 1970; in any order, but readers work best with ascending times
  void add_message(Channel channel, std::uint64_t time_ns, std::string_view message);
  void add_metadata(const std::string& name, const std::map<std::string, std::string>& entries);

  /// Writes the indexes. Returns the write error, if there was any.
  std::optional<std::string> finish();

 private:
  struct Chunk {
    std::uint64_t start_ns = 0, end_ns = 0, at = 0, bytes = 0, index_bytes = 0, content_bytes = 0;
    std::map<Channel, std::uint64_t> indexes;  // where the channels' indexes begin
  };
  struct MetadataPlace {
    std::uint64_t at = 0, bytes = 0;
    std::string name;
  };

  void write(const std::string& bytes);
  void end_chunk();
  std::string summary(std::uint64_t at) const;
  std::string statistics() const;

  std::filesystem::path path_;
  McapEncoding encoding_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  bool failed_ = false;
  std::uint64_t at_ = 0;  // bytes written

  std::map<std::string, std::uint16_t> schemas_;
  std::string schema_records_, channel_records_;  // repeated in the summary
  std::vector<std::uint64_t> counts_;             // messages by channel

  std::string chunk_;
  Chunk open_;
  std::map<Channel, std::vector<std::pair<std::uint64_t, std::uint64_t>>> index_;
  std::vector<Chunk> chunks_;
  std::vector<MetadataPlace> metadata_;
};

/// Messages that wait until those before them are written.
class McapQueue {
 public:
  void add(std::uint64_t time_ns, McapWriter::Channel channel, std::string message);
  /// Sorts what was added, in the order of time; before the first write_until().
  void sort();
  /// Writes those that are not later than `time_ns`.
  void write_until(std::uint64_t time_ns, McapWriter& writer);

 private:
  struct Waiting {
    std::uint64_t time_ns = 0;
    McapWriter::Channel channel = 0;
    std::string message;
  };
  std::vector<Waiting> waiting_;
  std::size_t next_ = 0;
};

}  // namespace ergocast
