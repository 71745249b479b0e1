// SPDX-License-Identifier: BSD-3-Clause
// The event log's limits, and a full disk.
#include "runtime/record/event_log.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <lcm/lcm-cpp.hpp>
#include <set>
#include <vector>

#include "runtime/record/event_log_reader.h"
#include "runtime/record/segment_compressor.h"
#include "tests/support/temp_folder.h"

/// Replaces the system's call, as for a disk that cannot keep its data.
static bool disk_fails = false;
extern "C" int fsync(int) { return disk_fails ? -1 : 0; }

namespace ergocast {
namespace {

namespace fs = std::filesystem;

/// An event of 1000 bytes, with LCM's header.
const std::vector<std::byte> kEvent(1000 - 28 - 4);

class EventLogTest : public ::testing::Test {
 protected:
  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) names.insert(entry.path().filename());
    return names;
  }
  std::uintmax_t bytes() const {
    std::uintmax_t bytes = 0;
    for (const auto& entry : fs::directory_iterator(folder_)) bytes += entry.file_size();
    return bytes;
  }
  /// The number of events in a segment, and whether it ends with a whole one.
  int events(const std::string& name) const {
    lcm::LogFile log(folder_ / name, "r");
    int count = 0;
    while (log.readNextEvent() != nullptr) ++count;
    EXPECT_EQ(fs::file_size(folder_ / name), static_cast<std::uintmax_t>(count) * 1000) << name;
    return count;
  }

  const test::TempFolder own_;
  const fs::path& folder_ = own_.path();
};

TEST_F(EventLogTest, ANumberThatASegmentOfOursCannotHaveIsNoNumber) {
  const std::set<std::string> foreign{"events-2147483647.lcm", "events-1000000000.lcm",
                                      "events-99999999999999999999.lcm", "events--1.lcm"};
  for (const std::string& name : foreign) std::ofstream(folder_ / name) << "a stranger's";
  const auto begin = [this] {
    EventLog log(folder_);
    log.write("NAME", kEvent);
    EXPECT_EQ(log.flush(), std::nullopt);
  };
  begin();
  EXPECT_EQ(events("events-000.lcm"), 1);
  // The last number of ours, and then one that no file has.
  std::ofstream(folder_ / "events-999999999.lcm") << "ours";
  begin();
  EXPECT_EQ(events("events-1000000001.lcm"), 1);
  EXPECT_EQ(fs::file_size(folder_ / "events-1000000000.lcm"), 12U);
  EXPECT_EQ(files().size(), 7U);
}

TEST_F(EventLogTest, HoldsNoMoreThanItsLimitAndLosesItsOldestSegmentsFirst) {
  EventLog log(folder_, {.segment_bytes = 10000, .total_bytes = 40000});
  for (int i = 0; i < 40; ++i) log.write("NAME", kEvent);
  EXPECT_EQ(log.flush(), std::nullopt);
  EXPECT_EQ(bytes(), 40000U);
  EXPECT_EQ(log.removed(), 0);
  log.write("NAME", kEvent);
  EXPECT_EQ(log.flush(), std::nullopt);
  EXPECT_EQ(log.removed(), 1);
  EXPECT_EQ(files(), (std::set<std::string>{"events-001.lcm", "events-002.lcm", "events-003.lcm",
                                            "events-004.lcm"}));
  for (int i = 0; i < 1000; ++i) {
    log.write("NAME", kEvent);
    ASSERT_LE(bytes(), 40000U) << i;
  }
}

TEST_F(EventLogTest, CompressesFinishedSegmentsIntoWhatZstdTurnsBackIntoTheSameBytes) {
  const auto log_25_events = [this](bool compressed) {
    EventLog log(folder_, {.segment_bytes = 10000, .compressed = compressed});
    for (int i = 0; i < 25; ++i) log.write("NAME", kEvent);
    EXPECT_EQ(log.flush(), std::nullopt);
  };
  log_25_events(false);
  std::ofstream(folder_ / "events-001.lcm.zst.part") << "what a killed process left";
  log_25_events(true);
  EXPECT_EQ(files(),
            (std::set<std::string>{"events-000.lcm.zst", "events-001.lcm.zst", "events-002.lcm.zst",
                                   "events-003.lcm.zst", "events-004.lcm.zst", "events-005.lcm"}));
  for (const auto& [name, held] : {std::pair{"events-001.lcm", 10}, std::pair{"events-002.lcm", 5},
                                   std::pair{"events-004.lcm", 10}}) {
    const fs::path file = folder_ / name;
    EXPECT_LT(fs::file_size(file.string() + ".zst"), 1000U) << "zeros";
    ASSERT_EQ(std::system(("zstd -q -d " + file.string() + ".zst").c_str()), 0);
    EXPECT_EQ(events(name), held) << name;
  }
}

