// SPDX-License-Identifier: BSD-3-Clause
// Writes the first inputs of corpora, most of them binary: fuzz-seeds DIRECTORY. Run it again when
// the format of a message or of the plan has changed, or the program's version, which is in the
// plan.
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <variant>

#include "cli/doctor/peer_ledger.h"
#include "lcmtypes/channels.h"
#include "plan/plan.h"
#include "relay/packets.h"
#include "scenario/scenario.h"
#include "tests/fuzz/support/small_team.h"
#include "tests/lcmtypes/sample_messages.h"
#include "tests/scenario/water_column.h"
#include "tests/support/grey_png.h"

namespace ergocast::fuzz {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

/// Adds a file to a target's corpus.
class Seeds {
 public:
  explicit Seeds(fs::path corpora) : corpora_(std::move(corpora)) {}
  fs::path file(const std::string& target, const std::string& name) const {
    fs::create_directories(corpora_ / target);
    return corpora_ / target / name;
  }
  void add(const std::string& target, const std::string& name, const std::string& content) const {
    std::ofstream(file(target, name), std::ios::binary) << content;
  }

 private:
  fs::path corpora_;
};

std::string text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}
/// With its length before it, in two bytes.
std::string framed(const std::string& content) {
  return std::string{static_cast<char>(content.size() / 256),
                     static_cast<char>(content.size() % 256)} +
         content;
}

constexpr std::array<const char*, std::variant_size_v<Message>> kKinds{
    "hello",   "mission",    "contribution", "agent_status", "team_status", "stop",   "world",
    "command", "record_ack", "digest",       "amend",        "beacon",      "recall", "effort"};
static_assert(kKinds.back() != nullptr, "each kind of message has its name");

void datagrams(const Seeds& seeds) {
  for (const Message& message : test::every_message()) {
    const std::string channel = channel_of(message);
    const std::string bytes = text_of(test::encoded(message));
    seeds.add("datagram", kKinds[message.index()],
              static_cast<char>(channel.size()) + channel + bytes);
    seeds.add("overheard", kKinds[message.index()],
              framed("LC02" + std::string(4, '\1') + channel + '\0' + bytes));
  }
}

/// One turn of a conversation.
std::string turn(int wait, AgentId transmitter, const std::string& datagram) {
  return std::string{static_cast<char>(wait), static_cast<char>(transmitter)} + framed(datagram);
}

/// The messages of an undisturbed team, one of every kind at a time.
std::vector<std::string> everything_sent(SmallTeam& team) {
  std::vector<std::string> turns;
  std::map<std::size_t, int> sent;
  team.on_sent = [&](AgentId transmitter, const std::vector<std::byte>& bytes) {
    const auto message = decode(bytes, 0).value();
    const int most = std::holds_alternative<MissionPart>(message)    ? 6
                     : std::holds_alternative<Contribution>(message) ? 1
                                                                     : 3;
    if (++sent[message.index()] <= most) turns.push_back(turn(2, transmitter, text_of(bytes)));
  };
  for (int i = 0; i < 30; ++i) team.pass(i == 0 ? 0ms : 100ms);
  team.check();
  return turns;
}

void conversations(const Seeds& seeds) {
  for (int bit = -1; bit < 8; ++bit) {
    const auto features = static_cast<char>(bit < 0 ? 0 : 1 << bit);
    const std::string name = bit < 0 ? "plain" : "feature-" + std::to_string(bit);
    SmallTeam team(static_cast<std::uint8_t>(features));
    std::string sent;
    for (const std::string& turn : everything_sent(team)) sent += turn;
    std::string alone;
    for (int i = 0; i < 8; ++i) alone += turn(i < 6 ? 3 : 4, 0, "");
    seeds.add("team", name, std::string{features, '\0'} + alone);
    if (bit < 1) seeds.add("team", name + "-echo", std::string{features, '\0'} + sent);
    for (const char who : {0, 1, 2, 3, 4}) {
      const bool telling = bit < 1 || (bit == 6 && who == 0) || (bit == 7 && who == 1);
      if (!telling) continue;
      seeds.add("listener", name + "-" + std::to_string(who), std::string{features, who} + sent);
    }
  }
}

void probes(const Seeds& seeds) {
  doctor::PeerLedger ours(7, "here", "1"), theirs(8, "there", "1", 9);
  std::string heard;
  for (int i = 0; i < 6; ++i) {
    const Instant now{1s + i * 50ms};
    const doctor::Probe question = ours.next(now), answer = theirs.next(now);
    theirs.take(question, "10.0.0.1", now);
    std::vector<std::byte> bytes;
    doctor::write(answer, bytes);
    heard += framed(text_of(bytes));
  }
  seeds.add("probe", "six", heard);
}

