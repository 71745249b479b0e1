// SPDX-License-Identifier: BSD-3-Clause
// The bytes of a segment of the event log, whether zstd has compressed it or not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "core/base/result.h"
#include "text/input_file.h"

struct ZSTD_DCtx_s;

namespace ergocast {

class SegmentFile {
 public:
  /// Opens a segment. A name that ends with .zst means a compressed one.
  static Result<SegmentFile, FileProblem> open(const std::filesystem::path& file);

  /// False if the segment ends before so many bytes.
  bool read(void* to, std::size_t bytes);
  /// Whether it ended early because the compressed bytes are damaged or incomplete.
  bool damaged() const { return damaged_; }
  /// How many uncompressed bytes were read.
  std::uint64_t position() const { return position_; }

 private:
  SegmentFile(StdioFile opened, bool compressed);
  std::size_t decompress(void* to, std::size_t bytes);

  StdioFile file_;
  std::unique_ptr<ZSTD_DCtx_s, void (*)(ZSTD_DCtx_s*)> context_;  // null: not compressed
  std::vector<char> in_;
  std::size_t in_size_ = 0, in_used_ = 0;
  bool frame_ended_ = false, damaged_ = false;
  std::uint64_t position_ = 0;
};

}  // namespace ergocast
