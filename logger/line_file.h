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

/// Lines wait until they are flushed, or are 64 KiB. What the disk does not take, half a line
/// included, stays here for the next try: once the stream is bad, clear() and flush() try again, and
/// whoever stops writing to a stream that is bad loses nothing and holds little.
class LineFile : public std::ostream {
 public:
  LineFile() : std::ostream(nullptr) { rdbuf(&waiting_); }
  /// Begins the file anew. The stream is bad if that fails.
  void open(const std::filesystem::path& file);
  /// Why the last try failed, as errno; 0: it did not.
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
