// SPDX-License-Identifier: BSD-3-Clause
// The MAVLink messages that this driver sends and understands, from the tables of fields on
// mavlink.io/en/messages/common.html. Names and units are those of MAVLink.
//
// list(io, m) visits each field of `m` once, in the order in which it is sent: greater types first.
// Extensions come last; messages of version 1 do not have them. Name, type and order of the other
// fields make CRC_EXTRA, so a wrong table does not go unnoticed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace ergocast::mavlink {

/// Greatest payload of a message [bytes].
inline constexpr std::size_t kMaxPayload = 255;

using Text50 = std::array<char, 50>;
/// Voltages of a battery's cells [mV].
template <std::size_t N>
using Cells = std::array<std::uint16_t, N>;

struct Heartbeat {
  static constexpr std::uint32_t kId = 0;
  static constexpr const char* kName = "HEARTBEAT";
  std::uint32_t custom_mode = 0;
  std::uint8_t type = 0, autopilot = 0, base_mode = 0, system_status = 0, mavlink_version = 3;
  static void list(auto& io, auto& m) {
    io.field("custom_mode", m.custom_mode);
    io.field("type", m.type);
    io.field("autopilot", m.autopilot);
    io.field("base_mode", m.base_mode);
    io.field("system_status", m.system_status);
    io.field("mavlink_version", m.mavlink_version);
  }
};

struct SysStatus {
  static constexpr std::uint32_t kId = 1;
  static constexpr const char* kName = "SYS_STATUS";
  std::uint32_t onboard_control_sensors_present = 0, onboard_control_sensors_enabled = 0,
                onboard_control_sensors_health = 0;
  std::uint16_t load = 0, voltage_battery = 0;  ///< mV
  std::int16_t current_battery = -1;            ///< cA; −1: not known
  std::uint16_t drop_rate_comm = 0, errors_comm = 0, errors_count1 = 0, errors_count2 = 0,
                errors_count3 = 0, errors_count4 = 0;
  std::int8_t battery_remaining = -1;  ///< %; −1: not known
  static void list(auto& io, auto& m) {
    io.field("onboard_control_sensors_present", m.onboard_control_sensors_present);
    io.field("onboard_control_sensors_enabled", m.onboard_control_sensors_enabled);
    io.field("onboard_control_sensors_health", m.onboard_control_sensors_health);
    io.field("load", m.load);
    io.field("voltage_battery", m.voltage_battery);
    io.field("current_battery", m.current_battery);
    io.field("drop_rate_comm", m.drop_rate_comm);
    io.field("errors_comm", m.errors_comm);
    io.field("errors_count1", m.errors_count1);
    io.field("errors_count2", m.errors_count2);
    io.field("errors_count3", m.errors_count3);
    io.field("errors_count4", m.errors_count4);
    io.field("battery_remaining", m.battery_remaining);
  }
};

/// Where a vehicle is in its local frame: north, east and down of a place that it has chosen.
struct LocalPositionNed {
  static constexpr std::uint32_t kId = 32;
  static constexpr const char* kName = "LOCAL_POSITION_NED";
  std::uint32_t time_boot_ms = 0;
  float x = 0, y = 0, z = 0, vx = 0, vy = 0, vz = 0;
  static void list(auto& io, auto& m) {
    io.field("time_boot_ms", m.time_boot_ms);
    io.field("x", m.x);
    io.field("y", m.y);
    io.field("z", m.z);
    io.field("vx", m.vx);
    io.field("vy", m.vy);
    io.field("vz", m.vz);
  }
};

