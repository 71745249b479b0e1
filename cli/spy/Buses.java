// SPDX-License-Identifier: BSD-3-Clause
package ergocast.spy;

import java.io.IOException;
import java.util.HashMap;
import java.util.Map;
import java.util.regex.Matcher;
import java.util.regex.Pattern;
import lcm.lcm.LCM;
import lcm.spy.ChannelData;

/** Listens to teams while lcm-spy runs: one for each base URL that was requested. */
final class Buses {
  /** System property with the base URL; without it, the URL that LCM_DEFAULT_URL gives lcm-spy. */
  static final String BASE_URL = "ergocast.url";

  private static final Pattern URL = Pattern.compile("(udpm://[0-9.]+:)([0-9]{1,5})(.*)");
  private static final String CHANNELS = "(ERGOCAST|REPLAYED)_(MISSION|WORLD_STATE|TEAM_STATUS)";
  private static final Map<String, Team> TEAMS = new HashMap<>();

  private Buses() {}

  /** The team that a channel's messages belong to; null if LCM cannot be opened. */
  static Team teamOf(ChannelData channel) {
    String base = System.getProperty(BASE_URL);
    if (base != null) return team(base);
    String spied = System.getenv("LCM_DEFAULT_URL");
    if (spied == null || spied.isEmpty()) spied = "udpm://239.255.76.67:7667?ttl=0";
    boolean onWorldBus = channel.fingerprint == ergocast.world_state_t.LCM_FINGERPRINT;
    return team(above(spied, onWorldBus ? -1 : 0)); // one port above the base
  }

  /** Opens the swarm and the world bus, unless they are open. */
  static synchronized Team team(String base) {
    Team known = TEAMS.get(base);
    if (known != null) return known;
    Team team = new Team();
    try {
      for (int bus = 0; bus < 2; ++bus) {
        new LCM(above(base, bus)).subscribe(CHANNELS, (lcm, channel, in) -> {
          synchronized (team) {
            team.receive(in);
            team.replay = channel.startsWith("REPLAYED_");
          }
        });
      }
    } catch (IOException | RuntimeException refused) {
      System.err.println("ergocast: " + base + ": " + refused.getMessage());
      return null;
    }
    TEAMS.put(base, team);
    return team;
  }

  private static String above(String url, int ports) {
    Matcher parts = URL.matcher(url);
    if (!parts.matches()) return url;
    return parts.group(1) + (Integer.parseInt(parts.group(2)) + ports) + parts.group(3);
  }
}
