// SPDX-License-Identifier: BSD-3-Clause
package ergocast.spy;

import java.io.ByteArrayOutputStream;
import java.io.DataInput;
import java.io.EOFException;
import java.io.IOException;
import java.lang.reflect.Proxy;
import java.util.ArrayDeque;
import java.util.Arrays;
import java.util.Deque;
import java.util.Locale;
import java.util.Map;
import java.util.TreeMap;
import java.util.function.LongSupplier;
import lcm.lcm.LCMDataInputStream;

/**
 * The messages of one run, as far as they are shown. Call its methods with its lock held.
 * The hash of the messages is not checked here, because only a picture depends on it.
 */
final class Team {
  private static final int MAX_AGENTS = 1024;
  private static final int MAX_PARTS = 512;
  private static final int MAX_COUNT = 100000;
  private static final int MAX_PART_BYTES = 1024;
  private static final int TRAIL = 200; // places
  private static final long SILENCE_NS = 3_000_000_000L;

  /** Where one agent is and was [m]. */
  static final class Agent {
    final Deque<double[]> trail = new ArrayDeque<>(); // the newest last
    long tick = -1; // of the newest
  }

  final Map<Integer, Agent> agents = new TreeMap<>();
  Plan plan; // null until it has been received
  boolean replay; // sent by `ergocast replay`

  private final LongSupplier clock; // [ns]
  private long run;
  private long heardNs;
  private long tick; // newest received
  private long uncounted; // ticks so far in which the mission was paused
  private ergocast.team_status_t status; // the coordinator's newest; null: none yet
  private long statusNs;
  private byte[][] parts = new byte[0][];

  Team() {
    this(System::nanoTime);
  }

  /** With a clock of its own, by which a run becomes silent. */
  Team(LongSupplier clock) {
    this.clock = clock;
  }

  /** The mission and its time, which stands while the mission is paused. */
  String headline() {
    if (plan == null) return "No mission received yet: it is sent once a second";
    return String.format(Locale.ROOT, "%s%s, %.1f of %.0f s", replay ? "replay of " : "",
        plan.name, (tick - uncounted) * plan.dt, plan.lastTick * plan.dt);
  }

  /** What the coordinator reports: the number of agents and the newest metric. */
  String report() {
    if (status == null) return "no report of the coordinator yet";
    String[] states = {"waiting", "running", "ended", "failed"};
    int state = status.mission_state;
    double metric = status.median_ergodic_metric; // 0 before the first
    long silentS = (clock.getAsLong() - statusNs) / 1_000_000_000L;
    return (status.team_paused ? "paused" : state >= 0 && state < 4 ? states[state] : "?") + ", "
        + status.agents_alive + " of " + status.agents_expected + " agents alive"
        + (status.silent_agent >= 0 ? ", agent " + status.silent_agent + " is silent" : "")
        + (metric > 0 ? String.format(Locale.ROOT, ", φ² = %.3g", metric) : "")
        + (silentS >= 3 ? "; no report of the coordinator for " + silentS + " s" : "");
  }

  /** Takes in a message; invalid bytes and messages of another active run have no effect. */
  void receive(LCMDataInputStream bytes) {
    try {
      long fingerprint = bytes.readLong();
      bytes.reset();
      DataInput in = bounded(bytes);
      if (fingerprint == ergocast.mission_t.LCM_FINGERPRINT) on(new ergocast.mission_t(in));
      if (fingerprint == ergocast.world_state_t.LCM_FINGERPRINT) on(new ergocast.world_state_t(in));
      if (fingerprint == ergocast.team_status_t.LCM_FINGERPRINT) on(new ergocast.team_status_t(in));
    } catch (IOException | RuntimeException notOurs) {
      // Any error of invalid bytes ends here: LCM's thread must continue.
    }
  }

  /** Refuses large counts: generated decoders allocate as many elements as a message claims. */
  private static DataInput bounded(DataInput in) {
    Class<?>[] type = {DataInput.class};
    return (DataInput) Proxy.newProxyInstance(
        Team.class.getClassLoader(), type, (self, read, to) -> {
          Object value = read.invoke(in, to);
          if (read.getName().equals("readInt") && (int) value > MAX_COUNT) throw new EOFException();
          return value;
        });
  }

  private void on(ergocast.mission_t message) throws IOException {
    if (!isOfThisRun(message.header) && !begins(message.header)) return;
    int count = message.parts;
    if (plan != null || count < 1 || count > MAX_PARTS || message.part < 0 || message.part >= count
        || message.plan.length > MAX_PART_BYTES) {
      return;
    }
    // All revisions of a run have one plan; a large one does not come as a whole.
    if (parts.length != count) parts = Arrays.copyOf(parts, count);
    parts[message.part] = message.plan;
    if (Arrays.asList(parts).contains(null)) return;
    ByteArrayOutputStream whole = new ByteArrayOutputStream();
    for (byte[] part : parts) whole.write(part);
    plan = new Plan(whole.toByteArray());
  }

  private void on(ergocast.world_state_t message) {
    long at = message.header.tick;
    long held = message.uncounted_ticks;
    if (!isOfThisRun(message.header) || plan == null || at < 0 || held < 0 || held > at
        || at - held > plan.lastTick) {
      return;
    }
    for (ergocast.vehicle_t vehicle : message.vehicles) {
      int id = vehicle.vehicle_id;
      if (id < 0 || id >= MAX_AGENTS || !isInside(vehicle.position_m)) continue;
      Agent agent = agents.computeIfAbsent(id, added -> new Agent());
      if (at <= agent.tick) continue;
      if (agent.trail.size() == TRAIL) agent.trail.removeFirst();
      agent.trail.add(vehicle.position_m);
      agent.tick = at;
    }
    if (at < tick) return;
    tick = at;
    uncounted = held;
  }

  private void on(ergocast.team_status_t message) {
    if (!isOfThisRun(message.header)) return;
    status = message;
    statusNs = clock.getAsLong();
  }

  private boolean isOfThisRun(ergocast.header_t header) {
    if (run == 0 || header.run_id != run || isSilent()) return false;
    heardNs = clock.getAsLong();
    return true;
  }

  private boolean isSilent() {
    return clock.getAsLong() - heardNs > SILENCE_NS;
  }

  /** A new run, or a second replay, replaces a run that has become silent. */
  private boolean begins(ergocast.header_t header) {
    if (run != 0 && !isSilent()) return false;
    run = header.run_id;
    heardNs = clock.getAsLong();
    agents.clear();
    plan = null;
    status = null;
    tick = 0;
    uncounted = 0;
    parts = new byte[0][];
    return run != 0;
  }

  /** Seen from above, with room for rounding. */
  private boolean isInside(double[] place) {
    return Math.abs((place[0] - plan.origin[0]) / plan.size[0] - 0.5) <= 0.51
        && Math.abs((place[1] - plan.origin[1]) / plan.size[1] - 0.5) <= 0.51;
  }
}
