// SPDX-License-Identifier: BSD-3-Clause
// Reads lengths and masks byte by byte. Each violation ends the reading for good.
#include "cli/foxglove/websocket.h"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "report/base64.h"

namespace ergocast::cli {
namespace {

/// A client must not send frames with a longer one of these.
constexpr std::size_t kLongestControl = 125;
constexpr std::uint16_t kProtocolError = 1002, kTooLong = 1009;
/// RFC 6455, 1.3.
constexpr const char* kServerKey = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11";

std::string lower(std::string_view text) {
  std::string small(text);
  std::ranges::transform(small, small.begin(), [](unsigned char c) {
    return c < 128 ? static_cast<char>(std::tolower(c)) : static_cast<char>(c);
  });
  return small;
}

std::string_view trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t");
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

/// The text up to a separator, which is removed with it; all if there is none.
std::string_view cut(std::string_view& text, std::string_view separator) {
  const std::string_view part = text.substr(0, text.find(separator));
  text.remove_prefix(std::min(text.size(), part.size() + separator.size()));
  return part;
}

bool is_control(Opcode opcode) { return opcode >= Opcode::kClose; }

bool is_known(int opcode) { return opcode <= 2 || (opcode >= 8 && opcode <= 10); }

std::uint64_t number(std::string_view bytes) {
  std::uint64_t value = 0;
  for (const char byte : bytes) value = value << 8 | static_cast<unsigned char>(byte);
  return value;
}

}  // namespace

std::optional<RequestHead> RequestHead::parse(std::string_view text) {
  std::string_view line = cut(text, "\r\n");
  RequestHead head;
  head.method = cut(line, " ");
  head.target = cut(line, " ");
  if (head.method.empty() || !head.target.starts_with('/') || line != "HTTP/1.1")
    return std::nullopt;
  while (!(line = cut(text, "\r\n")).empty()) {
    const auto colon = line.find(':');
    if (colon == line.npos || colon == 0) return std::nullopt;
    head.headers.emplace(lower(line.substr(0, colon)), trimmed(line.substr(colon + 1)));
  }
  return head;
}

std::string RequestHead::value(const std::string& name) const {
  return headers.count(name) == 1 ? headers.find(name)->second : "";
}

bool RequestHead::lists(const std::string& name, std::string_view word) const {
  const auto [begin, end] = headers.equal_range(name);
  return std::any_of(begin, end, [&](const auto& header) {
    for (std::string_view words = header.second; !words.empty();)
      if (lower(trimmed(cut(words, ","))) == lower(word)) return true;
    return false;
  });
}

std::optional<std::string> websocket_accept(const std::string& key) {
  const bool is_key = key.size() == 24 && key.ends_with("==") &&
                      key.find_first_not_of(
                          "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                          "0123456789+/") == 22;
  if (!is_key) return std::nullopt;
  const std::string text = key + kServerKey;
  std::array<char, EVP_MAX_MD_SIZE> hash;
  unsigned size = 0;
  if (EVP_Digest(text.data(), text.size(), reinterpret_cast<unsigned char*>(hash.data()), &size,
                 EVP_sha1(), nullptr) != 1)
    return std::nullopt;
  return base64({hash.data(), size});
}

std::string frame_head(Opcode opcode, std::size_t size) {
  std::string head(1, static_cast<char>(0x80 | static_cast<int>(opcode)));
  const int bytes = size < 126 ? 0 : size < 65536 ? 2 : 8;
  head += static_cast<char>(bytes == 0 ? size : bytes == 2 ? 126 : 127);
  for (int i = bytes - 1; i >= 0; --i)
    head += static_cast<char>(std::uint64_t{size} >> (8 * i) & 0xff);
  return head;
}

std::string frame(Opcode opcode, std::string_view payload) {
  return frame_head(opcode, payload.size()).append(payload);
}

std::string close_frame(std::uint16_t code) {
  const char payload[] = {static_cast<char>(code >> 8), static_cast<char>(code & 0xff)};
  return frame(Opcode::kClose, {payload, sizeof payload});
}

void FrameReader::add(std::string_view bytes) {
  if (violation_) return;
  bytes_.erase(0, std::exchange(used_, 0));
  bytes_ += bytes;
}

std::nullopt_t FrameReader::violate(std::uint16_t code) {
  violation_ = code;
  bytes_.clear();
  unfinished_.reset();
  used_ = 0;
  return std::nullopt;
}

/// The length is judged before the frame has arrived, so a long one takes no memory.
std::optional<FrameReader::Frame> FrameReader::take_frame() {
  constexpr std::size_t kHead = 2, kMask = 4;
  const std::string_view rest = std::string_view(bytes_).substr(used_);
  if (rest.size() < kHead) return std::nullopt;
  const auto first = static_cast<unsigned char>(rest[0]);
  const auto second = static_cast<unsigned char>(rest[1]);
  const bool is_last = (first & 0x80) != 0, is_masked = (second & 0x80) != 0;
  if ((first & 0x70) != 0 || !is_masked || !is_known(first & 0x0f)) return violate(kProtocolError);
  const auto opcode = static_cast<Opcode>(first & 0x0f);
  const int short_size = second & 0x7f;
  if (is_control(opcode) && (!is_last || short_size > static_cast<int>(kLongestControl)))
    return violate(kProtocolError);
  const std::size_t extra = short_size < 126 ? 0 : short_size == 126 ? 2 : 8;
  if (rest.size() < kHead + extra + kMask) return std::nullopt;
  const std::uint64_t size =
      extra == 0 ? static_cast<std::uint64_t>(short_size) : number(rest.substr(kHead, extra));
  if (size > kLongestMessage) return violate(kTooLong);
  const std::size_t begin = kHead + extra + kMask;
  if (rest.size() < begin + size) return std::nullopt;
  Frame frame{opcode, is_last, std::string(rest.substr(begin, size))};
  for (std::size_t i = 0; i < size; ++i)
    frame.payload[i] = static_cast<char>(frame.payload[i] ^ rest[begin - kMask + i % kMask]);
  used_ += begin + size;
  return frame;
}

/// The message that this frame completes, if it completes one.
std::optional<FrameReader::Message> FrameReader::join(Frame frame) {
  if (is_control(frame.opcode)) return Message{frame.opcode, std::move(frame.payload)};
  const bool continues = frame.opcode == Opcode::kContinuation;
  if (continues != unfinished_.has_value()) return violate(kProtocolError);
  if (!continues) unfinished_ = Message{frame.opcode, {}};
  if (unfinished_->payload.size() + frame.payload.size() > kLongestMessage)
    return violate(kTooLong);
  unfinished_->payload += frame.payload;
  if (!frame.is_last) return std::nullopt;
  return std::exchange(unfinished_, std::nullopt);
}

std::optional<FrameReader::Message> FrameReader::next() {
  while (!violation_) {
    auto frame = take_frame();
    if (!frame) return std::nullopt;
    if (auto message = join(*std::move(frame))) return message;
  }
  return std::nullopt;
}

}  // namespace ergocast::cli
