// SPDX-License-Identifier: BSD-3-Clause
// Writes the MJCF text of a walled room with robots.
#include "examples/mujoco/room.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "core/motion/walls.h"

namespace ergocast::mujoco {
namespace {

template <class... Values>
std::string text(const char* format, Values... values) {
  const int length = std::snprintf(nullptr, 0, format, values...);
  std::string out(static_cast<std::size_t>(length) + 1, '\0');
  std::snprintf(out.data(), out.size(), format, values...);
  out.pop_back();
  return out;
}

// Bodies touch each other and walls (1); wheels and casters touch only the floor (2). A contact has
// the greater friction of its two geoms, which is that of the wheels.
constexpr const char* kHead = R"(<mujoco model="ergocast">
<compiler angle="radian" inertiafromgeom="auto"/>
<option timestep="%.17g" cone="elliptic" gravity="0 0 -9.81"/>
<size njmax="%zu" nconmax="%zu"/>
<visual><global offwidth="1280" offheight="960"/><quality shadowsize="4096"/>
<headlight ambient="0.4 0.4 0.4" diffuse="0.15 0.15 0.15" specular="0 0 0"/></visual>
<asset><texture type="skybox" builtin="flat" rgb1="1 1 1" rgb2="1 1 1" width="64" height="64"/>
<texture name="tiles" type="2d" builtin="checker" rgb1=".93 .93 .91" rgb2=".87 .87 .85"
width="128" height="128"/><material name="floor" texture="tiles" texrepeat="%g %g"/></asset>
<worldbody><light pos="%g %g 12" dir=".15 .25 -1" directional="true" diffuse=".45 .45 .45"/>
)";

std::string head(const Box& domain, double step_s, std::size_t robots) {
  const Eigen::Vector3d mid_m = domain.origin_m + domain.size_m / 2;
  return text(kHead, step_s, 100 + 60 * robots, 50 + 20 * robots, domain.size_m.x() / 2,
              domain.size_m.y() / 2, mid_m.x(), mid_m.y());
}

constexpr double kWallThickness_m = 0.1, kWallHeight_m = 0.5;

std::string wall(int number, double x_m, double y_m, double half_x_m, double half_y_m,
                 double height_m) {
  return text(
      "<geom name=\"wall%d\" type=\"box\" pos=\"%.17g %.17g %g\" size=\"%.17g %.17g %g\" "
      "contype=\"1\" conaffinity=\"1\" rgba=\".55 .57 .6 1\"/>\n",
      number, x_m, y_m, height_m / 2, half_x_m, half_y_m, height_m / 2);
}

/// For each edge, a thin box just inside the solid side.
std::string planks(const Rings& rings, int number, double height_m) {
  constexpr double kHalf_m = 0.02;
  const IndexedRings walls(rings);
  std::string out;
  for_segments(walls, [&](const Segment& edge) {
    const Eigen::Vector2d way_m = edge.to_m - edge.from_m;
    const double length_m = way_m.norm();
    if (length_m == 0) return;
    Eigen::Vector2d inwards(-way_m.y() / length_m, way_m.x() / length_m);
    Eigen::Vector2d middle_m = (edge.from_m + edge.to_m) / 2;
    if (!solid_at(walls, middle_m + 1e-6 * inwards)) inwards = -inwards;
    middle_m += kHalf_m * inwards;
    out += text(
        "<geom name=\"wall%d\" type=\"box\" pos=\"%.17g %.17g %g\" size=\"%.17g %g %g\" "
        "euler=\"0 0 %.17g\" contype=\"1\" conaffinity=\"1\" rgba=\".55 .57 .6 1\"/>\n",
        number++, middle_m.x(), middle_m.y(), height_m / 2, length_m / 2, kHalf_m, height_m / 2,
        std::atan2(way_m.y(), way_m.x()));
  });
  return out;
}

std::string floor_and_walls(const RobotDesign& design, const Box& domain, const Rings& walls) {
  const Eigen::Vector3d mid_m = domain.origin_m + domain.size_m / 2;
  const double thick_m = kWallThickness_m / 2;
  const double half_x_m = domain.size_m.x() / 2 + design.radius_m + kWallThickness_m;
  const double half_y_m = domain.size_m.y() / 2 + design.radius_m + kWallThickness_m;
  const double height_m =
      design.kind == RobotKind::kQuadrotor ? 1.5 * kHoverHeight_m : kWallHeight_m;
  std::string out = text(
      "<geom type=\"plane\" pos=\"%.17g %.17g 0\" size=\"%g %g .1\" material=\"floor\" "
      "contype=\"2\" conaffinity=\"2\" condim=\"1\" friction=\"0\"/>\n",
      mid_m.x(), mid_m.y(), half_x_m, half_y_m);
  out += wall(0, mid_m.x() - half_x_m + thick_m, mid_m.y(), thick_m, half_y_m, height_m);
  out += wall(1, mid_m.x() + half_x_m - thick_m, mid_m.y(), thick_m, half_y_m, height_m);
  out += wall(2, mid_m.x(), mid_m.y() - half_y_m + thick_m, half_x_m, thick_m, height_m);
  out += wall(3, mid_m.x(), mid_m.y() + half_y_m - thick_m, half_x_m, thick_m, height_m);
  return out + planks(walls, 4, height_m);
}

/// Sixteen different colours, repeated.
std::string colour(AgentId id) {
  constexpr std::array kColours = {"0.12 0.47 0.71", "1 0.5 0.05",     "0.17 0.63 0.17",
                                   "0.84 0.15 0.16", "0.58 0.4 0.74",  "0.55 0.34 0.29",
                                   "0.89 0.47 0.76", "0.09 0.75 0.81", "0.74 0.74 0.13"};
  return kColours[static_cast<std::size_t>(id) % kColours.size()];
}

std::string wheel(const char* side, AgentId id, double y_m) {
  return text(
      "<body pos=\"0 %g 0\"><joint name=\"%s%d\" type=\"hinge\" axis=\"0 1 0\" damping=\"1e-3\"/>"
      "<geom type=\"ellipsoid\" size=\"%g .02 %g\" mass=\".1\" contype=\"2\" conaffinity=\"2\" "
      "condim=\"3\" friction=\"1 .005 .0001\" rgba=\".1 .1 .1 1\"/></body>\n",
      y_m, side, id, kWheelRadius_m, kWheelRadius_m);
}

std::string caster(double x_m) {
  return text(
      "<geom type=\"sphere\" pos=\"%g 0 -.029\" size=\".02\" mass=\".02\" contype=\"2\" "
      "conaffinity=\"2\" condim=\"1\" friction=\"0\" rgba=\".3 .3 .3 1\"/>",
      x_m);
}

std::string disc(const RobotDesign& design, const Placement& at) {
  const double track_m = kTrackShare * design.radius_m;
  std::string out = text(
      "<body name=\"robot%d\" pos=\"%.17g %.17g %g\"><freejoint name=\"joint%d\"/>\n"
      "<geom name=\"chassis%d\" type=\"cylinder\" pos=\"0 0 .02\" size=\"%g .04\" mass=\"2\" "
      "contype=\"1\" conaffinity=\"1\" condim=\"3\" friction=\".4\" rgba=\"%s 1\"/>\n"
      "<geom type=\"box\" pos=\"%g 0 .062\" size=\"%g .01 .003\" mass=\"0\" contype=\"0\" "
      "conaffinity=\"0\" rgba=\"1 1 1 1\"/>\n",
      at.id, at.position_m.x(), at.position_m.y(), kWheelRadius_m, at.id, at.id, design.radius_m,
      colour(at.id).c_str(), design.radius_m / 2, design.radius_m / 2);
  out += wheel("left", at.id, track_m) + wheel("right", at.id, -track_m);
  return out + caster(kTrackShare * design.radius_m) + caster(-kTrackShare * design.radius_m) +
         "</body>\n";
}

std::string disc_actuators(const RobotDesign& design, const Placement& at) {
  std::string out;
  for (const char* side : {"left", "right"})
    out += text(
        "<general name=\"%s%d\" joint=\"%s%d\" dyntype=\"filter\" dynprm=\"%g\" gaintype=\"fixed\" "
        "gainprm=\".2\" biastype=\"affine\" biasprm=\"0 0 -.2\" ctrllimited=\"true\" "
        "ctrlrange=\"-%g %g\" forcelimited=\"true\" forcerange=\"-%g %g\"/>\n",
        side, at.id, side, at.id, design.lag_s, kWheelSpeedLimit_radps, kWheelSpeedLimit_radps,
        kWheelTorqueLimit_nm, kWheelTorqueLimit_nm);
  return out;
}

std::string quadrotor(const RobotDesign& design, const Placement& at) {
  const double arm_m = kArmShare * design.radius_m;
  std::string out = text(
      "<body name=\"robot%d\" pos=\"%.17g %.17g %g\"><freejoint name=\"joint%d\"/>\n"
      "<inertial pos=\"0 0 0\" mass=\"%g\" diaginertia=\"%g %g %g\"/>\n"
      "<geom name=\"chassis%d\" type=\"cylinder\" size=\"%g .03\" contype=\"1\" conaffinity=\"1\" "
      "condim=\"3\" friction=\".4\" rgba=\"%s .35\"/>\n"
      "<geom type=\"box\" size=\".06 .03 .025\" contype=\"0\" conaffinity=\"0\" rgba=\"%s 1\"/>\n",
      at.id, at.position_m.x(), at.position_m.y(), kHoverHeight_m, at.id, kQuadrotorMass_kg,
      kInertiaX_kgm2, kInertiaX_kgm2, kInertiaZ_kgm2, at.id, design.radius_m, colour(at.id).c_str(),
      colour(at.id).c_str());
  for (int rotor = 0; rotor < 4; ++rotor) {
    const double x_m = (rotor % 2 == 0 ? 1 : -1) * arm_m, y_m = (rotor < 2 ? 1 : -1) * arm_m;
    out += text(
        "<site name=\"rotor%d_%d\" pos=\"%g %g .03\"/><geom type=\"cylinder\" pos=\"%g %g .03\" "
        "size=\"%g .004\" contype=\"0\" conaffinity=\"0\" rgba=\".15 .15 .15 .8\"/>\n",
        at.id, rotor, x_m, y_m, x_m, y_m, arm_m / 2);
  }
  return out + "</body>\n";
}

std::string quadrotor_actuators(const RobotDesign& design, const Placement& at) {
  std::string out;
  for (int rotor = 0; rotor < 4; ++rotor) {
    const double turns = rotor == 0 || rotor == 3 ? kRotorTorque_m : -kRotorTorque_m;
    out += text(
        "<general name=\"rotor%d_%d\" site=\"rotor%d_%d\" dyntype=\"filter\" dynprm=\"%g\" "
        "gear=\"0 0 1 0 0 %g\" ctrllimited=\"true\" ctrlrange=\"0 %g\"/>\n",
        at.id, rotor, at.id, rotor, design.lag_s, turns, kThrustLimit_n);
  }
  return out;
}

}  // namespace

std::string room_mjcf(const RobotDesign& design, const Box& domain, const Rings& walls,
                      double step_s, const std::vector<Placement>& robots) {
  const bool rolls = design.kind == RobotKind::kDisc;
  std::string bodies, actuators;
  for (const Placement& robot : robots) {
    bodies += rolls ? disc(design, robot) : quadrotor(design, robot);
    actuators += rolls ? disc_actuators(design, robot) : quadrotor_actuators(design, robot);
  }
  return head(domain, step_s, robots.size()) + floor_and_walls(design, domain, walls) + bodies +
         "</worldbody>\n<actuator>\n" + actuators + "</actuator>\n</mujoco>\n";
}

}  // namespace ergocast::mujoco