struct GlobalPositionInt {
  static constexpr std::uint32_t kId = 33;
  static constexpr const char* kName = "GLOBAL_POSITION_INT";
  std::uint32_t time_boot_ms = 0;
  std::int32_t lat = 0, lon = 0;        ///< 1e-7 degrees
  std::int32_t alt = 0;                 ///< mm above mean sea level
  std::int32_t relative_alt = 0;        ///< mm above the vehicle's home
  std::int16_t vx = 0, vy = 0, vz = 0;  ///< cm/s north, east, down
  std::uint16_t hdg = 65535;            ///< 0.01 degrees; 65535: not known
  static void list(auto& io, auto& m) {
    io.field("time_boot_ms", m.time_boot_ms);
    io.field("lat", m.lat);
    io.field("lon", m.lon);
    io.field("alt", m.alt);
    io.field("relative_alt", m.relative_alt);
    io.field("vx", m.vx);
    io.field("vy", m.vy);
    io.field("vz", m.vz);
    io.field("hdg", m.hdg);
  }
};

/// The place of a vehicle's local frame.
struct GpsGlobalOrigin {
  static constexpr std::uint32_t kId = 49;
  static constexpr const char* kName = "GPS_GLOBAL_ORIGIN";
  std::int32_t latitude = 0, longitude = 0;  ///< 1e-7 degrees
  std::int32_t altitude = 0;                 ///< mm above mean sea level
  std::uint64_t time_usec = 0;
  static void list(auto& io, auto& m) {
    io.field("latitude", m.latitude);
    io.field("longitude", m.longitude);
    io.field("altitude", m.altitude);
    io.extension("time_usec", m.time_usec);
  }
};

struct CommandLong {
  static constexpr std::uint32_t kId = 76;
  static constexpr const char* kName = "COMMAND_LONG";
  float param1 = 0, param2 = 0, param3 = 0, param4 = 0, param5 = 0, param6 = 0, param7 = 0;
  std::uint16_t command = 0;
  std::uint8_t target_system = 0, target_component = 0, confirmation = 0;
  static void list(auto& io, auto& m) {
    io.field("param1", m.param1);
    io.field("param2", m.param2);
    io.field("param3", m.param3);
    io.field("param4", m.param4);
    io.field("param5", m.param5);
    io.field("param6", m.param6);
    io.field("param7", m.param7);
    io.field("command", m.command);
    io.field("target_system", m.target_system);
    io.field("target_component", m.target_component);
    io.field("confirmation", m.confirmation);
  }
};

struct CommandAck {
  static constexpr std::uint32_t kId = 77;
  static constexpr const char* kName = "COMMAND_ACK";
  std::uint16_t command = 0;
  std::uint8_t result = 0, progress = 0;
  std::int32_t result_param2 = 0;
  std::uint8_t target_system = 0, target_component = 0;
  static void list(auto& io, auto& m) {
    io.field("command", m.command);
    io.field("result", m.result);
    io.extension("progress", m.progress);
    io.extension("result_param2", m.result_param2);
    io.extension("target_system", m.target_system);
    io.extension("target_component", m.target_component);
  }
};

struct SetPositionTargetLocalNed {
  static constexpr std::uint32_t kId = 84;
  static constexpr const char* kName = "SET_POSITION_TARGET_LOCAL_NED";
  std::uint32_t time_boot_ms = 0;
  float x = 0, y = 0, z = 0, vx = 0, vy = 0, vz = 0, afx = 0, afy = 0, afz = 0, yaw = 0,
        yaw_rate = 0;
  std::uint16_t type_mask = 0;
  std::uint8_t target_system = 0, target_component = 0, coordinate_frame = 0;
  static void list(auto& io, auto& m) {
    io.field("time_boot_ms", m.time_boot_ms);
    io.field("x", m.x);
    io.field("y", m.y);
    io.field("z", m.z);
    io.field("vx", m.vx);
    io.field("vy", m.vy);
    io.field("vz", m.vz);
    io.field("afx", m.afx);
    io.field("afy", m.afy);
    io.field("afz", m.afz);
    io.field("yaw", m.yaw);
    io.field("yaw_rate", m.yaw_rate);
    io.field("type_mask", m.type_mask);
    io.field("target_system", m.target_system);
    io.field("target_component", m.target_component);
    io.field("coordinate_frame", m.coordinate_frame);
  }
};

