// SPDX-License-Identifier: BSD-3-Clause
package ergocast.spy;

import java.awt.image.BufferedImage;
import java.io.DataInput;
import java.nio.file.Files;
import java.nio.file.Paths;
import java.util.ArrayList;
import java.util.Arrays;
import java.util.HashSet;
import java.util.List;
import java.util.Locale;
import java.util.Random;
import java.util.Set;
import lcm.lcm.LCM;
import lcm.lcm.LCMDataInputStream;
import lcm.lcm.LCMDataOutputStream;
import lcm.lcm.LCMEncodable;
import lcm.spy.LCMTypeDatabase;

/** The Java checks of the tests: each prints its result, or ends with an exception. */
public final class SpyProbe {
  private static final long RUN = 4711;
  private static final int SIDE = 400; // of the drawn map [pixels]

  private SpyProbe() {}

  public static void main(String[] arguments) throws Exception {
    String[] rest = Arrays.copyOfRange(arguments, 1, arguments.length);
    switch (arguments[0]) {
      case "types":
        types(rest);
        return;
      case "listen":
        listen(rest);
        return;
      case "echo":
        echo(rest[0], rest[1]);
        return;
      case "plan":
        plan(rest[0]);
        return;
      case "map":
        map(rest[0]);
        return;
      case "words":
        words(rest[0]);
        return;
      case "hostile":
        hostile(rest[0]);
        return;
      default:
        throw new IllegalArgumentException(arguments[0]);
    }
  }

  /** The class that lcm-spy's own table of types has for each fingerprint. */
  private static void types(String[] fingerprints) {
    LCMTypeDatabase database = new LCMTypeDatabase();
    for (String fingerprint : fingerprints) {
      Class<?> found = database.getClassByFingerprint(Long.parseLong(fingerprint));
      System.out.println(fingerprint + " " + (found == null ? "unknown" : found.getName()));
    }
  }

  /** Decodes all messages as lcm-spy does; one line for each channel, and for each failure. */
  private static void listen(String[] urls) throws Exception {
    LCMTypeDatabase database = new LCMTypeDatabase();
    Set<String> known = new HashSet<>();
    for (String url : urls) {
      new LCM(url).subscribe("ERGOCAST_.*", (lcm, channel, in) -> {
        String printed = judge(database, channel, in);
        synchronized (known) {
          if (known.add(printed)) System.out.println(printed);
        }
      });
    }
    System.out.println("listening");
    Thread.sleep(Long.MAX_VALUE);
  }

  /** Repeats all messages of one URL on another one. */
  private static void echo(String from, String to) throws Exception {
    LCM there = new LCM(to);
    new LCM(from).subscribe("ERGOCAST_.*", (lcm, channel, in) -> {
      try {
        byte[] bytes = new byte[in.available()];
        in.readFully(bytes);
        there.publish(channel, bytes, 0, bytes.length);
      } catch (java.io.IOException wrong) {
        throw new java.io.UncheckedIOException(wrong);
      }
    });
    System.out.println("listening");
    Thread.sleep(Long.MAX_VALUE);
  }

  private static String judge(LCMTypeDatabase database, String channel, LCMDataInputStream in) {
    try {
      long fingerprint = in.readLong();
      in.reset();
      Class<?> type = database.getClassByFingerprint(fingerprint);
      if (type == null) return "undecodable " + channel + ": unknown type";
      type.getConstructor(DataInput.class).newInstance(in);
      if (in.available() != 0) return "undecodable " + channel + ": bytes are left over";
      return "decoded " + channel + " " + type.getSimpleName();
    } catch (Exception wrong) {
      return "undecodable " + channel + ": " + wrong;
    }
  }

  private static void plan(String file) throws Exception {
    Plan plan = new Plan(Files.readAllBytes(Paths.get(file)));
    System.out.println(plan.name);
    double[] numbers = {plan.origin[0], plan.origin[1], plan.size[0], plan.size[1], plan.dt};
    for (double value : numbers) System.out.println(Double.toHexString(value));
    System.out.println(plan.lastTick + " " + plan.walls.size());
    for (double[] ring : plan.walls) {
      for (double value : ring) System.out.println(Double.toHexString(value));
    }
  }

  /** Where agent 1's colour is in the map, (0, 0) below and left, and how much of it is wall. */
  private static void map(String planFile) throws Exception {
    Team team = teamWith(Files.readAllBytes(Paths.get(planFile)));
    int walls = colored(draw(team), java.awt.Color.GRAY.getRGB()).length;
    team.receive(stream(bytesOf(world(team.plan, 0.75, 0.125))));
    double[][] agent = colored(draw(team), TeamView.color(1).getRGB());
    System.out.printf(Locale.ROOT, "agent %.4f %.4f walls %d%n",
        Arrays.stream(agent).mapToDouble(at -> at[0]).average().orElse(-1),
        Arrays.stream(agent).mapToDouble(at -> at[1]).average().orElse(-1), walls);
  }

  /** The places of a colour's pixels, as shares of the map's sides. */
  private static double[][] colored(BufferedImage image, int color) {
    List<double[]> found = new ArrayList<>();
    for (int i = 1; i < SIDE; ++i) {
      for (int j = 1; j < SIDE; ++j) {
        if (image.getRGB(TeamView.LEFT + i, TeamView.TOP + j) != color) continue;
        found.add(new double[] {(i + 0.5) / SIDE, 1 - (j + 0.5) / SIDE});
      }
    }
    return found.toArray(new double[0][]);
  }

