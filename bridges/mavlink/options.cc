// SPDX-License-Identifier: BSD-3-Clause
// CLI11 reads the words; the functions here read what is in them.
#include "bridges/mavlink/options.h"

#include <fcntl.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdlib>
#include <sstream>

#include "bridges/mavlink/places.h"

namespace ergocast::mavlink {
namespace {

/// A file with a secret that only its owner may read.
std::string read_private(const std::string& option, const std::string& file) {
  constexpr std::size_t kLongest = 4096;
  const int fd = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) throw CLI::ValidationError(option, file + " cannot be opened");
  struct stat info {};
  std::array<char, kLongest> text;
  const bool ok = fstat(fd, &info) == 0 && S_ISREG(info.st_mode);
  const ssize_t size = ok ? read(fd, text.data(), text.size()) : -1;
  close(fd);
  if (size < 0) throw CLI::ValidationError(option, file + " is no file that can be read");
  // systemd lets the service's user read a credential by an access list, which shows as the
  // group's.
  const mode_t allowed = std::getenv("CREDENTIALS_DIRECTORY") != nullptr ? 0740 : 0700;
  if ((info.st_mode & 0777 & ~allowed) != 0)
    throw CLI::ValidationError(option, file + ": others may use this key; chmod 600 " + file);
  return {text.data(), static_cast<std::size_t>(size)};
}

template <std::size_t N>
bool from_hex(const std::string& text, std::array<std::byte, N>& bytes) {
  std::size_t size = 0;
  return text.size() == 2 * N &&
         sodium_hex2bin(reinterpret_cast<unsigned char*>(bytes.data()), N, text.data(), text.size(),
                        nullptr, &size, nullptr) == 0 &&
         size == N;
}

/// As `ergocast keygen` writes it.
MissionKey read_mission_key(const std::string& file) {
  std::istringstream in(read_private("--key-file", file));
  MissionKey key;
  std::string line, name, hex;
  bool shared = false, coordinator = false;
  std::getline(in, line);
  while (line == "ergocast key 1" && in >> name >> hex) {
    if (name == "shared") shared = from_hex(hex, key.shared);
    if (name == "coordinator") coordinator = from_hex(hex, key.coordinator);
  }
  if (!shared || !coordinator)
    throw CLI::ValidationError("--key-file",
                               file + " is no key that `ergocast keygen` has written");
  return key;
}

SigningKey read_signing_key(const std::string& file) {
  std::istringstream in(read_private("--signing-key", file));
  SigningKey key;
  std::string hex;
  if (!(in >> hex) || !from_hex(hex, key))
    throw CLI::ValidationError("--signing-key", file + " must have 64 hexadecimal digits");
  return key;
}

RunId run_in(const std::string& text) {
  char* end = nullptr;
  const RunId run = std::strtoull(text.c_str(), &end, 16);
  if (text.empty() || *end != '\0' || text.size() > 16 || run == 0)
    throw CLI::ValidationError("--run-id", "'" + text + "' is not 1 to 16 hex digits");
  return run;
}

template <class T>
T or_refuse(const std::string& option, Result<T> read) {
  if (!read) throw CLI::ValidationError(option, read.error());
  return *std::move(read);
}

void add_team_options(CLI::App& app, Options& options) {
  app.add_option("--id", options.id, "The agent whose vehicle it is")
      ->required()
      ->check(CLI::Range(0, kMaxAgents - 1).description(""))
      ->type_name("N");
  app.add_option_function<std::string>(
         "--lcm-url",
         [&](const std::string& text) {
           options.url = or_refuse("--lcm-url", BusUrl::parse(text));
         },
         "Base URL: swarm, world and command buses are this port and the next two")
      ->default_str("udpm://239.255.76.67:7667?ttl=0")
      ->envname("LCM_DEFAULT_URL")
      ->type_name("URL");
  app.add_option_function<std::string>(
         "--key-file",
         [&](const std::string& file) {
           options.authenticator = MessageAuthenticator(read_mission_key(file));
         },
         "Mission key of the team, as `ergocast keygen` writes it")
      ->envname("ERGOCAST_KEY_FILE")
      ->type_name("FILE");
  app.add_option_function<std::string>(
         "--run-id", [&](const std::string& text) { options.run = run_in(text); }, "This run only")
      ->type_name("HEX");
}

void add_vehicle_options(CLI::App& app, Options& options) {
  VehicleOptions& vehicle = options.vehicle;
  app.add_option("--connect", options.link,
                 "The autopilot: udp:HOST:PORT, udpin:PORT, tcp:HOST:PORT or serial:DEVICE:BAUD")
      ->required()
      ->type_name("LINK");
  app.add_option("--system", vehicle.system, "MAVLink's number of the vehicle; without: the first")
      ->check(CLI::Range(1, 255).description(""))
      ->type_name("N");
  app.add_option_function<std::string>(
         "--origin",
         [&](const std::string& text) { vehicle.origin = or_refuse("--origin", read_place(text)); },
         "The scenario's origin, LATITUDE,LONGITUDE; in a box also the altitude of z = 0 above sea "
         "level")
      ->type_name("PLACE");
  app.add_option_function<std::string>(
         "--local-origin",
         [&](const std::string& text) {
           vehicle.local_origin_m = or_refuse("--local-origin", read_point(text));
         },
         "Without GPS: the point X,Y,Z of the scenario at which LOCAL_POSITION_NED is 0 [m]")
      ->excludes("--origin")
      ->type_name("POINT");
  app.add_option("--altitude", vehicle.altitude_m,
                 "Height above home: of a mission in a plane, and after a take-off [m]")
      ->check(CLI::Range(1.0, 500.0).description(""))
      ->type_name("M");
  app.add_option(
         "--fence", vehicle.fence_margin_m,
         "Give the autopilot a fence, which replaces its own: so far outside the domain [m], "
         "and around the walls. The vehicle stands until the autopilot has it")
      ->check(CLI::Range(0.0, 1000.0).description(""))
      ->type_name("M");
  app.add_flag("--take-command", vehicle.take_command,
               "Arm, take off and choose the mode; without: the pilot does, and the driver waits");
  app.add_option_function<std::string>(
         "--signing-key",
         [&](const std::string& file) { options.signing_key = read_signing_key(file); },
         "Key of the link's signatures, 64 hexadecimal digits: unsigned messages are refused")
      ->type_name("FILE");
}

}  // namespace

