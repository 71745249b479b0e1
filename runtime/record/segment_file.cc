// SPDX-License-Identifier: BSD-3-Clause
// Reads a plain file, or streams a compressed one through libzstd.
#include "runtime/record/segment_file.h"

#include <zstd.h>

#include <utility>

namespace ergocast {

Result<SegmentFile, FileProblem> SegmentFile::open(const std::filesystem::path& file) {
  auto opened = open_input(file);
  if (!opened) return failure(opened.error());
  return SegmentFile(*std::move(opened), file.extension() == ".zst");
}

SegmentFile::SegmentFile(StdioFile opened, bool compressed)
    : file_(std::move(opened)),
      context_(compressed ? ZSTD_createDCtx() : nullptr,
               [](ZSTD_DCtx* context) { ZSTD_freeDCtx(context); }) {
  if (context_) in_.resize(ZSTD_DStreamInSize());
}

bool SegmentFile::read(void* to, std::size_t bytes) {
  const std::size_t got = context_ ? decompress(to, bytes) : std::fread(to, 1, bytes, file_.get());
  position_ += got;
  return got == bytes;
}

std::size_t SegmentFile::decompress(void* to, std::size_t bytes) {
  ZSTD_outBuffer out{to, bytes, 0};
  while (out.pos < out.size && !damaged_) {
    if (in_used_ == in_size_) {
      in_size_ = std::fread(in_.data(), 1, in_.size(), file_.get());
      in_used_ = 0;
    }
    const bool at_end = in_size_ == 0;
    if (at_end && frame_ended_) break;
    const std::size_t before = out.pos;
    ZSTD_inBuffer in{in_.data(), in_size_, in_used_};
    const std::size_t result = ZSTD_decompressStream(context_.get(), &out, &in);
    in_used_ = in.pos;
    frame_ended_ = result == 0;
    damaged_ = ZSTD_isError(result) != 0 || (at_end && !frame_ended_ && out.pos == before);
  }
  return out.pos;
}

}  // namespace ergocast
