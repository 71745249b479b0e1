// SPDX-License-Identifier: BSD-3-Clause
package ergocast.spy;

import java.awt.image.BufferedImage;
import java.io.DataInput;
import java.nio.file.Files;
import java.nio.file.Paths;
import java.util.Arrays;
import java.util.HashSet;
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
      case "modes":
        modes(rest[0], Integer.parseInt(rest[1]));
        return;
      case "map":
        map(rest[0], rest[1]);
        return;
      case "ink":
        ink(rest[0], Double.parseDouble(rest[1]), Double.parseDouble(rest[2]));
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
    for (double value :
        new double[] {plan.origin[0], plan.origin[1], plan.origin[2], plan.size[0], plan.size[1],
            plan.size[2], plan.dt, plan.duration}) {
      System.out.println(Double.toHexString(value));
    }
    System.out.println(plan.modes[0] + " " + plan.modes[1] + " " + plan.modes[2]);
    for (double value : plan.target) System.out.println(Double.toHexString(value));
  }

  /** The modes of each block with that space. */
  private static void modes(String file, int room) throws Exception {
    Plan plan = new Plan(Files.readAllBytes(Paths.get(file)));
    for (int block = 0; plan.modesOf(block, room).length > 0; ++block) {
      StringBuilder line = new StringBuilder("block " + block);
      for (int mode : plan.modesOf(block, room)) line.append(' ').append(mode);
      System.out.println(line);
    }
  }

  /**
   * Where agent 1's colour and the darkest grey are in the map of two axes, "xy", with (0, 0) below
   * and left.
   */
  private static void map(String planFile, String axes) throws Exception {
    Team team = teamWith(Files.readAllBytes(Paths.get(planFile)));
    ergocast.world_state_t world = world(team.plan, 0.75, 0.125);
    team.receive(stream(bytesOf(world)));
    BufferedImage image = draw(new MapView(team, "xyz".indexOf(axes.charAt(0)),
        "xyz".indexOf(axes.charAt(1))));
    print("agent", image, Colors.agent(1).getRGB() & 0xffffff);
    print("target", image, Colors.pencil(1));
  }

  /** The mean place of a colour's pixels, as shares of the map's sides. */
  private static void print(String what, BufferedImage image, int color) {
    double x = 0, y = 0;
    int count = 0;
    for (int i = 72; i < 72 + 400; ++i) {
      for (int j = 58; j < 58 + 400; ++j) {
        if ((image.getRGB(i, j) & 0xffffff) != color) continue;
        x += (i + 0.5 - 72) / 400;
        y += 1 - (j + 0.5 - 58) / 400;
        ++count;
      }
    }
    System.out.printf(java.util.Locale.ROOT, "%s %.4f %.4f%n", what, x / count, y / count);
  }

  /** How many pixels of the map are drawn in ink near a place, by its shares of the map's sides. */
  private static void ink(String planFile, double shareX, double shareY) throws Exception {
    BufferedImage image = draw(new MapView(teamWith(Files.readAllBytes(Paths.get(planFile)))));
    int x = 72 + (int) (400 * shareX), y = 58 + (int) (400 * (1 - shareY)), count = 0;
    for (int i = x - 20; i <= x + 20; ++i) {
      for (int j = y - 20; j <= y + 20; ++j)
        count += (image.getRGB(i, j) & 0xffffff) == (Colors.INK.getRGB() & 0xffffff) ? 1 : 0;
    }
    System.out.println("ink " + count);
  }

  /** Draws the map at 400 x 400 pixels. */
  private static BufferedImage draw(Picture view) {
    view.setSize(72 + 400 + 84, 58 + 400 + 50);
    BufferedImage image =
        new BufferedImage(view.getWidth(), view.getHeight(), BufferedImage.TYPE_INT_RGB);
    view.paint(image.createGraphics());
    return image;
  }

  /**
   * Tens of thousands of changed messages: nothing may be thrown, and all pictures still
   * drawn.
   */
  private static void hostile(String planFile) throws Exception {
    byte[] plan = Files.readAllBytes(Paths.get(planFile));
    Team team = teamWith(plan);
    Random random = new Random(1);
    byte[][] honest = {bytesOf(mission(plan)), bytesOf(world(team.plan, 0.5, 0.5)),
        bytesOf(status()), bytesOf(contribution(team.plan))};
    for (byte[] message : honest) team.receive(stream(message));
    for (int i = 0; i < 60000; ++i) {
      byte[] message = honest[i % honest.length].clone();
      for (int changes = random.nextInt(4); changes >= 0; --changes) {
        int at = random.nextInt(message.length - 16) + 16; // type and run stay
        message[at] = (byte) (random.nextBoolean() ? random.nextInt() : 0xff * random.nextInt(2));
      }
      int length = random.nextInt(4) == 0 ? random.nextInt(message.length) : message.length;
      team.receive(stream(Arrays.copyOf(message, length)));
      if (i % 1000 == 0) {
        draw(new MapView(team));
        draw(new MetricView(team));
        draw(new CoefficientsView(team));
      }
    }
    for (int i = 0; i < 4000; ++i) { // plans that come in one part
      byte[] changed = plan.clone();
      changed[random.nextInt(changed.length)] = (byte) random.nextInt();
      Team other = new Team(() -> 0);
      other.receive(stream(bytesOf(mission(Arrays.copyOf(changed, 1024)))));
      other.receive(
          stream(bytesOf(mission(Arrays.copyOf(changed, Math.min(1024, changed.length))))));
      if (other.plan != null && i % 20 == 0) draw(new MapView(other));
    }
    System.out.println(
        "unharmed, " + team.agents.size() + " agents, " + team.coverage.agents().length + " heard");
  }

  // ---- honest messages ----

  private static Team teamWith(byte[] plan) throws Exception {
    Team team = new Team(() -> 0); // silence would end the run on a slow machine
    int parts = (plan.length + 511) / 512;
    for (int part = 0; part < parts; ++part) {
      ergocast.mission_t message =
          mission(Arrays.copyOfRange(plan, 512 * part, Math.min(512 * (part + 1), plan.length)));
      message.part = part;
      message.parts = parts;
      team.receive(stream(bytesOf(message)));
    }
    if (team.plan == null) throw new IllegalStateException("the plan did not arrive");
    return team;
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
    double[] shares = {shareX, shareY, 0.625};
    for (int axis = 0; axis < 3; ++axis) {
      vehicle.position_m[axis] = plan.origin[axis] + shares[axis] * plan.size[axis];
    }
    message.vehicles = new ergocast.vehicle_t[] {vehicle};
    return message;
  }

  private static ergocast.agent_status_t status() {
    ergocast.agent_status_t message = new ergocast.agent_status_t();
    message.header = header(1, 5);
    message.ergodic_metric = 0.1;
    message.status_host = "host";
    return message;
  }

  private static ergocast.contribution_t contribution(Plan plan) {
    ergocast.contribution_t message = new ergocast.contribution_t();
    message.header = header(1, 5);
    message.steps = 6;
    message.elapsed_s = 6 * plan.dt;
    message.mode_count = plan.target.length;
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
