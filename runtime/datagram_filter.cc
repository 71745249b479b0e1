#include "runtime/datagram_filter.h"

#include <linux/filter.h>
#include <sys/socket.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lcmtypes/channels.h"
#include "lcmtypes/seal.h"

namespace ergocast {
namespace {

// Offsets count from the UDP header.
constexpr std::uint32_t kUdpHeaderBytes = 8, kLcmHeaderBytes = 8;
constexpr std::uint32_t kMagicAt = kUdpHeaderBytes, kNameAt = kUdpHeaderBytes + kLcmHeaderBytes;
constexpr std::uint32_t kUnfragmented = 0x4c433032;  // "LC02"
constexpr std::uint32_t kKeepAll = 0xffff;
constexpr std::uint32_t kKeepTooLittle = kUdpHeaderBytes + 4;
/// No message of ours is shorter, and no name or number is looked for beyond it.
constexpr std::uint32_t kShortest = kNameAt + 60;
/// LCM allows names of 63 characters; what is longer than any message of ours only fills its queue.
constexpr std::uint32_t kLongest = kNameAt + 64 + static_cast<std::uint32_t>(kMaxDatagramBytes);

/// A program for the kernel, whose jumps go forward only and whose conditional ones not far.
class Filter {
 public:
  Filter() {
    load(BPF_LD | BPF_W | BPF_LEN, 0);
    pass_if(BPF_JGE, kShortest);
    code_.push_back(BPF_JUMP(BPF_JMP | BPF_JGT | BPF_K, kLongest, 0, 1));
    end(kKeepTooLittle);
    load(BPF_LD | BPF_W | BPF_ABS, kMagicAt);
    pass_if(BPF_JEQ, kUnfragmented);
    for (const ChannelName& name : channel_names()) accept(name);
    end(kKeepTooLittle);
  }

  bool attach(int socket) {
    sock_fprog program{static_cast<unsigned short>(code_.size()), code_.data()};
    return setsockopt(socket, SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof program) == 0;
  }

 private:
  void load(int what, std::uint32_t from) {
    code_.push_back(BPF_STMT(static_cast<std::uint16_t>(what), from));
  }
  void end(std::uint32_t keep) { load(BPF_RET | BPF_K, keep); }
  /// Goes on if what was loaded compares so with `value`, and else ends with kKeepTooLittle.
  void pass_if(int compare, std::uint32_t value) {
    code_.push_back(BPF_JUMP(static_cast<std::uint16_t>(BPF_JMP | compare | BPF_K), value, 1, 0));
    end(kKeepTooLittle);
  }

  /// Keeps a datagram of that name; others go on behind this.
  void accept(const ChannelName& name) {
    std::string text(name.text);
    if (!name.per_agent) text.push_back('\0');
    std::vector<std::size_t> misses;
    std::uint32_t at = kNameAt;
    for (std::string_view rest = text; !rest.empty();) {
      const std::size_t bytes = rest.size() >= 4 ? 4 : 1;
      std::uint32_t value = 0;
      for (const char c : rest.substr(0, bytes)) value = value << 8 | static_cast<unsigned char>(c);
      load(BPF_LD | (bytes == 4 ? BPF_W : BPF_B) | BPF_ABS, at);
      misses.push_back(code_.size());
      code_.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, 0, 0));
      rest.remove_prefix(bytes);
      at += static_cast<std::uint32_t>(bytes);
    }
    if (name.per_agent) accept_number(at);
    if (!name.per_agent) end(kKeepAll);
    for (const std::size_t miss : misses) {
      code_[miss].jf = static_cast<std::uint8_t>(code_.size() - miss - 1);
    }
  }

  /// "NEW" or one to three digits, and the name's end.
  void accept_number(std::uint32_t at) {
    load(BPF_LD | BPF_W | BPF_ABS, at);
    code_.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, 0x4e455700, 0, 1));
    end(kKeepAll);
    for (std::uint32_t digit = 0; digit < 3; ++digit) {
      load(BPF_LD | BPF_B | BPF_ABS, at + digit);
      pass_if(BPF_JGE, '0');
      code_.push_back(BPF_JUMP(BPF_JMP | BPF_JGT | BPF_K, '9', 0, 1));
      end(kKeepTooLittle);
      load(BPF_LD | BPF_B | BPF_ABS, at + digit + 1);
      code_.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, 0, 0, 1));
      end(kKeepAll);
    }
    end(kKeepTooLittle);
  }

  std::vector<sock_filter> code_;
};

}  // namespace

bool admit_only_our_channels(int socket) { return Filter().attach(socket); }

}  // namespace ergocast
