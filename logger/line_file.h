// SPDX-License-Identifier: BSD-3-Clause
// A text file that holds whole lines, also on a full disk.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <ostream>
#include <streambuf>
#include <string>

namespace ergocast {

/// Lines are buffered until they are flushed or are 64 KiB. After a write error, as on a full disk,
/// unwritten lines stay in the buffer and the stream is bad. clear() and flush() try again. If the
/// caller writes nothing to a bad stream, nothing is lost and the buffer stays small.
class LineFile : public std::ostream {
 public:
  LineFile() : std::ostream(nullptr) { rdbuf(&waiting_); }
  /// Begins the file anew. The stream is bad if that fails.
  void open(const std::filesystem::path& file);
  /// Why the last try failed, as errno; 0: it succeeded.
  int error() const { return waiting_.error; }

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  struct Waiting : std::streambuf {
    std::filesystem::path path;
    std::unique_ptr<std::FILE, Closer> file;
    std::string text;
    std::uintmax_t written_bytes = 0;
    int error = 0;

    ~Waiting() override { write(); }
    bool write();
    int sync() override { return write() ? 0 : -1; }
    int_type overflow(int_type c) override;
    std::streamsize xsputn(const char* some, std::streamsize count) override;
  };
  Waiting waiting_;
};

}  // namespace ergocast
