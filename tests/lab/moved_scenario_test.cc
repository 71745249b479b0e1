// SPDX-License-Identifier: BSD-3-Clause
// Coordinates are a person's choice. A scenario that is moved, or whose x and y are exchanged, has
// the same target, and its team takes the same paths. Domains are those that people write: decimal
// fractions, from a millimetre to a thousand kilometres.
#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <random>
#include <sstream>
#include <string>

#include "scenario/scenario.pb.h"
#include "tests/support/simulated_team.h"
#include "tests/support/temp_folder.h"

namespace ergocast::test {
namespace {

/// A number with three digits, as a person writes it.
double written(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return std::stod(text);
}

// ---- scenarios that are the same in shares of their domain ----

enum class Kind { kPlane, kBox, kWalls, kFreeDomain, kStations };

class Maker {
 public:
  Maker(Kind kind, unsigned seed) : kind_(kind), random_(seed) {
    const double scale_m = std::pow(10, between(-2, 6));
    for (int axis = 0; axis < 3; ++axis) {
      size_m_[axis] = written(scale_m * between(0.4, 1));
      origin_m_[axis] = written(scale_m * between(-2, 2));
      away_m_[axis] = written(scale_m * between(-2, 2));
    }
  }

  proto::Scenario scenario() {
    domain();
    target();
    scenario_.mutable_law()->set_u_max_mps(0.05 * size_m_.maxCoeff());
    scenario_.mutable_law()->set_perturbation(proto::Law::CONSTANT);
    scenario_.mutable_law()->set_noise_intensity(0);
    scenario_.mutable_time()->set_duration_s(10);
    scenario_.mutable_basis()->set_modes_x(8);
    scenario_.mutable_basis()->set_modes_y(7);
    if (kind_ == Kind::kBox) scenario_.mutable_basis()->set_modes_z(5);
    team();
    if (kind_ == Kind::kWalls || kind_ == Kind::kFreeDomain || kind_ == Kind::kStations) walls();
    scenario_.mutable_basis()->set_free_domain(kind_ == Kind::kFreeDomain);
    if (kind_ == Kind::kStations) stations();
    return scenario_;
  }
  const Eigen::Vector3d& away_m() const { return away_m_; }
  double side_m() const { return size_m_.maxCoeff(); }

 private:
  using Corner = Eigen::Vector2d;

  double between(double low, double high) {
    return std::uniform_real_distribution(low, high)(random_);
  }
  bool in_space() const { return kind_ == Kind::kBox; }
  double at(int axis, double share) const { return origin_m_[axis] + share * size_m_[axis]; }

  void domain() {
    proto::Domain& domain = *scenario_.mutable_domain();
    domain.set_origin_x_m(origin_m_.x());
    domain.set_origin_y_m(origin_m_.y());
    domain.set_size_x_m(size_m_.x());
    domain.set_size_y_m(size_m_.y());
    if (!in_space()) return;
    domain.set_origin_z_m(origin_m_.z());
    domain.set_size_z_m(size_m_.z());
  }

  void ring(const std::vector<Corner>& shares, proto::Polygon& polygon) {
    for (const Corner& share : shares) {
      proto::Vertex& vertex = *polygon.add_vertices();
      vertex.set_x_m(at(0, share.x()));
      vertex.set_y_m(at(1, share.y()));
    }
    if (!in_space()) return;
    const double low = between(0.1, 0.4);
    polygon.set_low_z_m(at(2, low));
    polygon.set_high_z_m(at(2, low + between(0.1, 0.5)));
  }
  static std::vector<Corner> box(double x, double y, double w, double h) {
    return {{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}};
  }

  proto::Gaussian& gaussian() {
    proto::Gaussian& gaussian = *scenario_.mutable_target()->add_gaussians();
    gaussian.set_mean_x_m(at(0, between(0.2, 0.8)));
    gaussian.set_mean_y_m(at(1, between(0.2, 0.8)));
    if (in_space()) gaussian.set_mean_z_m(at(2, between(0.2, 0.8)));
    return gaussian;
  }

