// SPDX-License-Identifier: BSD-3-Clause
// Maps files of tables into memory, and writes them under another name first.
#include "modes/table_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>

#include "core/ids.h"

namespace ergocast {
namespace {

/// Far above any table: 102400 cells of 4096 modes would be more, but take hours to compute.
constexpr off_t kMostBytes = off_t{1} << 30;

/// The bytes of a file as they are on the disk; null if it is none.
std::shared_ptr<const void> mapped(const std::filesystem::path& file, std::size_t& size) {
  const int opened = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (opened < 0) return nullptr;
  struct stat status {};
  void* begin = MAP_FAILED;
  // Of what is no file the size is 0, or it cannot be mapped.
  if (fstat(opened, &status) == 0 && status.st_size > 0 && status.st_size <= kMostBytes) {
    size = static_cast<std::size_t>(status.st_size);
    begin = mmap(nullptr, size, PROT_READ, MAP_SHARED, opened, 0);
  }
  close(opened);
  if (begin == MAP_FAILED) return nullptr;
  return {begin, [size](const void* at) { munmap(const_cast<void*>(at), size); }};
}

}  // namespace

std::string table_file_name(std::uint64_t hash) { return "modes-" + to_hex(hash) + ".bin"; }

std::variant<ModesTable, std::string> load_table(const std::filesystem::path& file) {
  std::size_t size = 0;
  const std::shared_ptr<const void> begin = mapped(file, size);
  if (begin == nullptr) return file.string() + ": cannot be read as a table of modes";
  auto table = decode_table({static_cast<const std::byte*>(begin.get()), size}, begin);
  if (const auto* problem = std::get_if<std::string>(&table)) {
    return file.string() + ": " + *problem + ": leave it out, and the table is computed anew";
  }
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
