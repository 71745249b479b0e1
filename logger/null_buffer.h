// SPDX-License-Identifier: BSD-3-Clause
// A stream that discards tables.
#pragma once

#include <ostream>
#include <streambuf>

namespace ergocast {

/// Accepts everything and is always good, like a file on an unlimited disk. A stream without a
/// buffer would be bad from the beginning, as on a full disk.
class NullBuffer : public std::ostream {
 public:
  NullBuffer() : std::ostream(nullptr) { rdbuf(&buffer_); }

 private:
  struct Buffer : std::streambuf {
    std::streamsize xsputn(const char*, std::streamsize count) override { return count; }
    int_type overflow(int_type c) override { return traits_type::not_eof(c); }
  };
  Buffer buffer_;
};

}  // namespace ergocast
