// SPDX-License-Identifier: BSD-3-Clause
// Targets from NetCDF grids: exact against the same cells as prisms, and each mistake refused.
#include "tests/scenario/water_column.h"

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <type_traits>

#include "target/target.h"
#include "tests/scenario/scenarios.h"
#include "tests/support/temp_folder.h"

namespace ergocast {
namespace {

using namespace test;

class WaterColumnTest : public ::testing::Test {
 protected:
  Loaded loaded(const WaterColumn& column, const std::string& choice = "time_index: 1") {
    column.write(folder_.path() / "column.nc");
    return Scenario::parse(water_column_scenario(choice),
                           (folder_.path() / "column.textproto").string());
  }
  Coefficients mu_of(const WaterColumn& column) {
    return good(loaded(column)).mission().target_coefficients;
  }
  std::string said_of_column(const WaterColumn& column,
                             const std::string& choice = "time_index: 1") {
    const Loaded result = loaded(column, choice);
    if (result) return "nothing";
    std::string all;
    for (const Problem& problem : result.error()) all += to_string(problem) + '\n';
    return all;
  }

  TempFolder folder_;
};

/// The same cells as regions.
TargetDensity prisms() {
  TargetDensity target;
  for (std::uint32_t k = 0; k + 1 < kDepthEdges_m.size(); ++k) {
    const Heights heights{-kDepthEdges_m[k + 1], -kDepthEdges_m[k]};
    for (std::uint32_t j = 0; j < kColumnY; ++j) {
      for (std::uint32_t i = 0; i < kColumnX; ++i) {
        const double x = 100.0 * i, y = 100.0 * j;
        const Polygon cell{{{x, y}, {x + 100, y}, {x + 100, y + 100}, {x, y + 100}}, {}};
        const double mass = chlorophyll(i, j, k) * heights.length_m();
        if (mass > 0) target.regions.push_back({mass, cell, heights});
      }
    }
  }
  return target;
}

TEST_F(WaterColumnTest, IsTheSumOfItsCells) {
  const Mission mission = good(loaded({})).mission();
  const Coefficients expected = target_coefficients(prisms(), mission.domain, mission.basis).values;
  EXPECT_LE((mission.target_coefficients - expected).cwiseAbs().maxCoeff(), 1e-13);
}

TEST_F(WaterColumnTest, MayBeWrittenInOtherWays) {
  const Coefficients mu = mu_of({});
  WaterColumn upwards;  // heights in place of depths, and so the bounds
  upwards.at("depth").attributes[1] = {"positive", "up"};
  for (double& value : upwards.at("depth").values) value = -value;
  for (double& value : upwards.at("depth_bounds").values) value = -value;
  EXPECT_EQ(mu_of(upwards), mu);
  WaterColumn unpacked;  // floats, nan for land
  NetcdfVariable& values = unpacked.at("chl");
  values.attributes = {{"_FillValue", std::nan("")}};
  values.type = NetcdfType::kDouble;
  for (double& value : values.values) value = value == -999 ? std::nan("") : 0.01 * value;
  EXPECT_LE((mu_of(unpacked) - mu).cwiseAbs().maxCoeff(), 1e-15);
}

// This ensures that scenarios/water_column.textproto uses the file tested here.
TEST_F(WaterColumnTest, IsTheFileThatIsShipped) {
  WaterColumn().write(folder_.path() / "column.nc");
  const auto bytes = [](const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const auto shipped_file = shipped("water_column").parent_path() / "maps/water_column.nc";
  EXPECT_EQ(bytes(shipped_file), bytes(folder_.path() / "column.nc"));
  EXPECT_EQ(good(Scenario::load(shipped("water_column"))).mission().target_coefficients, mu_of({}));
}

// A file of another convention, whose axes the scenario names.
TEST_F(WaterColumnTest, HasItsAxesByName) {
  const Coefficients mu = mu_of({});
  WaterColumn other;
  for (const auto& [axis, name] :
       {std::pair{"x", "east"}, {"y", "level"}, {"depth", "member"}, {"time", "x"}}) {
    const auto attributes = other.at(axis).attributes;
    other.rename(axis, name);
    for (const auto& attribute : attributes) {
      if (attribute.first != "axis" && attribute.first != "standard_name")
        other.at(name).attributes.push_back(attribute);
    }
  }
  const std::string names =
      "time_index: 1 x_axis: \"east\" y_axis: \"level\" z_axis: \"member\" time_axis: \"x\"";
  EXPECT_EQ(good(loaded(other, names)).mission().target_coefficients, mu);
  // Without names, "x" is taken for x.
  EXPECT_NE(said_of_column(other).find("x is in hours"), std::string::npos)
      << said_of_column(other);
  EXPECT_NE(said_of_column({}, "time_index: 1 y_axis: \"lat\"")
                .find("has no axis lat (write one of time, depth, y, x)"),
            std::string::npos);
  EXPECT_NE(said_of_column({}, "time_index: 1 x_axis: \"y\" y_axis: \"y\"")
                .find("its axis y was named twice"),
            std::string::npos);
  // What the file calls z is none when the scenario names another.
  EXPECT_NE(said_of_column({}, "time_index: 1 z_axis: \"y\"")
                .find("has the axis depth, which is none of x, y, z and time"),
            std::string::npos);
}

/// One layer of the column, without an axis z.
WaterColumn plane() {
  WaterColumn column;
  NetcdfVariable& values = column.at("chl");
  values.dimensions = {"time", "y", "x"};
  values.values.assign(values.values.begin() + 4 * kColumnX * kColumnY,
                       values.values.begin() + 5 * kColumnX * kColumnY);
  values.values.insert(values.values.begin(), kColumnX * kColumnY, -999);
  return column;
}
std::string plane_scenario() {
  std::string text = water_column_scenario();
  for (const std::string part : {" origin_z_m: -60 size_z_m: 60", " modes_z: 6"})
    text.erase(text.find(part), part.size());
  return text;
}

TEST_F(WaterColumnTest, OfOneLayerIsTheTargetOfAPlane) {
  const auto in_plane = [&](const WaterColumn& column) {
    column.write(folder_.path() / "column.nc");
    return Scenario::parse(plane_scenario(), (folder_.path() / "a.textproto").string());
  };
  const Mission mission = good(in_plane(plane())).mission();
  TargetDensity cells;
  for (std::uint32_t j = 0; j < kColumnY; ++j) {
    for (std::uint32_t i = 0; i < kColumnX; ++i) {
      const double x = 100.0 * i, y = 100.0 * j, mass = chlorophyll(i, j, 0);
      const Polygon cell{{{x, y}, {x + 100, y}, {x + 100, y + 100}, {x, y + 100}}, {}};
      if (mass > 0) cells.regions.push_back({mass, cell, {}});
    }
  }
  const Coefficients expected = target_coefficients(cells, mission.domain, mission.basis).values;
  EXPECT_LE((mission.target_coefficients - expected).cwiseAbs().maxCoeff(), 1e-13);
  WaterColumn single = plane();  // with a depth, which does not matter
  single.dimensions[1].second = 1;
  single.at("chl").dimensions = {"time", "depth", "y", "x"};
  EXPECT_EQ(good(in_plane(single)).mission().target_coefficients, mission.target_coefficients);
  WaterColumn listed = plane();  // several numbers for nothing
  auto& chl = listed.at("chl");
  for (double& value : chl.values) value = value == -999 ? -998 : value;
  chl.attributes.emplace_back("missing_value", std::vector<double>{-7, -998});
  EXPECT_EQ(good(in_plane(listed)).mission().target_coefficients, mission.target_coefficients);
  EXPECT_TRUE(has(problems_of(in_plane({})),
                  "chl has 4 layers, and the domain is a plane (write origin_z_m and size_z_m of "
                  "the domain, or keep one layer: ncks -d depth,0"));
  EXPECT_TRUE(has(said_of_column(plane()),
                  "chl is a plane without an axis z, and the domain is a "
                  "box (remove size_z_m of the domain"));
  WaterColumn away = plane();
  for (double& y : away.at("y").values) y += 10000;
  const std::string lost = problems_of(in_plane(away));
  EXPECT_TRUE(has(lost, "y 10000 to 10600 m, the domain x 0 to 800 m, y 0 to 600 m (move"));
}

TEST_F(WaterColumnTest, ReadsBackWhatItPrints) {
  const Scenario scenario = good(loaded({}));
  EXPECT_EQ(plan_of(good(Scenario::parse(scenario.print(), "/elsewhere/again"))),
            plan_of(scenario));
}

TEST_F(WaterColumnTest, RefusesEachMistakeWithItsRemedy) {
  using Change = void (*)(WaterColumn&);
  const std::pair<Change, std::string> mistakes[] = {
      {[](WaterColumn& c) { c.at("chl").name = "salt"; },
       "chl is none of its variables (write one of x, y, depth, depth_bounds, time, salt)"},
      {[](WaterColumn& c) { std::swap(c.at("y").values[1], c.at("y").values[3]); },
       "y does not ascend or descend throughout"},
      {[](WaterColumn& c) { c.at("x").values[3] += 0.02; }, "along x are not of one size"},
      {[](WaterColumn& c) { c.at("depth_bounds").values[3] = 20; },
       "depth does not ascend or descend throughout"},
      {[](WaterColumn& c) { c.at("depth").attributes[2].second = "nothing"; },
       "depth: nothing does not have the shape"},
      {[](WaterColumn& c) { c.at("x").attributes[1].second = "degrees_east"; },
       "x is in degrees_east (write it in m or km"},
      {[](WaterColumn& c) { c.at("x").attributes.pop_back(); }, "x has no units"},
      {[](WaterColumn& c) { c.at("x").values[2] = std::nan(""); },
       "x has a value that is no place"},
      {[](WaterColumn& c) { c.rename("depth", "member"); },
       "has the axis member, which is none of x, y, z and time"},
      {[](WaterColumn& c) { c.at("chl").values[300] = -1; }, "is negative"},
      {[](WaterColumn& c) { c.at("chl").attributes.emplace_back("valid_range", "0 100"); },
       "chl: its attribute valid_range has not the numbers that are due"},
      {[](WaterColumn& c) { c.at("chl").attributes.emplace_back("valid_range", 100.0); },
       "its attribute valid_range has not"},
      {[](WaterColumn& c) { c.at("chl").attributes.emplace_back("valid_max", "100"); },
       "its attribute valid_max has not"},
      {[](WaterColumn& c) { c.at("chl").attributes[0].second = "0.01"; },
       "its attribute scale_factor has not"},
      {[](WaterColumn& c) { c.rename("y", "lat"); }, "lat has no units"},
      {[](WaterColumn& c) {
         c.at("chl").type = NetcdfType::kDouble;
         c.at("chl").values[300] = std::nan("");
       },
       "is not a finite number"},
      {[](WaterColumn& c) {
         for (double& v : c.at("chl").values) v = 0;
       },
       "has no number above 0"},
      {[](WaterColumn& c) {
         for (double& v : c.at("y").values) v += 10000;
       },
       "nothing of it is left inside the domain"},
  };
  for (const auto& [change, printed] : mistakes) {
    WaterColumn column;
    change(column);
    const std::string heard = said_of_column(column);
    EXPECT_NE(heard.find(printed), std::string::npos) << printed << " is not in " << heard;
    EXPECT_NE(heard.find(":3:10: target.voxels[0]: "), std::string::npos) << heard;
  }
  EXPECT_NE(said_of_column({}, "").find("has 2 times (choose one: time_index: 0 to 1"),
            std::string::npos);
  EXPECT_NE(said_of_column({}, "time_index: 2").find("has no time of index 2"), std::string::npos);
}

// Its numbers are not even read.
TEST_F(WaterColumnTest, OfABillionCellsIsRefused) {
  WaterColumn column;
  column.grow(1000);
  const std::string printed = said_of_column(column, "");
  EXPECT_NE(printed.find("1000000000 cells, above the limit"), std::string::npos) << printed;
}

// libnetcdf would take the announced memory, and read zeros where the file has ended.
TEST_F(WaterColumnTest, ThatAnnouncesMoreThanItsFileHoldsIsRefused) {
  const auto file = folder_.path() / "column.nc";
  WaterColumn().write(file);
  std::ifstream in(file, std::ios::binary);
  const std::string sound(std::istreambuf_iterator<char>(in), {});
  const auto said_of_bytes = [&](const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
    const Loaded result =
        Scenario::parse(water_column_scenario(), (folder_.path() / "column.textproto").string());
    if (result) return std::string("nothing");
    return to_string(result.error()[0]);
  };
  ASSERT_EQ(said_of_bytes(sound), "nothing");
  // A name, the numbers of dimensions and of global attributes, the length of a text. Each is three
  // gigabytes.
  for (const std::size_t at :
       {sound.find("time") - 4, std::size_t{12}, sound.find("standard_name") + 20}) {
    std::string damaged = sound;
    damaged.replace(at, 4, "\xb2\xd0\x5e\x00", 4);
    EXPECT_NE(said_of_bytes(damaged).find("its header announces more than the file holds"),
              std::string::npos)
        << at << ": " << said_of_bytes(damaged);
  }
  const std::string cut = said_of_bytes(sound.substr(0, sound.size() - 40));
  EXPECT_NE(cut.find("chl ends at byte " + std::to_string(sound.size())), std::string::npos) << cut;
}

TEST_F(WaterColumnTest, WhoseCoordinatesHaveAnotherDimensionIsRefused) {
  WaterColumn column;
  column.dimensions.emplace_back("long", 4096);
  column.at("x").dimensions = {"long"};
  column.at("x").values.resize(4096);
  const std::string printed = said_of_column(column);
  EXPECT_NE(printed.find("x: x does not have the shape of its values"), std::string::npos)
      << printed;
}

/// Writes a file in HDF5, whose x is stored in one compressed part of `chunk` numbers.
class Hdf5Column {
 public:
  Hdf5Column(const std::filesystem::path& file, std::size_t chunk)
      : library_(dlopen("libnetcdf.so.19", RTLD_NOW)) {
    constexpr int kHdf5 = 0x1000;
    expect(function<int(const char*, int, int*)>("nc_create")(file.c_str(), kHdf5, &file_));
    const std::size_t lengths[] = {2, 2, 0};  // the last one grows
    const char* const names[] = {"depth", "y", "x"};
    const double values[] = {0, 100};
    int dimensions[3], axes[3], chl = 0;
    for (int i = 0; i < 3; ++i) {
      expect(function<int(int, const char*, std::size_t, int*)>("nc_def_dim")(
          file_, names[i], lengths[i], &dimensions[i]));
      axes[i] = variable(names[i], 1, &dimensions[i]);
      expect(function<int(int, int, const char*, std::size_t, const char*)>("nc_put_att_text")(
          file_, axes[i], "units", 1, "m"));
    }
    chl = variable("chl", 3, dimensions);
    expect(function<int(int, int, int, const std::size_t*)>("nc_def_var_chunking")(file_, axes[2],
                                                                                   0, &chunk));
    expect(function<int(int, int, int, int, int)>("nc_def_var_deflate")(file_, axes[2], 0, 1, 1));
    for (const int axis : axes) put(axis, values);
    const std::vector<double> ones(8, 1);
    put(chl, ones.data());
  }
  ~Hdf5Column() {
    expect(function<int(int)>("nc_close")(file_));
    dlclose(library_);
  }

 private:
  template <class Type>
  Type* function(const char* name) const {
    return reinterpret_cast<Type*>(dlsym(library_, name));
  }
  static void expect(int error) { ASSERT_EQ(error, 0); }
  int variable(const char* name, int count, const int* dimensions) const {
    constexpr int kDouble = 6;
    int made = 0;
    expect(function<int(int, const char*, int, int, const int*, int*)>("nc_def_var")(
        file_, name, kDouble, count, dimensions, &made));
    return made;
  }
  void put(int variable, const double* values) const {
    const std::size_t start[] = {0, 0, 0}, count[] = {2, 2, 2};
    expect(function<int(int, int, const std::size_t*, const std::size_t*, const double*)>(
        "nc_put_vara_double")(file_, variable, start, count, values));
  }

  void* library_;
  int file_ = 0;
};

TEST_F(WaterColumnTest, WhoseCoordinatesUnpackToMoreThanAChunkMayHaveIsRefused) {
  const auto said_with = [&](std::size_t chunk) {
    Hdf5Column(folder_.path() / "column.nc", chunk);
    const Loaded result =
        Scenario::parse(water_column_scenario(""), (folder_.path() / "column.textproto").string());
    return result ? "nothing" : to_string(result.error()[0]);
  };
  EXPECT_EQ(said_with(1000), "nothing");
  const std::string printed = said_with(9'000'000);
  EXPECT_NE(printed.find("x is stored in parts of more than 64 MiB"), std::string::npos) << printed;
}

/// Changes a file of Hdf5Column as an attacker would, with the HDF5 library that libnetcdf uses.
class Hdf5Attack {
 public:
  explicit Hdf5Attack(const std::filesystem::path& file)
      : library_(dlopen("libnetcdf.so.19", RTLD_NOW)) {
    expect(function<int()>("H5open")());
    constexpr unsigned kReadAndWrite = 1;
    file_ = function<Id(const char*, unsigned, Id)>("H5Fopen")(file.c_str(), kReadAndWrite, 0);
    expect(file_);
    expect(function<int(Id, const char*, Id)>("H5Ldelete")(file_, "chl", 0));
  }
  ~Hdf5Attack() {
    expect(function<int(Id)>("H5Fclose")(file_));
    dlclose(library_);
  }
  /// The numbers of chl are the bytes of another file.
  void store_in(const std::filesystem::path& other) {
    make_dataset([&](Id properties) {
      return function<int(Id, const char*, off_t, std::uint64_t)>("H5Pset_external")(
          properties, other.c_str(), 0, 64);
    });
  }
  /// The numbers of chl are those of a dataset of another file.
  void map_to(const std::filesystem::path& other) {
    make_dataset([&](Id properties) {
      const Id space = make_space();
      return function<int(Id, Id, const char*, const char*, Id)>("H5Pset_virtual")(
          properties, space, other.c_str(), "chl", space);
    });
  }
  void link_to(const std::filesystem::path& other) {
    expect(function<int(const char*, const char*, Id, const char*, Id, Id)>("H5Lcreate_external")(
        other.c_str(), "/chl", file_, "chl", 0, 0));
  }

 private:
  using Id = std::int64_t;
  template <class Type>
  Type* function(const char* name) const {
    return reinterpret_cast<Type*>(dlsym(library_, name));
  }
  Id constant(const char* name) const { return *static_cast<Id*>(dlsym(library_, name)); }
  static void expect(Id result) { ASSERT_GE(result, 0); }
  Id make_space() const {
    const std::uint64_t lengths[] = {2, 2, 2};
    return function<Id(int, const std::uint64_t*, const std::uint64_t*)>("H5Screate_simple")(
        3, lengths, nullptr);
  }
  template <class F>
  void make_dataset(const F& lay_out) {
    const Id properties = function<Id(Id)>("H5Pcreate")(constant("H5P_CLS_DATASET_CREATE_ID_g"));
    expect(lay_out(properties));
    const Id dataset = function<Id(Id, const char*, Id, Id, Id, Id, Id)>("H5Dcreate2")(
        file_, "chl", constant("H5T_NATIVE_DOUBLE_g"), make_space(), 0, properties, 0);
    expect(dataset);
    unsigned i = 0;
    for (const char* name : {"depth", "y", "x"}) {
      const Id scale = function<Id(Id, const char*, Id)>("H5Oopen")(file_, name, 0);
      expect(function<int(Id, Id, unsigned)>("H5DSattach_scale")(dataset, scale, i++));
      expect(function<int(Id)>("H5Oclose")(scale));
    }
    expect(function<int(Id)>("H5Oclose")(dataset));
  }

  void* library_;
  Id file_ = -1;
};

TEST_F(WaterColumnTest, ThatNamesAnotherFileOfTheHostIsRefused) {
  const auto file = folder_.path() / "column.nc", other = folder_.path() / "other.nc",
             bytes = folder_.path() / "secret";
  const std::vector<double> secret(8, 3);
  std::ofstream(bytes, std::ios::binary)
      .write(reinterpret_cast<const char*>(secret.data()), 8 * sizeof(double));
  const auto said_with = [&](const auto& attack) {
    Hdf5Column(file, 1000);
    Hdf5Column(other, 1000);
    if constexpr (!std::is_null_pointer_v<std::decay_t<decltype(attack)>>) {
      Hdf5Attack change(file);
      attack(change);
    }
    const Loaded result =
        Scenario::parse(water_column_scenario(""), (folder_.path() / "column.textproto").string());
    return result ? "nothing" : to_string(result.error()[0]);
  };
  EXPECT_EQ(said_with(nullptr), "nothing");
  const std::string wanted = "the numbers of chl are in another file, which is not read";
  for (const std::string& printed : {said_with([&](Hdf5Attack& one) { one.store_in(bytes); }),
                                     said_with([&](Hdf5Attack& one) { one.map_to(other); }),
                                     said_with([&](Hdf5Attack& one) { one.link_to(other); })})
    EXPECT_NE(printed.find(wanted), std::string::npos) << printed;
}

TEST_F(WaterColumnTest, OfNoNetcdfFileIsRefused) {
  std::ofstream(folder_.path() / "column.nc") << "x,y\n1,2\n";
  const Loaded text = Scenario::parse(water_column_scenario(), (folder_.path() / "f").string());
  ASSERT_FALSE(text);
  EXPECT_NE(to_string(text.error()[0]).find("is it a NetCDF file?"), std::string::npos);
}

}  // namespace
}  // namespace ergocast