TEST_F(EventLogTest, CompressesAFinishedSegmentWhileHalfOfTheNextIsWritten) {
  constexpr int kEvents = 2048;
  EventLog log(folder_, {.segment_bytes = kEvents * 1000, .compressed = true});
  for (int i = 0; i < kEvents + 100; ++i) log.write("NAME", kEvent);
  EXPECT_TRUE(files().contains("events-000.lcm")) << "not at once: nothing waits for it";
  for (int i = 100; i < kEvents * 3 / 4; ++i) log.write("NAME", kEvent);
  EXPECT_EQ(files(), (std::set<std::string>{"events-000.lcm.zst", "events-001.lcm"}));
}

TEST_F(EventLogTest, CompressedSegmentsAreNumberedAndLimitedLikeOthers) {
  {
    EventLog log(folder_, {.segment_bytes = 10000, .compressed = true});
    for (int i = 0; i < 15; ++i) log.write("NAME", kEvent);
    log.flush();
    std::ofstream(folder_ / "events-000.lcm.zst") << std::string(26000, 'x');
  }
  EventLog log(folder_, {.segment_bytes = 10000, .total_bytes = 40000, .compressed = true});
  log.write("NAME", kEvent);
  EXPECT_EQ(files(), (std::set<std::string>{"events-001.lcm", "events-002.lcm"}));
  EXPECT_EQ(log.removed(), 1);
  log.discard();
  EXPECT_EQ(files(), (std::set<std::string>{"events-001.lcm"}));
}

TEST_F(EventLogTest, GoesOnAfterTheHighestNumberAndCountsWhatOthersLeft) {
  for (int i = 0; i < 3; ++i) {
    EventLog log(folder_, {.segment_bytes = 10000, .total_bytes = 20000});
    for (int event = 0; event < 10; ++event) log.write("NAME", kEvent);
  }
  EXPECT_EQ(files(), (std::set<std::string>{"events-001.lcm", "events-002.lcm"}));
}

/// A disk on which no file may grow beyond 5500 bytes.
class FullDisk {
 public:
  FullDisk() {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &former_);
    const rlimit full{5500, former_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &full);
  }
  ~FullDisk() { setrlimit(RLIMIT_FSIZE, &former_); }

 private:
  rlimit former_{};
};

TEST_F(EventLogTest, AFullDiskCostsEventsButTearsNone) {
  EventLog log(folder_);
  for (int i = 0; i < 3; ++i) log.write("NAME", kEvent);
  ASSERT_EQ(log.flush(), std::nullopt);
  {
    const FullDisk full;
    for (int i = 0; i < 5; ++i) log.write("NAME", kEvent);
    EXPECT_NE(log.flush(), std::nullopt);
    log.write("NAME", kEvent);
  }
  EXPECT_EQ(events("events-000.lcm"), 5);
  EXPECT_EQ(log.flush(), std::nullopt);
  log.write("NAME", kEvent);
  ASSERT_EQ(log.flush(), std::nullopt);
  EXPECT_EQ(events("events-001.lcm"), 1);
}

/// The names of all events that the reader finds, and its problem.
std::string read_back(const fs::path& folder) {
  auto opened = EventLogReader::open(folder);
  if (!opened) return opened.error();
  auto& reader = *opened;
  std::string printed;
  while (const LoggedEvent* event = reader.next()) {
    EXPECT_EQ(event->time_us, 1000000 + event->bytes.size());
    printed += event->channel + ' ';
  }
  return printed + reader.problem().value_or("");
}

class EventLogReaderTest : public EventLogTest {
 protected:
  /// Events of 100 bytes and more, four to a segment.
  void write(std::initializer_list<const char*> names) const {
    EventLog log(folder_, {.segment_bytes = 4 * 129, .total_bytes = 1 << 20});
    std::size_t size = 100;
    for (const char* name : names) {
      const std::vector<std::byte> bytes(size++);
      log.write(name, bytes, 1000000 + static_cast<std::int64_t>(bytes.size()));
    }
    EXPECT_EQ(log.flush(), std::nullopt);
  }
  fs::path segment(int number) const {
    return folder_ / ("events-00" + std::to_string(number) + ".lcm");
  }
};

