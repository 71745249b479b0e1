// SPDX-License-Identifier: BSD-3-Clause
// Streams a file through libzstd in blocks, and gives the result its final name when it is
// complete.
#include "runtime/record/segment_compressor.h"

#include <unistd.h>
#include <zstd.h>

#include <system_error>
#include <utility>

namespace ergocast {
namespace {

constexpr std::size_t kBlockBytes = 1 << 18;
/// Sums change in all their digits, so a higher level costs more without a gain.
constexpr int kLevel = 1;

/// Writes the whole file to the disk, so that it survives a power failure.
bool keep(std::FILE* file) { return std::fflush(file) == 0 && fsync(fileno(file)) == 0; }

}  // namespace

SegmentCompressor::SegmentCompressor()
    : from_(nullptr, std::fclose),
      to_(nullptr, std::fclose),
      context_(ZSTD_createCCtx(), [](ZSTD_CCtx* context) { ZSTD_freeCCtx(context); }),
      in_(kBlockBytes),
      out_(ZSTD_CStreamOutSize()) {
  ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_compressionLevel, kLevel);
  ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_checksumFlag, 1);
}

/// Removes an incomplete copy: the segment itself is still there.
SegmentCompressor::~SegmentCompressor() {
  if (from_) end(false);
}

void SegmentCompressor::work(std::int64_t bytes) {
  constexpr auto kBlock = static_cast<std::int64_t>(kBlockBytes);
  for (allowed_ += bytes; allowed_ >= kBlock && !waiting_.empty(); allowed_ -= kBlock) {
    if (!from_ && !begin()) {
      end(false);
      continue;
    }
    const std::size_t read = std::fread(in_.data(), 1, in_.size(), from_.get());
    const bool last = read < in_.size();
    const bool sound = std::ferror(from_.get()) == 0 && pass_on(read, last);
    if (last || !sound) end(sound);
  }
  allowed_ %= kBlock;
}

bool SegmentCompressor::begin() {
  ZSTD_CCtx_reset(context_.get(), ZSTD_reset_session_only);
  from_.reset(std::fopen(waiting_.front().c_str(), "rb"));
  if (from_) to_.reset(std::fopen(part().c_str(), "wb"));
  return from_ && to_;
}

/// Compresses the first `bytes` of in_; with `last` it also ends the stream.
bool SegmentCompressor::pass_on(std::size_t bytes, bool last) {
  ZSTD_inBuffer in{in_.data(), bytes, 0};
  const ZSTD_EndDirective how = last ? ZSTD_e_end : ZSTD_e_continue;
  while (true) {
    ZSTD_outBuffer out{out_.data(), out_.size(), 0};
    const std::size_t left = ZSTD_compressStream2(context_.get(), &out, &in, how);
    if (ZSTD_isError(left) != 0) return false;
    if (std::fwrite(out_.data(), 1, out.pos, to_.get()) != out.pos) return false;
    if (last ? left == 0 : in.pos == in.size) return true;
  }
}

void SegmentCompressor::end(bool done) {
  from_.reset();
  // The segment itself is removed only when its copy is on the disk.
  const bool kept = done && to_ && keep(to_.get());
  to_.reset();
  std::error_code error, ignored;
  const std::filesystem::path file = waiting_.front(), written = part();
  waiting_.pop_front();
  if (kept) std::filesystem::rename(written, file.string() + ".zst", error);
  if (kept && !error) {
    std::filesystem::remove(file, ignored);
  } else {
    std::filesystem::remove(written, ignored);
  }
}

}  // namespace ergocast