/// A question (tc1 = 0) and its answer: tc1 is the clock of the one that answers, ts1 that of the
/// question [ns].
struct Timesync {
  static constexpr std::uint32_t kId = 111;
  static constexpr const char* kName = "TIMESYNC";
  std::int64_t tc1 = 0, ts1 = 0;
  std::uint8_t target_system = 0, target_component = 0;
  static void list(auto& io, auto& m) {
    io.field("tc1", m.tc1);
    io.field("ts1", m.ts1);
    io.extension("target_system", m.target_system);
    io.extension("target_component", m.target_component);
  }
};

/// One battery, of which a vehicle may have several.
struct BatteryStatus {
  static constexpr std::uint32_t kId = 147;
  static constexpr const char* kName = "BATTERY_STATUS";
  std::int32_t current_consumed = -1;  ///< mAh; −1: not known
  std::int32_t energy_consumed = -1;   ///< hJ; −1: not known
  std::int16_t temperature = 32767;    ///< 0.01 °C; 32767: not known
  Cells<10> voltages = {65535, 65535, 65535, 65535, 65535,
                        65535, 65535, 65535, 65535, 65535};  ///< 65535: not known, or no cell
  std::int16_t current_battery = -1;                         ///< cA; −1: not known
  std::uint8_t id = 0, battery_function = 0, type = 0;
  std::int8_t battery_remaining = -1;  ///< %; −1: not known
  std::int32_t time_remaining = 0;     ///< s; 0: not known
  std::uint8_t charge_state = 0;
  Cells<4> voltages_ext{};  ///< cells 11 to 14; 0: no cell
  std::uint8_t mode = 0;
  std::uint32_t fault_bitmask = 0;
  static void list(auto& io, auto& m) {
    io.field("current_consumed", m.current_consumed);
    io.field("energy_consumed", m.energy_consumed);
    io.field("temperature", m.temperature);
    io.field("voltages", m.voltages);
    io.field("current_battery", m.current_battery);
    io.field("id", m.id);
    io.field("battery_function", m.battery_function);
    io.field("type", m.type);
    io.field("battery_remaining", m.battery_remaining);
    io.extension("time_remaining", m.time_remaining);
    io.extension("charge_state", m.charge_state);
    io.extension("voltages_ext", m.voltages_ext);
    io.extension("mode", m.mode);
    io.extension("fault_bitmask", m.fault_bitmask);
  }
};

struct ExtendedSysState {
  static constexpr std::uint32_t kId = 245;
  static constexpr const char* kName = "EXTENDED_SYS_STATE";
  std::uint8_t vtol_state = 0, landed_state = 0;
  static void list(auto& io, auto& m) {
    io.field("vtol_state", m.vtol_state);
    io.field("landed_state", m.landed_state);
  }
};

struct Statustext {
  static constexpr std::uint32_t kId = 253;
  static constexpr const char* kName = "STATUSTEXT";
  std::uint8_t severity = 0;
  Text50 text{};
  std::uint16_t id = 0;
  std::uint8_t chunk_seq = 0;
  static void list(auto& io, auto& m) {
    io.field("severity", m.severity);
    io.field("text", m.text);
    io.extension("id", m.id);
    io.extension("chunk_seq", m.chunk_seq);
  }
};

// ---- the mission protocol: lists of items, of which a fence is one ----

struct MissionRequest {
  static constexpr std::uint32_t kId = 40;
  static constexpr const char* kName = "MISSION_REQUEST";
  std::uint16_t seq = 0;
  std::uint8_t target_system = 0, target_component = 0, mission_type = 0;
  static void list(auto& io, auto& m) {
    io.field("seq", m.seq);
    io.field("target_system", m.target_system);
    io.field("target_component", m.target_component);
    io.extension("mission_type", m.mission_type);
  }
};

/// Asks how many items there are.
struct MissionRequestList {
  static constexpr std::uint32_t kId = 43;
  static constexpr const char* kName = "MISSION_REQUEST_LIST";
  std::uint8_t target_system = 0, target_component = 0, mission_type = 0;
  static void list(auto& io, auto& m) {
    io.field("target_system", m.target_system);
    io.field("target_component", m.target_component);
    io.extension("mission_type", m.mission_type);
  }
};

