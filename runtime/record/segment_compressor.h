// SPDX-License-Identifier: BSD-3-Clause
// Compresses finished segments of the event log, a little at a time, so that no event waits for it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <memory>
#include <vector>

struct ZSTD_CCtx_s;

namespace ergocast {

/// FILE.zst, in the format of `zstd`, replaces FILE once it is complete. `zstd -d` restores the
/// same bytes.
class SegmentCompressor {
 public:
  SegmentCompressor();
  ~SegmentCompressor();

  /// Adds a file to be compressed. @pre nothing more is written to it
  void add(std::filesystem::path file) { waiting_.push_back(std::move(file)); }

  /// Compresses up to `bytes` more, in whole blocks. A file that cannot be read, or whose copy
  /// cannot be written, is left as it is.
  void work(std::int64_t bytes);

  bool idle() const { return waiting_.empty(); }

 private:
  using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

  bool begin();
  bool pass_on(std::size_t bytes, bool last);
  void end(bool done);
  std::filesystem::path part() const { return waiting_.front().string() + ".zst.part"; }

  std::deque<std::filesystem::path> waiting_;  // if from_ is open, it is the first
  File from_, to_;
  std::unique_ptr<ZSTD_CCtx_s, void (*)(ZSTD_CCtx_s*)> context_;
  std::vector<char> in_, out_;
  std::int64_t allowed_ = 0;  // bytes left over from the last work(), less than a block
};

}  // namespace ergocast
