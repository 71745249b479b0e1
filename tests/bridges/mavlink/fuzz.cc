// SPDX-License-Identifier: BSD-3-Clause
// Bytes of a MAVLink link: what is read from them is written and read again as the same, however
// the bytes are cut. The first byte chooses where to cut them, and whether there is a key.
#include "bridges/mavlink/frame_reader.h"
#include "bridges/mavlink/frame_writer.h"
#include "tests/fuzz/target.h"

namespace ergocast::fuzz {

using mavlink::FrameReader;
using mavlink::FrameWriter;

FUZZ_TARGET(mavlink) {
  if (input.empty()) return;
  const std::uint8_t first = input[0];
  const auto bytes = bytes_of(input.subspan(1));
  std::optional<mavlink::SigningKey> key;
  if (first >= 128) key.emplace();
  FrameReader whole(key), cut(key);
  std::vector<mavlink::Received> all, same;
  whole.read(bytes, all);
  const std::size_t piece = first % 128 + 1;
  for (std::size_t at = 0; at < bytes.size(); at += piece)
    cut.read(bytes.subspan(at, std::min(piece, bytes.size() - at)), same);
  ERGOCAST_REQUIRE(all.size() == same.size());
  ERGOCAST_REQUIRE(whole.counts().read == static_cast<std::int64_t>(all.size()));
  for (const mavlink::Received& one : all) {
    FrameWriter writer;
    FrameReader reader;
    std::vector<mavlink::Received> again;
    reader.read(writer.frame_of(one.packet, one.from), again);
    ERGOCAST_REQUIRE(again.size() == 1 && again[0].from == one.from);
    ERGOCAST_REQUIRE(mavlink::payload_of(again[0].packet) == mavlink::payload_of(one.packet));
  }
}

}  // namespace ergocast::fuzz
