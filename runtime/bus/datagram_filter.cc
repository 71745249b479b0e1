// SPDX-License-Identifier: BSD-3-Clause
// Assembles a classic BPF program that compares magic, channel name, length and sequence number.
#include "runtime/bus/datagram_filter.h"

#include <linux/filter.h>
#include <sys/socket.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lcmtypes/channels.h"
#include "runtime/bus/lcm_datagram.h"

namespace ergocast {
namespace {

// Offsets count from the UDP header.
constexpr std::uint32_t kUdpHeaderBytes = 8;
constexpr std::uint32_t kMagicAt = kUdpHeaderBytes, kNameAt = kUdpHeaderBytes + kLcmHeaderBytes;
constexpr std::uint32_t kKeepAll = 0xffff, kReject = 0;
/// The shortest message; names and numbers lie within these bytes.
constexpr std::uint32_t kShortest = kNameAt + 60;
constexpr std::uint32_t kLongest = kUdpHeaderBytes + kMaxLcmBytes;
/// Offsets within a message.
constexpr std::uint32_t kLifeAt = 20, kSequenceAt = 28;

/// A program for the kernel. Jumps only go forward, and conditional jumps only a short distance.
class Filter {
 public:
  Filter(MessageTypes types, std::span<const Repeated> flooded, bool replays)
      : to_repeats_(!flooded.empty()) {
    load(BPF_LD | BPF_W | BPF_LEN, 0);
    pass_if(BPF_JGE, kShortest);
    code_.push_back(BPF_JUMP(BPF_JMP | BPF_JGT | BPF_K, kLongest, 0, 1));
    end(kReject);
    load(BPF_LD | BPF_W | BPF_ABS, kMagicAt);
    pass_if(BPF_JEQ, kLcmMagic);
    for (std::size_t type = 0; type < kMessageTypeCount; ++type) {
      if ((types >> type & 1) == 0) continue;
      const ChannelName& name = channel_names()[type];
      accept(name.text, name.per_agent);
      if (replays) accept(replayed(name.text), name.per_agent);
    }
    end(kReject);
    if (to_repeats_) drop_repeats(flooded);
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
  /// Keeps a datagram whose message begins at `message_at`. If repeats are to be dropped, it goes
  /// to the search for them instead.
  void keep(std::uint32_t message_at) {
    if (!to_repeats_) return end(kKeepAll);
    load(BPF_LDX | BPF_IMM, message_at);
    keeps_.push_back(code_.size());
    load(BPF_JMP | BPF_JA, 0);
  }
  /// Continues if the comparison of the loaded value with `value` holds; otherwise ends with
  /// kReject.
  void pass_if(int compare, std::uint32_t value) {
    code_.push_back(BPF_JUMP(static_cast<std::uint16_t>(BPF_JMP | compare | BPF_K), value, 1, 0));
    end(kReject);
  }

  /// Keeps a datagram of that name; for others the program continues after this code.
  void accept(std::string_view name, bool per_agent) {
    std::string text(name);
    if (!per_agent) text.push_back('\0');
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
    if (per_agent) accept_number(at);
    if (!per_agent) keep(at);
    for (const std::size_t miss : misses) {
      code_[miss].jf = static_cast<std::uint8_t>(code_.size() - miss - 1);
    }
  }

  /// Accepts "NEW" or one to four digits, then the end of the name.
  void accept_number(std::uint32_t at) {
    load(BPF_LD | BPF_W | BPF_ABS, at);
    skip_unless(0x4e455700, [&] { keep(at + 4); });
    for (std::uint32_t digit = 0; digit < 4; ++digit) {
      load(BPF_LD | BPF_B | BPF_ABS, at + digit);
      pass_if(BPF_JGE, '0');
      code_.push_back(BPF_JUMP(BPF_JMP | BPF_JGT | BPF_K, '9', 0, 1));
      end(kReject);
      load(BPF_LD | BPF_B | BPF_ABS, at + digit + 1);
      skip_unless(0, [&] { keep(at + digit + 2); });
    }
    end(kReject);
  }
  /// Runs `then` if the loaded value is `value`.
  template <class Then>
  void skip_unless(std::uint32_t value, const Then& then) {
    const std::size_t jump = code_.size();
    code_.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, 0, 0));
    then();
    code_[jump].jf = static_cast<std::uint8_t>(code_.size() - jump - 1);
  }

  /// All kept datagrams arrive here, with the offset of the message in X.
  void drop_repeats(std::span<const Repeated> flooded) {
    for (const std::size_t from : keeps_)
      code_[from].k = static_cast<std::uint32_t>(code_.size() - from - 1);
    load(BPF_LD | BPF_W | BPF_IND, kSequenceAt);
    code_.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, 0, 1, 0));
    end(kKeepAll);  // above 32 bits, which no sender has reached
    load(BPF_LD | BPF_W | BPF_IND, kSequenceAt + 4);
    load(BPF_ST, 0);
    load(BPF_LD | BPF_W | BPF_IND, kLifeAt + 4);
    std::vector<std::size_t> repeats;
    for (const Repeated& one : flooded) {
      skip_unless(static_cast<std::uint32_t>(one.incarnation), [&] {
        load(BPF_LD | BPF_MEM, 0);
        code_.push_back(BPF_JUMP(BPF_JMP | BPF_JGT | BPF_K, sequence_of(one), 0, 1));
        end(kKeepAll);
        repeats.push_back(code_.size());
        load(BPF_JMP | BPF_JA, 0);
      });
    }
    end(kKeepAll);
    for (const std::size_t from : repeats)
      code_[from].k = static_cast<std::uint32_t>(code_.size() - from - 1);
    load(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(SKF_AD_OFF + SKF_AD_RANDOM));
    code_.push_back(BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, UINT32_MAX / kShareThatPasses, 0, 1));
    end(kReject);
    end(kKeepAll);
  }
  static std::uint32_t sequence_of(const Repeated& one) {
    return static_cast<std::uint32_t>(std::clamp<std::int64_t>(one.newest, 0, UINT32_MAX));
  }

  std::vector<sock_filter> code_;
  const bool to_repeats_;
  std::vector<std::size_t> keeps_;  // jumps to the search for repeats
};

}  // namespace

bool admit_only(int socket, MessageTypes types, std::span<const Repeated> flooded, bool replays) {
  return Filter(types, flooded, replays).attach(socket);
}

}  // namespace ergocast