  void target() {
    proto::Target& target = *scenario_.mutable_target();
    target.set_uniform_weight(0.4);
    gaussian().set_sigma_m(0.2 * size_m_.minCoeff());
    const Eigen::Vector3d deviation_m = size_m_ * between(0.1, 0.3);
    proto::Covariance& covariance = *gaussian().mutable_covariance();
    covariance.set_xx_m2(std::pow(deviation_m.x(), 2));
    covariance.set_yy_m2(std::pow(deviation_m.y(), 2));
    covariance.set_xy_m2(0.4 * deviation_m.x() * deviation_m.y());
    if (in_space()) {
      covariance.set_zz_m2(std::pow(deviation_m.z(), 2));
      covariance.set_xz_m2(0.3 * deviation_m.x() * deviation_m.z());
      covariance.set_yz_m2(-0.5 * deviation_m.y() * deviation_m.z());
    }
    ring({{between(0.1, 0.3), between(0.1, 0.3)},
          {between(0.6, 0.9), between(0.1, 0.3)},
          {between(0.1, 0.9), between(0.6, 0.9)}},
         *target.add_regions()->mutable_polygon());
    ring(box(between(0.1, 0.4), between(0.1, 0.4), between(0.1, 0.3), between(0.1, 0.3)),
         *target.add_keep_outs());
    ring(box(0, between(0.1, 0.8), 1, 0.05), *target.add_keep_outs());  // from edge to edge
    if (kind_ == Kind::kPlane) map();
  }

  void map() {
    proto::Map& map = *scenario_.mutable_target()->add_maps();
    map.set_file("map.csv");
    map.set_first_row(proto::Map::SOUTH);
    map.set_origin_x_m(at(0, between(-0.2, 0.3)));
    map.set_origin_y_m(at(1, between(-0.2, 0.3)));
    map.set_size_x_m(size_m_.x() * between(0.4, 0.8));
    map.set_size_y_m(size_m_.y() * between(0.4, 0.8));
  }

  void start(double x, double y, double z) {
    proto::Start& start = *scenario_.mutable_agents()->add_starts();
    start.set_x_m(at(0, x));
    start.set_y_m(at(1, y));
    if (in_space()) start.set_z_m(at(2, z));
  }
  void team() {
    start(0.03, 0.06, 0.1);
    start(0.95, 0.07, 0.8);
    start(1, 1, 1);  // in the corner
  }

  void walls() {
    scenario_.mutable_world()->set_speed_limit_mps(0.2 * size_m_.maxCoeff());
    scenario_.mutable_world()->set_wall_clearance_m(0.01 * size_m_.minCoeff());
    // Before an agent, and between the rooms.
    ring(box(0.12, -0.1, 0.03, 0.3), *scenario_.mutable_world()->add_walls());
    ring(box(between(0.5, 0.6), 0.3, between(0.05, 0.1), 0.8),
         *scenario_.mutable_world()->add_walls());
  }

  void stations() {
    proto::Kind& kind = *scenario_.mutable_agents()->add_kind();
    kind.set_name("homing");
    kind.set_count(3);
    kind.set_speed_limit_mps(0.2 * size_m_.maxCoeff());
    kind.set_u_max_mps(0.15 * size_m_.maxCoeff());
    for (const auto& [x, y] : {std::pair(0.2, 0.1), {0.83, 0.32}, {0.85, 0.9}}) {
      proto::Start& station = *kind.add_station();
      station.set_x_m(at(0, x));
      station.set_y_m(at(1, y));
    }
    kind.set_reserve_s(1);
  }

  Kind kind_;
  std::mt19937 random_;
  Eigen::Vector3d size_m_, origin_m_, away_m_;
  proto::Scenario scenario_;
};

// ---- the same in other coordinates ----

/// Changes every place of a scenario.
class Move {
 public:
  explicit Move(const Eigen::Vector3d& by_m) : by_m_(by_m) {}

  proto::Scenario operator()(proto::Scenario scenario) const {
    proto::Domain& domain = *scenario.mutable_domain();
    domain.set_origin_x_m(domain.origin_x_m() + by_m_.x());
    domain.set_origin_y_m(domain.origin_y_m() + by_m_.y());
    if (domain.has_origin_z_m()) domain.set_origin_z_m(domain.origin_z_m() + by_m_.z());
    for (proto::Gaussian& g : *scenario.mutable_target()->mutable_gaussians()) {
      g.set_mean_x_m(g.mean_x_m() + by_m_.x());
      g.set_mean_y_m(g.mean_y_m() + by_m_.y());
      if (g.has_mean_z_m()) g.set_mean_z_m(g.mean_z_m() + by_m_.z());
    }
    for (proto::Map& map : *scenario.mutable_target()->mutable_maps()) {
      map.set_origin_x_m(map.origin_x_m() + by_m_.x());
      map.set_origin_y_m(map.origin_y_m() + by_m_.y());
    }
    for (proto::Region& region : *scenario.mutable_target()->mutable_regions())
      polygon(*region.mutable_polygon());
    for (proto::Polygon& one : *scenario.mutable_target()->mutable_keep_outs()) polygon(one);
    for (proto::Polygon& one : *scenario.mutable_world()->mutable_walls()) polygon(one);
    for (proto::Start& start : *scenario.mutable_agents()->mutable_starts()) place(start);
    for (proto::Kind& kind : *scenario.mutable_agents()->mutable_kind()) {
      for (proto::Start& station : *kind.mutable_station()) place(station);
    }
    return scenario;
  }

