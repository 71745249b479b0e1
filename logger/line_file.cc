// SPDX-License-Identifier: BSD-3-Clause
// A stream buffer gathers lines, writes only whole ones, and after a failure cuts off what is no
// whole line.
#include "logger/line_file.h"

#include <algorithm>
#include <cerrno>

namespace ergocast {
namespace {

/// Limit (Record): rows of a table that wait for a disk [bytes]. Beyond it: no row is written or
/// acknowledged.
constexpr std::size_t kWaitingBytes = 65536;

}  // namespace

void LineFile::open(const std::filesystem::path& file) {
  errno = 0;
  waiting_.path = file;
  waiting_.file.reset(std::fopen(file.c_str(), "ab"));
  std::error_code error;
  std::filesystem::resize_file(file, 0, error);
  waiting_.error = errno;
  if (!waiting_.file || error) return setstate(badbit);
  std::setvbuf(waiting_.file.get(), nullptr, _IONBF, 0);
}

bool LineFile::Waiting::write() {
  if (!file) return false;
  const std::size_t whole = text.rfind('\n') + 1;  // 0 if there is none
  errno = 0;
  const std::size_t taken = std::fwrite(text.data(), 1, whole, file.get());
  error = errno;
  if (taken == whole) error = 0;
  std::clearerr(file.get());
  // Removes an incomplete line from the file.
  const std::size_t kept = taken == 0 ? 0 : text.rfind('\n', taken - 1) + 1;
  written_bytes += kept;
  std::error_code ignored;
  if (kept < taken) std::filesystem::resize_file(path, written_bytes, ignored);
  text.erase(0, kept);
  return taken == whole;
}

LineFile::Waiting::int_type LineFile::Waiting::overflow(int_type c) {
  if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
  const char one = traits_type::to_char_type(c);
  return xsputn(&one, 1) == 1 ? c : traits_type::eof();
}

std::streamsize LineFile::Waiting::xsputn(const char* some, std::streamsize count) {
  text.append(some, static_cast<std::size_t>(count));
  const bool room = text.size() < kWaitingBytes || write();
  return room ? count : 0;  // 0 makes the stream bad; the text is kept
}

}  // namespace ergocast