int read_command_line(int argc, char** argv, Options& options) {
  CLI::App app("Drives one vehicle with a PX4 or ArduPilot autopilot, over MAVLink.",
               "ergocast-driver-mavlink");
  add_team_options(app, options);
  add_vehicle_options(app, options);
  app.get_option("--connect")->check([](const std::string& text) {
    for (const char* kind : {"udp:", "udpin:", "tcp:", "serial:"}) {
      if (text.starts_with(kind)) return std::string();
    }
    return "'" + text +
           "' is no link: udp:HOST:PORT, udpin:PORT, tcp:HOST:PORT or serial:DEVICE:BAUD";
  });
  app.set_version_flag("--version", "ergocast-driver-mavlink " ERGOCAST_VERSION);
  app.footer(
      "Exit codes: 0 done; 2 bad arguments; 3 LCM or the link cannot be used on this machine; 4 "
      "the mission\n"
      "failed, or the vehicle was refused.");
  try {
    app.parse(argc, argv);
    if (!options.vehicle.origin && !options.vehicle.local_origin_m)
      throw CLI::ValidationError(
          "--origin", "give the place of the scenario's (0, 0), or --local-origin without GPS");
    if (options.vehicle.fence_margin_m && !options.vehicle.origin)
      throw CLI::ValidationError("--fence", "is a place on the earth, so it needs --origin");
    const char* key_file = std::getenv("ERGOCAST_KEY_FILE");
    if (key_file != nullptr && *key_file == '\0' && app.get_option("--key-file")->count() == 0)
      throw CLI::ValidationError("ERGOCAST_KEY_FILE",
                                 "is set, and empty; name the key file in it, or unset it");
    if (options.vehicle.take_command && !options.vehicle.altitude_m)
      throw CLI::ValidationError("--take-command", "needs the height of the take-off: --altitude");
  } catch (const CLI::ParseError& problem) {
    return app.exit(problem) == 0 ? 0 : 2;
  }
  return -1;
}

}  // namespace ergocast::mavlink