 private:
  void polygon(proto::Polygon& polygon) const {
    for (proto::Vertex& vertex : *polygon.mutable_vertices()) {
      vertex.set_x_m(vertex.x_m() + by_m_.x());
      vertex.set_y_m(vertex.y_m() + by_m_.y());
    }
    if (polygon.has_low_z_m()) polygon.set_low_z_m(polygon.low_z_m() + by_m_.z());
    if (polygon.has_high_z_m()) polygon.set_high_z_m(polygon.high_z_m() + by_m_.z());
  }
  void place(proto::Start& start) const {
    start.set_x_m(start.x_m() + by_m_.x());
    start.set_y_m(start.y_m() + by_m_.y());
    if (start.has_z_m()) start.set_z_m(start.z_m() + by_m_.z());
  }

  Eigen::Vector3d by_m_;
};

/// Exchanges x and y in every message, by the fields' names.
void exchange(google::protobuf::Message& message) {
  const auto* reflection = message.GetReflection();
  const auto* type = message.GetDescriptor();
  std::vector<const google::protobuf::FieldDescriptor*> fields;
  reflection->ListFields(message, &fields);
  for (const auto* field : fields) {
    if (field->cpp_type() != field->CPPTYPE_MESSAGE) continue;
    for (int i = 0; field->is_repeated() && i < reflection->FieldSize(message, field); ++i)
      exchange(*reflection->MutableRepeatedMessage(&message, field, i));
    if (!field->is_repeated()) exchange(*reflection->MutableMessage(&message, field));
  }
  for (const auto& [x, y] : {std::pair("origin_x_m", "origin_y_m"),
                             {"size_x_m", "size_y_m"},
                             {"mean_x_m", "mean_y_m"},
                             {"x_m", "y_m"},
                             {"xx_m2", "yy_m2"},
                             {"xz_m2", "yz_m2"}}) {
    const auto *one = type->FindFieldByName(x), *other = type->FindFieldByName(y);
    if (one == nullptr || !reflection->HasField(message, one)) continue;
    const double value = reflection->GetDouble(message, one);
    reflection->SetDouble(&message, one, reflection->GetDouble(message, other));
    reflection->SetDouble(&message, other, value);
  }
}

proto::Scenario exchanged(proto::Scenario scenario) {
  exchange(scenario);
  const int modes_x = scenario.basis().modes_x();
  scenario.mutable_basis()->set_modes_x(scenario.basis().modes_y());
  scenario.mutable_basis()->set_modes_y(modes_x);
  for (proto::Map& map : *scenario.mutable_target()->mutable_maps()) map.set_file("turned.csv");
  return scenario;
}

// ---- what comes of them ----

class MovedScenario : public ::testing::TestWithParam<std::tuple<Kind, int>> {
 protected:
  MovedScenario() : draw_(kind(), static_cast<unsigned>(std::get<1>(GetParam()))) {
    std::ofstream map(folder_.path() / "map.csv"), turned(folder_.path() / "turned.csv");
    const auto value = [](int column, int row) { return (3 + 7 * column + 13 * row) % 11; };
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 5; ++column)
        map << value(column, row) << (column < 4 ? "," : "\n");
    for (int column = 0; column < 5; ++column)
      for (int row = 0; row < 4; ++row) turned << value(column, row) << (row < 3 ? "," : "\n");
  }

  static Kind kind() { return std::get<0>(GetParam()); }

  Mission mission_of(const proto::Scenario& scenario) const {
    std::string text;
    google::protobuf::TextFormat::PrintToString(scenario, &text);
    const auto parsed = Scenario::parse(text, (folder_.path() / "moved.textproto").string());
    if (!parsed) throw std::runtime_error(to_string(parsed.error().front()) + "\n" + text);
    return parsed->mission();
  }