TEST_F(EventLogReaderTest, GivesBackEachEventOfAllSegmentsInOrder) {
  write({"A", "B", "C", "D", "E", "F"});
  EXPECT_TRUE(fs::exists(segment(1)));
  EXPECT_EQ(read_back(folder_), "A B C D E F ");
}

TEST_F(EventLogReaderTest, ASegmentStaysUntilTheDiskHasItsCompressedCopy) {
  write({"A", "B", "C", "D", "E", "F"});
  const auto compress = [&] {
    SegmentCompressor compressor;
    compressor.add(segment(0));
    while (!compressor.idle()) compressor.work(1 << 20);
  };
  disk_fails = true;
  compress();
  disk_fails = false;
  EXPECT_TRUE(fs::exists(segment(0)));
  EXPECT_FALSE(fs::exists(segment(0).string() + ".zst"));
  compress();
  EXPECT_FALSE(fs::exists(segment(0)));
}

TEST_F(EventLogReaderTest, ReadsCompressedSegmentsAsTheyAre) {
  write({"A", "B", "C", "D", "E", "F"});
  SegmentCompressor compressor;
  compressor.add(segment(0));
  while (!compressor.idle()) compressor.work(1 << 20);
  ASSERT_FALSE(fs::exists(segment(0)));
  EXPECT_EQ(read_back(folder_), "A B C D E F ");
  // If both files exist, the one that is not compressed is read.
  const fs::path packed = segment(0).string() + ".zst";
  fs::copy_file(segment(1), segment(0));
  EXPECT_EQ(read_back(folder_), "E F E F ");
  fs::remove(segment(0));
  // A file may have several frames, as zstd may write them.
  const fs::path frame = folder_ / "frame";
  fs::copy_file(packed, frame);
  std::ofstream(packed, std::ios::app | std::ios::binary) << std::ifstream(frame).rdbuf();
  EXPECT_EQ(read_back(folder_), "A B C D A B C D E F ");
  fs::rename(frame, packed);
  // A killed logger leaves no incomplete file, so one is damaged.
  for (const std::uintmax_t size : {fs::file_size(packed) - 1, std::uintmax_t{0}}) {
    fs::resize_file(packed, size);
    const std::string read = read_back(folder_);
    EXPECT_NE(read.find(packed.string() + ", byte "), std::string::npos) << read;
    EXPECT_NE(
        read.find(
            ": damaged; everything before it is sound: `zstd -dc events-000.lcm.zst | head -c "),
        std::string::npos)
        << read;
    EXPECT_EQ(read.find("E F"), std::string::npos) << read;
  }
}

TEST_F(EventLogReaderTest, LeavesOutWhatAKilledLoggerBegan) {
  write({"A", "B", "C", "D", "E", "F"});
  for (const int number : {0, 1})
    fs::resize_file(segment(number), fs::file_size(segment(number)) - 1);
  EXPECT_EQ(read_back(folder_), "A B C E ");
}

TEST_F(EventLogReaderTest, NamesFileByteAndRemedyOfDamage) {
  write({"A", "B", "C"});
  const auto spoil = [&](int at, char byte) {
    std::fstream file(segment(0), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(at);
    file.put(byte);
  };
  spoil(129, 0);
  const std::string place = segment(0).string() + ", byte 129: ";
  const std::string remedy =
      "; everything before it is sound: `truncate -s 129` on a copy keeps it";
  EXPECT_EQ(read_back(folder_), "A " + place + "no event of LCM's log format" + remedy);
  spoil(129, '\xED');
  EXPECT_EQ(read_back(folder_), "A B C ");
  spoil(129 + 24, 1);
  EXPECT_EQ(read_back(folder_),
            "A " + place + "an event longer than any message of Ergocast" + remedy);
}

TEST_F(EventLogReaderTest, NamesWhatIsMissing) {
  EXPECT_NE(read_back(folder_).find("has no event log"), std::string::npos);
  EXPECT_NE(read_back(folder_ / "none").find("name a run directory"), std::string::npos);
  write({"A", "B", "C", "D", "E"});
  write({"F", "G"});
  fs::remove(segment(1));
  EXPECT_NE(read_back(folder_).find("events-002.lcm: the segment before it is missing"),
            std::string::npos);
}

}  // namespace
}  // namespace ergocast