struct MissionCount {
  static constexpr std::uint32_t kId = 44;
  static constexpr const char* kName = "MISSION_COUNT";
  std::uint16_t count = 0;
  std::uint8_t target_system = 0, target_component = 0, mission_type = 0;
  std::uint32_t opaque_id = 0;
  static void list(auto& io, auto& m) {
    io.field("count", m.count);
    io.field("target_system", m.target_system);
    io.field("target_component", m.target_component);
    io.extension("mission_type", m.mission_type);
    io.extension("opaque_id", m.opaque_id);
  }
};

struct MissionAck {
  static constexpr std::uint32_t kId = 47;
  static constexpr const char* kName = "MISSION_ACK";
  std::uint8_t target_system = 0, target_component = 0, type = 0, mission_type = 0;
  std::uint32_t opaque_id = 0;
  static void list(auto& io, auto& m) {
    io.field("target_system", m.target_system);
    io.field("target_component", m.target_component);
    io.field("type", m.type);
    io.extension("mission_type", m.mission_type);
    io.extension("opaque_id", m.opaque_id);
  }
};

struct MissionRequestInt {
  static constexpr std::uint32_t kId = 51;
  static constexpr const char* kName = "MISSION_REQUEST_INT";
  std::uint16_t seq = 0;
  std::uint8_t target_system = 0, target_component = 0, mission_type = 0;
  static void list(auto& io, auto& m) {
    io.field("seq", m.seq);
    io.field("target_system", m.target_system);
    io.field("target_component", m.target_component);
    io.extension("mission_type", m.mission_type);
  }
};

struct MissionItemInt {
  static constexpr std::uint32_t kId = 73;
  static constexpr const char* kName = "MISSION_ITEM_INT";
  float param1 = 0, param2 = 0, param3 = 0, param4 = 0;
  std::int32_t x = 0, y = 0;  ///< latitude and longitude in 1e-7 degrees, in global frames
  float z = 0;
  std::uint16_t seq = 0, command = 0;
  std::uint8_t target_system = 0, target_component = 0, frame = 0, current = 0, autocontinue = 0,
               mission_type = 0;
  static void list(auto& io, auto& m) {
    io.field("param1", m.param1);
    io.field("param2", m.param2);
    io.field("param3", m.param3);
    io.field("param4", m.param4);
    io.field("x", m.x);
    io.field("y", m.y);
    io.field("z", m.z);
    io.field("seq", m.seq);
    io.field("command", m.command);
    io.field("target_system", m.target_system);
    io.field("target_component", m.target_component);
    io.field("frame", m.frame);
    io.field("current", m.current);
    io.field("autocontinue", m.autocontinue);
    io.extension("mission_type", m.mission_type);
  }
};

using Packet =
    std::variant<Heartbeat, SysStatus, LocalPositionNed, GlobalPositionInt, MissionRequest,
                 MissionRequestList, MissionCount, MissionAck, GpsGlobalOrigin, MissionRequestInt,
                 MissionItemInt, CommandLong, CommandAck, SetPositionTargetLocalNed, Timesync,
                 BatteryStatus, ExtendedSysState, Statustext>;

/// What a receiver must know of a type of message to check and read it.
struct Type {
  std::uint32_t id;
  const char* name;
  std::uint8_t crc_extra;
  std::size_t base_bytes;   ///< without extensions: the payload of version 1
  std::size_t whole_bytes;  ///< with them
};

/// All types above, by ascending id.
std::span<const Type> types();
/// Null if there is none.
const Type* type_of(std::uint32_t id);

/// The payload without any zeros at its end but the first byte, as version 2 sends it.
std::vector<std::byte> payload_of(const Packet& packet);
/// The message; nothing for an unknown id. Missing bytes are zeros, and surplus bytes are
/// extensions that we do not know.
std::optional<Packet> packet_of(std::uint32_t id, std::span<const std::byte> payload);

std::string text_of(const Text50& text);

}  // namespace ergocast::mavlink