/// Each kind of packet at the hub, at the site and in the group.
void relays(const Seeds& seeds) {
  const relay::Seal seal(nullptr);
  const auto turn = [](char what, const std::string& packet) { return what + framed(packet); };
  std::string all;
  for (const relay::Control& control : std::vector<relay::Control>{
           relay::Ask{5, 6}, relay::Cookie{6, {}}, relay::Join{5, 9, {}, 1000}, relay::Welcome{9},
           relay::Ping{5, 10, {1, 2, 3}, 0.1}, relay::Pong{10, {1, 2, 3}}, relay::Unknown{10},
           relay::Leave{5, 11}, relay::Question{}, relay::Report{5, "text"}}) {
    std::string packet = text_of(seal.write(control));
    packet.resize(packet.size() - sizeof(relay::CookieBytes));  // the target repairs the tag
    for (const int what : {0x80, 0x81, 0x84, 0x88}) all += turn(static_cast<char>(what), packet);
  }
  seeds.add("relay", "controls", all);
  std::string data;
  for (const Message& message : test::every_message()) {
    const std::string& channel = channel_of(message);
    const std::string datagram =
        "LC02" + std::string(4, '\1') + channel + '\0' + text_of(test::encoded(message));
    std::vector<std::byte> packet;
    relay::append_frame(packet, Bus::kSwarm, std::as_bytes(std::span(datagram)));
    data += turn(4, text_of(packet)) + turn(1, text_of(packet)) + turn(2, datagram);
  }
  seeds.add("relay", "data", data);
}

void plans(const Seeds& seeds) {
  const std::string small =
      "domain { size_x_m: 2000 size_y_m: 1000 } target { uniform_weight: 1 } "
      "basis { modes_x: 3 modes_y: 3 } law { u_max_mps: 10 } time { duration_s: 10 } "
      "agents { random_count: 2 }";
  const auto minimal = Scenario::parse(small, "small");
  seeds.add("plan", "small", text_of(encode_plan(minimal.value().mission())));
  const auto shipped = Scenario::load(ERGOCAST_SCENARIO_DIR "/quadrimodal_corners.textproto");
  seeds.add("plan", "quadrimodal_corners", text_of(encode_plan(shipped.value().mission())));
}

void pictures(const Seeds& seeds) {
  const auto slope = [](int column, int row, int) { return 16 * column + row; };
  test::write_png(seeds.file("map_png", "grey8"), 5, 4, {}, slope);
  test::write_png(seeds.file("map_png", "grey16"), 5, 4, {.bits = 16}, slope);
  test::write_png(seeds.file("map_png", "masked"), 5, 4, {.color = PNG_COLOR_TYPE_GRAY_ALPHA},
                  slope);
  test::write_png(seeds.file("map_png", "interlaced"), 5, 4, {.interlace = PNG_INTERLACE_ADAM7},
                  slope);
  test::write_png(seeds.file("map_png", "palette"), 5, 4, {.color = PNG_COLOR_TYPE_PALETTE},
                  [](int column, int, int) { return column % 2; });
  test::write_png(seeds.file("map_png", "colours"), 5, 4, {.color = PNG_COLOR_TYPE_RGB}, slope);
}

void grids(const Seeds& seeds) {
  test::WaterColumn().write(seeds.file("netcdf", "column"));
  test::NetcdfWriter(seeds.file("netcdf", "plane"), {{"y", 2}, {"x", 3}},
                     {{"x", {"x"}, {5, 15, 25}, {{"units", "m"}, {"axis", "X"}}},
                      {"y", {"y"}, {15, 5}, {{"units", "km"}}},
                      {"v",
                       {"y", "x"},
                       {1, -1, 3, -4, 5, 9999},
                       {{"_Unsigned", "true"},
                        {"scale_factor", 0.5},
                        {"missing_value", std::vector<double>{-1, 9999}},
                        {"valid_range", std::vector<double>{0, 1e4}}},
                       test::NetcdfType::kShort}});
}

void places(const Seeds& seeds) {
  const std::string field =
      "<Placemark><name>Field</name><Polygon><tessellate>1</"
      "tessellate><outerBoundaryIs><LinearRing>"
      "<coordinates>9.167,48.786,412 9.168,48.786,412 9.168,48.787,412 9.167,48.786,412"
      "</coordinates></LinearRing></outerBoundaryIs><innerBoundaryIs><LinearRing><coordinates>"
      "9.1676,48.7862 9.1678,48.7862 9.1678,48.7864</coordinates></LinearRing></innerBoundaryIs>"
      "</Polygon></Placemark>";
  const std::string head =
      "<?xml version='1.0'?>\n<kml xmlns='http://www.opengis.net/kml/2.2'><Document>";
  seeds.add("kml", "field", head + "<Folder>" + field + "</Folder></Document></kml>\n");
  seeds.add("kml", "point",
            head + "<Placemark><MultiGeometry><Point><coordinates>9,48</coordinates></Point>" +
                "</MultiGeometry></Placemark></Document></kml>\n");
}

}  // namespace
}  // namespace ergocast::fuzz

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: fuzz-seeds DIRECTORY\n");
    return 2;
  }
  const ergocast::fuzz::Seeds seeds(argv[1]);
  ergocast::fuzz::datagrams(seeds);
  ergocast::fuzz::conversations(seeds);
  ergocast::fuzz::probes(seeds);
  ergocast::fuzz::relays(seeds);
  ergocast::fuzz::plans(seeds);
  ergocast::fuzz::pictures(seeds);
  ergocast::fuzz::grids(seeds);
  ergocast::fuzz::places(seeds);
}