  /** What the view says: at first, once there is a plan, with reports, and after silence. */
  private static void words(String planFile) throws Exception {
    long[] now = {0};
    Team team = new Team(() -> now[0]);
    System.out.println(team.headline());
    receivePlan(team, Files.readAllBytes(Paths.get(planFile)));
    System.out.println(team.headline() + "; " + team.report());
    for (double metric : new double[] {0, 0.00012345}) {
      team.receive(stream(bytesOf(world(team.plan, 0.5, 0.5))));
      team.receive(stream(bytesOf(status(metric))));
      System.out.println(team.headline() + "; " + team.report());
    }
    for (int second = 1; second <= 4; ++second) {
      now[0] += 1_000_000_000L;
      team.receive(stream(bytesOf(world(team.plan, 0.5, 0.5))));
    }
    System.out.println(team.report());
  }

  /** Draws a square domain at SIDE x SIDE pixels. */
  private static BufferedImage draw(Team team) {
    TeamView view = new TeamView(team);
    view.setSize(
        TeamView.LEFT + SIDE + TeamView.RIGHT, TeamView.TOP + SIDE + TeamView.BOTTOM);
    BufferedImage image =
        new BufferedImage(view.getWidth(), view.getHeight(), BufferedImage.TYPE_INT_RGB);
    view.paint(image.createGraphics());
    return image;
  }

  /** Tens of thousands of changed messages: nothing may be thrown, and the view still drawn. */
  private static void hostile(String planFile) throws Exception {
    byte[] plan = Files.readAllBytes(Paths.get(planFile));
    Team team = teamWith(plan);
    Random random = new Random(1);
    byte[][] honest = {bytesOf(mission(plan)), bytesOf(world(team.plan, 0.5, 0.5)),
        bytesOf(status(0.1))};
    for (byte[] message : honest) team.receive(stream(message));
    for (int i = 0; i < 60000; ++i) {
      byte[] message = honest[i % honest.length].clone();
      for (int changes = random.nextInt(4); changes >= 0; --changes) {
        int at = random.nextInt(message.length - 16) + 16; // type and run stay
        message[at] = (byte) (random.nextBoolean() ? random.nextInt() : 0xff * random.nextInt(2));
      }
      int length = random.nextInt(4) == 0 ? random.nextInt(message.length) : message.length;
      team.receive(stream(Arrays.copyOf(message, length)));
      if (i % 1000 == 0) draw(team);
    }
    for (int i = 0; i < 4000; ++i) { // plans that come in one part
      byte[] changed = plan.clone();
      changed[random.nextInt(changed.length)] = (byte) random.nextInt();
      Team other = new Team(() -> 0);
      other.receive(stream(bytesOf(mission(Arrays.copyOf(changed, 1024)))));
      other.receive(
          stream(bytesOf(mission(Arrays.copyOf(changed, Math.min(1024, changed.length))))));
      if (other.plan != null && i % 20 == 0) draw(other);
    }
    System.out.println("unharmed, " + team.agents.size() + " agents");
  }

  // ---- honest messages ----

  private static Team teamWith(byte[] plan) throws Exception {
    Team team = new Team(() -> 0); // silence would end the run on a slow machine
    receivePlan(team, plan);
    return team;
  }

  private static void receivePlan(Team team, byte[] plan) throws Exception {
    int parts = (plan.length + 511) / 512;
    for (int part = 0; part < parts; ++part) {
      ergocast.mission_t message =
          mission(Arrays.copyOfRange(plan, 512 * part, Math.min(512 * (part + 1), plan.length)));
      message.part = part;
      message.parts = parts;
      team.receive(stream(bytesOf(message)));
    }
    if (team.plan == null) throw new IllegalStateException("the plan did not arrive");
  }

  private static ergocast.header_t header(int sender, long tick) {
    ergocast.header_t header = new ergocast.header_t();
    header.run_id = RUN;
    header.sender = sender;
    header.incarnation = 99;
    header.tick = tick;
    return header;
  }

  private static ergocast.mission_t mission(byte[] plan) {
    ergocast.mission_t message = new ergocast.mission_t();
    message.header = header(-2, 0);
    message.revision = 1;
    message.parts = 1;
    message.plan_size = plan.length;
    message.plan = plan;
    message.roster = new ergocast.roster_entry_t[0];
    message.reason = "";
    return message;
  }

  private static ergocast.world_state_t world(Plan plan, double shareX, double shareY) {
    ergocast.world_state_t message = new ergocast.world_state_t();
    message.header = header(-3, 5);
    message.state_parts = 1;
    message.vehicle_count = 1;
    ergocast.vehicle_t vehicle = new ergocast.vehicle_t();
    vehicle.vehicle_id = 1;
    double[] shares = {shareX, shareY};
    for (int axis = 0; axis < 2; ++axis) {
      vehicle.position_m[axis] = plan.origin[axis] + shares[axis] * plan.size[axis];
    }
    message.vehicles = new ergocast.vehicle_t[] {vehicle};
    return message;
  }

  private static ergocast.team_status_t status(double metric) {
    ergocast.team_status_t message = new ergocast.team_status_t();
    message.header = header(-2, 5);
    message.mission_state = 1;
    message.agents_alive = 3;
    message.agents_expected = 4;
    message.silent_agent = 2;
    message.median_ergodic_metric = metric;
    message.team_host = "host";
    return message;
  }

  private static byte[] bytesOf(LCMEncodable message) throws Exception {
    LCMDataOutputStream out = new LCMDataOutputStream();
    message.encode(out);
    return out.toByteArray();
  }

  private static LCMDataInputStream stream(byte[] bytes) {
    return new LCMDataInputStream(bytes);
  }
}
