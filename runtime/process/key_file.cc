// SPDX-License-Identifier: BSD-3-Clause
// Checks owner and permissions on the open file, then reads one `name hex` pair a line.
#include "runtime/process/key_file.h"

#include <fcntl.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string_view>

#include "core/base/require.h"

namespace ergocast {
namespace {

constexpr std::string_view kTitle = "ergocast key 1";
/// Limit (Commands): length of a key file [bytes]. Beyond it: the command refuses it.
constexpr std::size_t kLongestFile = 4096;

/// Closes the file in its destructor.
class File {
 public:
  explicit File(int fd) : fd_(fd) {}
  ~File() {
    if (fd_ >= 0) ::close(fd_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  int fd() const { return fd_; }

 private:
  int fd_;
};

template <std::size_t N>
std::string hex_of(const std::array<std::byte, N>& bytes) {
  std::array<char, 2 * N + 1> text;
  sodium_bin2hex(text.data(), text.size(), reinterpret_cast<const unsigned char*>(bytes.data()), N);
  return text.data();
}

template <std::size_t N>
bool from_hex(const std::string& text, std::array<std::byte, N>& bytes) {
  std::size_t size = 0;
  return sodium_hex2bin(reinterpret_cast<unsigned char*>(bytes.data()), N, text.data(), text.size(),
                        nullptr, &size, nullptr) == 0 &&
         size == N && text.size() == 2 * N;
}

/// Whether the open file is in the folder that systemd makes for one service. There an access
/// control list lets the service's user read the file, and its mask appears as the group's rights.
bool is_credential(const struct stat& info, const std::filesystem::path& file) {
  const char* folder = std::getenv("CREDENTIALS_DIRECTORY");
  if (folder == nullptr || *folder == '\0') return false;
  const std::filesystem::path there = std::filesystem::path(folder) / file.filename();
  struct stat same {};
  return lstat(there.c_str(), &same) == 0 && same.st_dev == info.st_dev &&
         same.st_ino == info.st_ino;
}

std::optional<std::string> why_not_private(const struct stat& info,
                                           const std::filesystem::path& file) {
  const std::string name = file.string();
  if (!S_ISREG(info.st_mode)) return name + ": not a file";
  const mode_t others = info.st_mode & 077;
  if (others != 0 && !(others == 040 && is_credential(info, file))) {
    return name + ": others than its owner may use this key; chmod 600 " + name;
  }
  // Root can read all files, but the owner of a file could still replace it.
  if (info.st_uid != geteuid() && info.st_uid != 0 && geteuid() != 0) {
    return name + ": belongs to another user; chown it to the user that runs this program";
  }
  return std::nullopt;
}

/// Reads one line; false if it does not belong in a key file.
bool read_line(const std::string& line, MissionKey& key, int& found) {
  std::istringstream words(line);
  std::string name, value, rest;
  words >> name >> value;
  if (words >> rest) return false;
  if (name == "shared") return (found |= 1) != 0 && from_hex(value, key.shared);
  if (name == "coordinator") return (found |= 2) != 0 && from_hex(value, key.coordinator);
  if (name == "signing") return from_hex(value, key.signing.emplace());
  return false;
}

/// Whether the two halves belong together; otherwise no receiver would accept the signatures.
bool halves_match(const MissionKey& key) {
  if (!key.signing) return true;
  MissionKey::Secret half;
  crypto_sign_ed25519_sk_to_pk(reinterpret_cast<unsigned char*>(half.data()),
                               reinterpret_cast<const unsigned char*>(key.signing->data()));
  return half == key.coordinator;
}

Result<MissionKey> parse(const std::string& text, const std::string& name) {
  std::istringstream lines(text);
  std::string line;
  MissionKey key;
  int found = 0, number = 1;
  const auto refuse = [&](const std::string& what) {
    return failure(name + ":" + std::to_string(number) + ": " + what +
                   "; `ergocast keygen` writes files as they should be");
  };
  if (!std::getline(lines, line) || line != kTitle) return refuse("not a key file of Ergocast");
  while (std::getline(lines, line)) {
    ++number;
    if (!line.empty() && !read_line(line, key, found)) return refuse("not a line of a key file");
  }
  if (found != 3) return refuse("the lines \"shared\" and \"coordinator\" are missing");
  if (!halves_match(key)) return refuse("\"signing\" and \"coordinator\" are of different keys");
  return key;
}

}  // namespace

MissionKey make_mission_key() {
  ERGOCAST_REQUIRE(sodium_init() >= 0);
  MissionKey key;
  randombytes_buf(key.shared.data(), key.shared.size());
  crypto_sign_keypair(reinterpret_cast<unsigned char*>(key.coordinator.data()),
                      reinterpret_cast<unsigned char*>(key.signing.emplace().data()));
  return key;
}

std::string key_text(const MissionKey& key, bool for_coordinator) {
  std::string text = std::string(kTitle) + "\nshared " + hex_of(key.shared) + "\ncoordinator " +
                     hex_of(key.coordinator) + "\n";
  if (for_coordinator) text += "signing " + hex_of(key.signing.value()) + "\n";
  return text;
}

Result<MissionKey> read_key_file(const std::filesystem::path& file) {
  const auto text = read_private_file(file, kLongestFile, "; `ergocast keygen` makes keys");
  if (!text) return failure(text.error());
  return parse(*text, file.string());
}

Result<std::string> read_private_file(const std::filesystem::path& file, std::size_t most_bytes,
                                      const std::string& remedy) {
  const std::string name = file.string();
  // The checks and the reading use one open file, even if the name changes meanwhile. A pipe must
  // not block us.
  const File opened(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat info {};
  if (opened.fd() < 0 || fstat(opened.fd(), &info) != 0) {
    return failure(name + ": " + std::strerror(errno) + remedy);
  }
  if (const auto problem = why_not_private(info, file)) return failure(*problem);
  std::string text(most_bytes + 1, '\0');
  const ssize_t size = ::read(opened.fd(), text.data(), text.size());
  if (size < 0) return failure(name + ": " + std::strerror(errno));
  if (size > static_cast<ssize_t>(most_bytes)) return failure(name + ": too long for a key");
  text.resize(static_cast<std::size_t>(size));
  return text;
}

std::optional<std::string> write_key_file(const std::filesystem::path& file,
                                          const std::string& text) {
  const std::string name = file.string();
  const File created(::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  if (created.fd() < 0) {
    const bool exists = errno == EEXIST;
    return name + ": " + std::strerror(errno) +
           (exists ? "; choose another name, or remove it when no team uses it any more" : "");
  }
  const bool written =
      ::write(created.fd(), text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
      ::fsync(created.fd()) == 0;
  if (written) return std::nullopt;
  const std::string why = std::strerror(errno);
  ::unlink(file.c_str());
  return name + ": " + why;
}

}  // namespace ergocast