  /// By tick and agent.
  using Tracks = std::map<std::pair<int, int>, Eigen::Vector3d>;
  static Tracks tracks_of(const Mission& mission) {
    SimulatedTeam team(mission);
    EXPECT_TRUE(team.run());
    std::istringstream rows(team.trajectory.str());
    Tracks tracks;
    std::string line;
    std::getline(rows, line);
    while (std::getline(rows, line)) {
      std::vector<double> cells;
      std::istringstream text(line);
      for (std::string cell; std::getline(text, cell, ',');) cells.push_back(std::stod(cell));
      const double z_m = mission.domain.planar() ? 0 : cells[5];
      tracks[{static_cast<int>(cells[0]), static_cast<int>(cells[2])}] = {cells[3], cells[4], z_m};
    }
    EXPECT_EQ(tracks.size(), 300u);
    return tracks;
  }

  /// The greatest difference of places, as a share of the domain.
  double off(const Tracks& tracks, const Tracks& others, const auto& back) const {
    double most_m = 0;
    for (const auto& [at, x_m] : others)
      most_m = std::max(most_m, (back(x_m) - tracks.at(at)).cwiseAbs().maxCoeff());
    return most_m / draw_.side_m();
  }

  TempFolder folder_;
  Maker draw_;
};

/// What an agent keeps from a wall in addition, for rounding, grows with the coordinates: by 1e-9
/// of how far the domain was moved.
double tolerance_of(Kind kind) { return kind == Kind::kPlane || kind == Kind::kBox ? 1e-9 : 1e-8; }

TEST_P(MovedScenario, HasTheSameTargetAndTheSamePaths) {
  const proto::Scenario scenario = draw_.scenario();
  const Mission here = mission_of(scenario), there = mission_of(Move(draw_.away_m())(scenario));
  EXPECT_LE((here.target_coefficients - there.target_coefficients).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LE(off(tracks_of(here), tracks_of(there),
                [&](const Eigen::Vector3d& x_m) {
                  Eigen::Vector3d back_m = x_m - draw_.away_m();
                  if (here.domain.planar()) back_m.z() = 0;
                  return back_m;
                }),
            tolerance_of(kind()));
}

TEST_P(MovedScenario, IsTheSameWithXAndYExchanged) {
  const proto::Scenario scenario = draw_.scenario();
  const Mission here = mission_of(scenario), there = mission_of(exchanged(scenario));
  const Basis& basis = here.basis;
  // A free domain's modes are as exact as their solver, and less so the closer two frequencies are;
  // their signs depend on the order of its cells.
  const bool is_free = kind() == Kind::kFreeDomain;
  for (int l = 0; l < basis.modes_z; ++l) {
    for (int m = 0; m < basis.modes_x; ++m) {
      for (int n = 0; n < basis.modes_y; ++n) {
        const int one = (l * basis.modes_x + m) * basis.modes_y + n;
        const int other = is_free ? one : (l * basis.modes_y + n) * basis.modes_x + m;
        const double mine = here.target_coefficients[one], its = there.target_coefficients[other];
        ASSERT_NEAR(is_free ? std::abs(mine) : mine, is_free ? std::abs(its) : its,
                    is_free ? 1e-3 : 1e-12)
            << l << m << n;
      }
    }
  }
  // Beside a wall an agent may take a random side, and its mirror image takes the other one.
  if (scenario.world().walls_size() > 0) return;
  EXPECT_LE(
      off(tracks_of(here), tracks_of(there),
          [](const Eigen::Vector3d& x_m) { return Eigen::Vector3d(x_m.y(), x_m.x(), x_m.z()); }),
      tolerance_of(kind()));
}

INSTANTIATE_TEST_SUITE_P(Plane, MovedScenario,
                         ::testing::Combine(::testing::Values(Kind::kPlane),
                                            ::testing::Range(1, 13)));
INSTANTIATE_TEST_SUITE_P(Box, MovedScenario,
                         ::testing::Combine(::testing::Values(Kind::kBox), ::testing::Range(1, 4)));
INSTANTIATE_TEST_SUITE_P(Walls, MovedScenario,
                         ::testing::Combine(::testing::Values(Kind::kWalls),
                                            ::testing::Range(1, 7)));
INSTANTIATE_TEST_SUITE_P(FreeDomain, MovedScenario,
                         ::testing::Combine(::testing::Values(Kind::kFreeDomain),
                                            ::testing::Range(1, 3)));
INSTANTIATE_TEST_SUITE_P(Stations, MovedScenario,
                         ::testing::Combine(::testing::Values(Kind::kStations),
                                            ::testing::Range(1, 7)));

}  // namespace
}  // namespace ergocast::test
