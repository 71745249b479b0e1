// SPDX-License-Identifier: BSD-3-Clause
package ergocast.spy;

import java.io.ByteArrayOutputStream;
import java.io.DataInput;
import java.io.EOFException;
import java.io.IOException;
import java.lang.reflect.Proxy;
import java.util.Arrays;
import java.util.Map;
import java.util.TreeMap;
import java.util.function.LongSupplier;
import lcm.lcm.LCMDataInputStream;

/**
 * The messages of one run, as far as they are drawn. Call its methods with its lock held.
 * The hash of the messages is not checked here, because only a picture depends on it.
 */
final class Team {
  private static final int MAX_AGENTS = 1024;
  private static final int MAX_PARTS = 512;
  private static final int MAX_COUNT = 100000;
  private static final int MAX_PART_BYTES = 1024;
  private static final long SILENCE_NS = 3_000_000_000L;

  /** One agent's track and the metric that it reports. */
  static final class Agent {
    final History track = new History();
    final double[] place = new double[3]; // newest [m]
    long tick = -1; // of the newest position
    double metric = Double.NaN;
    long metricTick = -1;
  }

  final Map<Integer, Agent> agents = new TreeMap<>();
  History metric = new History(); // median of the agents' values over time [s]
  Plan plan; // null until it has been received
  Coverage coverage;
  long tick; // newest received
  String status = ""; // the coordinator's report
  boolean replay; // sent by `ergocast replay`: no mission runs

  private final LongSupplier clock; // [ns]
  private long run;
  private long heardNs;
  private long uncounted; // ticks so far in which the mission was paused
  private byte[][] parts = new byte[0][];

  Team() {
    this(System::nanoTime);
  }

  /** Uses this clock to decide when a run is silent. */
  Team(LongSupplier clock) {
    this.clock = clock;
  }

  /** Takes in a message; invalid bytes and messages of another active run have no effect. */
  void receive(LCMDataInputStream bytes) {
    try {
      long fingerprint = bytes.readLong();
      bytes.reset();
      DataInput in = bounded(bytes);
      if (fingerprint == ergocast.mission_t.LCM_FINGERPRINT) on(new ergocast.mission_t(in));
      if (fingerprint == ergocast.world_state_t.LCM_FINGERPRINT) on(new ergocast.world_state_t(in));
      if (fingerprint == ergocast.agent_status_t.LCM_FINGERPRINT) {
        on(new ergocast.agent_status_t(in));
      }
      if (fingerprint == ergocast.team_status_t.LCM_FINGERPRINT) on(new ergocast.team_status_t(in));
      if (fingerprint == ergocast.contribution_t.LCM_FINGERPRINT) {
        ergocast.contribution_t heard = new ergocast.contribution_t(in);
        if (isOfAnAgent(heard.header)) coverage.add(heard);
      }
      if (fingerprint == ergocast.averages_t.LCM_FINGERPRINT) {
        ergocast.averages_t heard = new ergocast.averages_t(in);
        if (isOfAnAgent(heard.header)) coverage.add(heard);
      }
      if (fingerprint == ergocast.low_sums_t.LCM_FINGERPRINT) {
        ergocast.low_sums_t heard = new ergocast.low_sums_t(in);
        if (isOfAnAgent(heard.header)) coverage.add(heard);
      }
      if (fingerprint == ergocast.low_averages_t.LCM_FINGERPRINT) {
        ergocast.low_averages_t heard = new ergocast.low_averages_t(in);
        if (isOfAnAgent(heard.header)) coverage.add(heard);
      }
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
    // All revisions of a run have one plan; a large plan comes in parts.
    if (parts.length != count) parts = Arrays.copyOf(parts, count);
    parts[message.part] = message.plan;
    if (Arrays.asList(parts).contains(null)) return;
    ByteArrayOutputStream whole = new ByteArrayOutputStream();
    for (byte[] part : parts) whole.write(part);
    plan = new Plan(whole.toByteArray());
    coverage = new Coverage(plan);
  }

  private void on(ergocast.world_state_t message) {
    long held = message.uncounted_ticks;
    if (message.header.tick >= tick && held >= 0 && held <= message.header.tick
        && isOfThisRun(message.header)) {
      uncounted = held;
    }
    if (!isUnderWay(message.header)) return;
    for (ergocast.vehicle_t vehicle : message.vehicles) {
      Agent agent = agent(vehicle.vehicle_id);
      double[] place = vehicle.position_m;
      if (agent == null || !isInside(place) || message.header.tick < agent.tick) continue;
      System.arraycopy(place, 0, agent.place, 0, 3);
      agent.tick = message.header.tick;
      agent.track.add(agent.tick, place);
    }
    tick = Math.max(tick, message.header.tick);
  }

  private void on(ergocast.agent_status_t message) {
    Agent agent = isUnderWay(message.header) ? agent(message.header.sender) : null;
    if (agent == null || !(message.ergodic_metric > 1e-30 && message.ergodic_metric < 1e12)) return;
    agent.metric = message.ergodic_metric;
    agent.metricTick = message.header.tick;
    tick = Math.max(tick, message.header.tick);
    double[] all = agents.values()
                       .stream()
                       .filter(this::isCurrent)
                       .mapToDouble(a -> a.metric)
                       .sorted()
                       .toArray();
    if (all.length > 0) {
      double median = (all[all.length / 2] + all[(all.length - 1) / 2]) / 2;
      metric.add(message.header.tick, elapsed(), median);
    }
  }

  private void on(ergocast.team_status_t message) {
    if (!isOfThisRun(message.header)) return;
    String[] states = {"waiting", "running", "ended", "failed"};
    int state = message.mission_state;
    status = (state >= 0 && state < states.length ? states[state] : "?") + ", "
        + message.agents_alive + " of " + message.agents_expected + " agents alive"
        + (message.silent_agent >= 0 ? ", agent " + message.silent_agent + " is silent" : "");
  }

  private boolean isOfAnAgent(ergocast.header_t header) {
    return isUnderWay(header) && agent(header.sender) != null;
  }

  /** Whether the agent's value of phi^2 is from the last ten seconds. */
  private boolean isCurrent(Agent agent) {
    return agent.metricTick >= 0 && (tick - agent.metricTick) * plan.dt <= 10;
  }

  private boolean isOfThisRun(ergocast.header_t header) {
    if (run == 0 || header.run_id != run || isSilent()) return false;
    heardNs = clock.getAsLong();
    return true;
  }

  private boolean isUnderWay(ergocast.header_t header) {
    return isOfThisRun(header) && plan != null && header.tick >= 0
        && header.tick - uncounted <= plan.lastTick;
  }

  /** Mission time [s], which stands still while the mission is paused. */
  double elapsed() {
    return (tick - uncounted) * plan.dt;
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
    metric = new History();
    plan = null;
    coverage = null;
    status = "";
    tick = 0;
    uncounted = 0;
    parts = new byte[0][];
    return run != 0;
  }

  /** Whether a position is in the domain; a plane has no limits for z. */
  private boolean isInside(double[] place) {
    boolean inside = true;
    for (int axis = 0; axis < (plan.inBox() ? 3 : 2); ++axis) {
      double share = (place[axis] - plan.origin[axis]) / plan.size[axis];
      inside = inside && share >= -0.01 && share <= 1.01;
    }
    return inside;
  }

  private Agent agent(int id) {
    return id < 0 || id >= MAX_AGENTS ? null : agents.computeIfAbsent(id, added -> new Agent());
  }
}
