// SPDX-License-Identifier: BSD-3-Clause
// Reads files of tables, or maps those that cannot change, and writes them under another name
// first.
#include "modes/table_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/base/ids.h"

namespace ergocast {
namespace {

/// Far above any table: 102400 cells of 4096 modes would be more, but take hours to compute.
constexpr off_t kMostBytes = off_t{1} << 30;

/// Bytes, and the storage that keeps them valid; null if there are none.
struct Loaded {
  std::shared_ptr<const void> storage;
  std::span<const std::byte> bytes;
};

/// Whether no process can shorten or overwrite the file. If another process shortened a mapped
/// file, the system would kill this one. If it overwrote the file, the numbers would change during
/// use.
bool is_sealed(int opened) {
  constexpr int kSeals = F_SEAL_SHRINK | F_SEAL_WRITE;
  const int seals = fcntl(opened, F_GET_SEALS);
  return seals >= 0 && (seals & kSeals) == kSeals;
}

Loaded mapped(int opened, std::size_t size) {
  void* const begin = mmap(nullptr, size, PROT_READ, MAP_SHARED, opened, 0);
  if (begin == MAP_FAILED) return {};
  return {{begin, [size](const void* at) { munmap(const_cast<void*>(at), size); }},
          {static_cast<const std::byte*>(begin), size}};
}

/// A copy of the file's bytes; fewer if the file becomes shorter meanwhile.
Loaded copied(int opened, std::size_t size) {
  const auto bytes = std::make_shared<std::vector<std::byte>>(size);
  std::size_t got = 0;
  while (got < size) {
    const ssize_t some = read(opened, bytes->data() + got, size - got);
    if (some < 0 && errno == EINTR) continue;
    if (some <= 0) break;
    got += static_cast<std::size_t>(some);
  }
  return {bytes, std::span(*bytes).first(got)};
}

Loaded loaded(const std::filesystem::path& file) {
  const int opened = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (opened < 0) return {};
  struct stat status {};
  Loaded loaded;
  const bool usable = fstat(opened, &status) == 0 && S_ISREG(status.st_mode) &&
                      status.st_size > 0 && status.st_size <= kMostBytes;
  if (usable) {
    const auto size = static_cast<std::size_t>(status.st_size);
    loaded = is_sealed(opened) ? mapped(opened, size) : copied(opened, size);
  }
  close(opened);
  return loaded;
}

}  // namespace

std::string table_file_name(std::uint64_t hash) { return "modes-" + to_hex(hash) + ".bin"; }

Result<ModesTable> load_table(const std::filesystem::path& file) {
  Loaded found = loaded(file);
  if (found.storage == nullptr)
    return failure(file.string() + ": cannot be read as a table of modes");
  auto table = decode_table(found.bytes, std::move(found.storage));
  if (!table) return failure(file.string() + ": " + table.error());
  return table;
}

std::optional<std::string> save_table(const FreeModes& table, const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / table_file_name(table.hash);
  std::error_code error;
  if (std::filesystem::file_size(file, error) == table.file.size() && !error) return std::nullopt;
  const std::filesystem::path part = file.string() + "." + std::to_string(getpid());
  std::ofstream stream(part, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(table.file.data()),
               static_cast<std::streamsize>(table.file.size()));
  stream.close();
  error.clear();
  if (stream) std::filesystem::rename(part, file, error);
  if (stream && !error) return std::nullopt;
  std::filesystem::remove(part, error);
  return file.string() + ": cannot be written: check the folder's permissions and the disk's room";
}

}  // namespace ergocast
