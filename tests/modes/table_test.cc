// SPDX-License-Identifier: BSD-3-Clause
// A table's bytes are read back unchanged, or refused: readers of a table do not check again.
#include "modes/table.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "core/basis/basis.h"
#include "modes/table_file.h"
#include "tests/modes/rooms.h"
#include "tests/support/temp_folder.h"

namespace ergocast {
namespace {

using Bytes = std::vector<std::byte>;

const Bytes& good() {
  static const Bytes bytes = [] {
    const FreeGrid grid = test::grid_of(test::square(), test::sees_through_the_door);
    return encode_table(grid, *eigen_modes(grid, 6), 42);
  }();
  return bytes;
}

Result<ModesTable> decoded(Bytes bytes) {
  const auto storage = std::make_shared<const Bytes>(std::move(bytes));
  return decode_table(*storage, storage);
}

TEST(Table, IsReadBackAsItWas) {
  const FreeGrid grid = test::grid_of(test::square(), test::sees_through_the_door);
  const auto modes = eigen_modes(grid, 6);
  const auto table = decoded(good());
  ASSERT_TRUE(table) << table.error();
  const FreeModes& read = **table;
  EXPECT_EQ(read.key, 42u);
  EXPECT_EQ(read.size_m, grid.size_m);
  EXPECT_TRUE(std::ranges::equal(read.owner, grid.owner));
  EXPECT_TRUE(std::ranges::equal(read.around, grid.around));
  EXPECT_TRUE(std::ranges::equal(read.place, grid.place));
  for (int k = 0; k < 6; ++k) {
    EXPECT_EQ(read.eigenvalues_per_m2[static_cast<std::size_t>(k)], modes->eigenvalues_per_m2[k]);
    EXPECT_EQ(read.values_of(100)[k], static_cast<float>(modes->values(100, k)));
  }
}

TEST(Table, OfOtherBytesHasAnotherHash) {
  Bytes other = good();
  other.back() ^= std::byte{1};
  const auto one = decoded(good()), two = decoded(other);
  ASSERT_TRUE(two);
  EXPECT_NE(one.value()->hash, two.value()->hash);
}

TEST(Table, IsRefusedInPartAndWithMore) {
  for (std::size_t size :
       {std::size_t{0}, std::size_t{7}, std::size_t{103}, std::size_t{104}, std::size_t{5000},
        good().size() / 2, good().size() - 4, good().size() - 1, good().size() + 1}) {
    Bytes bytes = good();
    bytes.resize(size);
    EXPECT_FALSE(decoded(bytes)) << size;
  }
}

/// Writes a number over the table's bytes.
template <class Number>
Bytes with(std::size_t at, Number number) {
  Bytes bytes = good();
  std::memcpy(bytes.data() + at, &number, sizeof number);
  return bytes;
}

TEST(Table, IsRefusedWithANumberThatNoneHas) {
  constexpr std::size_t kFormat = 8, kColumns = 12, kModes = 20, kWidth = 48, kVersion = 72,
                        kOwner = 104;
  const auto whole = decoded(good()).value();
  const FreeModes& read = *whole;
  const auto offset = [](const auto& numbers, const FreeModes& of) {
    return static_cast<std::size_t>(reinterpret_cast<const std::byte*>(numbers.data()) -
                                    of.file.data());
  };
  const auto storage = std::make_shared<const Bytes>(good());
  const auto table = decode_table(*storage, storage).value();
  const FreeModes& at = *table;
  const std::size_t around = offset(at.around, at), place = offset(at.place, at);
  const std::size_t nu = offset(at.eigenvalues_per_m2, at), squares = offset(at.mean_squares, at);
  const std::size_t values = offset(at.values, at);
  const float nan = std::nanf("");
  for (const Bytes& bad : {with<std::uint32_t>(kFormat, 2),
                           with<std::uint32_t>(kColumns, 0),
                           with<std::uint32_t>(kColumns, 1000000),
                           with<std::uint32_t>(kModes, 0),
                           with<double>(kWidth - 8, nan),
                           with<double>(kWidth, 0.0),
                           with<char>(kVersion, 'x'),
                           with<std::int32_t>(kOwner, -1),
                           with<std::int32_t>(kOwner, read.cell_count),
                           with<std::int32_t>(around + 8, read.cell_count),
                           with<std::int32_t>(place, 6400),
                           with<double>(nu, 1e-9),
                           with<double>(nu + 8, 0.0),
                           with<double>(nu + 8, 1.0),
                           with<double>(squares + 8, 0.0),
                           with<double>(squares, std::nan("")),
                           with<double>(squares + 8, 1e-300),
                           with<double>(squares + 8, 1.5),
                           with<float>(values, 0.5F),
                           with<float>(values + 4, 1.5F),
                           with<float>(values + 4, nan)}) {
    EXPECT_FALSE(decoded(bad));
  }
}

// An accepted table can be read at any place.
TEST(Table, ThatIsAcceptedIsSafeToRead) {
  std::minstd_rand dice(5);
  int accepted = 0;
  for (int i = 0; i < 300; ++i) {
    Bytes bytes = good();
    for (int flip = 0; flip < 3; ++flip) {
      const std::size_t end = i % 2 == 0 ? 20000 : bytes.size();
      bytes[dice() % end] ^= static_cast<std::byte>(1U << dice() % 8);
    }
    auto table = decoded(std::move(bytes));
    if (!table) continue;
    ++accepted;
    Basis basis;
    basis.modes_x = 6;
    basis.free_domain = true;
    basis.table = *table;
    const Coefficients ones = Coefficients::Ones(6);
    for (const double x_m : {-1e9, 0.0, 3.0, 999.0, 1004.0, 2000.0, 1e9}) {
      const BasisAt at({x_m, 1987 - x_m, 0}, test::square(), basis);
      ASSERT_TRUE(weighted_gradient(at, basis, ones.data()).allFinite());
    }
  }
  EXPECT_GT(accepted, 10);
}

TEST(TableFile, IsNamedByItsHashAndReadBack) {
  const test::TempFolder folder;
  const ModesTable table = decoded(good()).value();
  ASSERT_FALSE(save_table(*table, folder.path()));
  ASSERT_FALSE(save_table(*table, folder.path())) << "again";
  const auto read = load_table(folder.path() / table_file_name(table->hash));
  ASSERT_TRUE(read) << read.error();
  EXPECT_EQ((*read)->hash, table->hash);
  EXPECT_TRUE(std::ranges::equal((*read)->values, table->values));
}

/// Whether this process maps a file of that name.
bool maps(const std::string& name) {
  std::ifstream in("/proc/self/maps");
  const std::string all((std::istreambuf_iterator<char>(in)), {});
  return all.find(name) != std::string::npos;
}

// A process that had mapped it would be killed.
TEST(TableFile, ThatIsCutOrOverwrittenAfterwardsHarmsNoReader) {
  const test::TempFolder folder;
  const ModesTable table = decoded(good()).value();
  ASSERT_FALSE(save_table(*table, folder.path()));
  const auto file = folder.path() / table_file_name(table->hash);
  const auto read = load_table(file).value();
  EXPECT_FALSE(maps(file));
  std::fstream(file, std::ios::in | std::ios::out) << std::string(good().size(), 'x');
  EXPECT_TRUE(std::ranges::equal(read->file, table->file));
  std::filesystem::resize_file(file, 0);
  EXPECT_TRUE(std::ranges::equal(read->file, table->file));
}

TEST(TableFile, ThatCannotBeChangedIsShared) {
  const std::string name = "sealed-table";
  const int sealed = memfd_create(name.c_str(), MFD_ALLOW_SEALING);
  ASSERT_GE(sealed, 0);
  ASSERT_EQ(write(sealed, good().data(), good().size()), static_cast<ssize_t>(good().size()));
  const std::string file = "/proc/self/fd/" + std::to_string(sealed);
  ASSERT_TRUE(load_table(file));
  EXPECT_FALSE(maps(name)) << "it can still change";
  ASSERT_EQ(fcntl(sealed, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_WRITE), 0);
  const auto read = load_table(file);
  ASSERT_TRUE(read) << read.error();
  EXPECT_TRUE(maps(name));
  EXPECT_TRUE(std::ranges::equal((*read)->file, good()));
  close(sealed);
}

TEST(TableFile, ThatIsNoneIsNamed) {
  const test::TempFolder folder;
  std::ofstream(folder.path() / "text") << "no table";
  for (const auto& file : {folder.path() / "missing", folder.path(), folder.path() / "text",
                           std::filesystem::path("/dev/null")}) {
    const auto read = load_table(file);
    ASSERT_FALSE(read) << file;
    EXPECT_TRUE(read.error().starts_with(file.string())) << read.error();
  }
}

TEST(TableFile, ThatCannotBeWrittenIsReported) {
  const ModesTable table = decoded(good()).value();
  const auto problem = save_table(*table, "/nowhere/at/all");
  ASSERT_TRUE(problem);
  EXPECT_NE(problem->find("cannot be written"), std::string::npos);
}

}  // namespace
}  // namespace ergocast
