// SPDX-License-Identifier: BSD-3-Clause
package ergocast.spy;

import java.nio.ByteBuffer;
import java.nio.ByteOrder;
import java.nio.charset.StandardCharsets;
import java.util.ArrayList;
import java.util.Arrays;
import java.util.Comparator;
import java.util.HashMap;
import java.util.List;
import java.util.Map;
import java.util.function.BiConsumer;
import java.util.stream.IntStream;

/** The fields of a compiled plan, listed in team/plan.proto, that the pictures need. */
final class Plan {
  static final int MAX_MODES = 64; // along an axis
  static final int MAX_MODES_TOGETHER = 4096;
  static final long MAX_TICKS = 100000000;
  static final int MAX_PLACES = 1024; // corners of a ring, stations of a kind
  private static final int KINDS = 20, WALLS = 21;
  static final int LOW_MODES = 64; // in the first block, if the others are sent less often

  final String name;
  final double[] origin = new double[3], size = new double[3]; // [m]; a plane has no height
  final double dt, duration; // [s]
  final long lastTick;
  final int[] modes = {1, 1, 1}; // along x, y and z; 1 along z in a plane
  final boolean freeDomain; // its modes are no cosines
  final double[] target; // mu, (l * modes[0] + m) * modes[1] + n
  final double[] cosineTarget; // the same in cosines, which can be drawn
  final List<double[]> walls = new ArrayList<>(); // rings: x and y of each corner in turn [m]
  final List<double[]> stations = new ArrayList<>(); // x and y of each kind's in turn [m]
  private final boolean separated; // whether low modes have a block of their own; all are sent by ascending |k|
  private final int[] wire; // the modes in the order in which they are sent

  /**
   * Reads Protobuf's wire format, with the numbers of team/plan.proto. A missing number
   * is 0.
   *
   * @throws RuntimeException for bytes that are no plan
   */
  Plan(byte[] bytes) {
    Map<Integer, ByteBuffer> plan = fields(ByteBuffer.wrap(bytes));
    Map<Integer, ByteBuffer> domain = fields(plan.get(4));
    Map<Integer, ByteBuffer> basis = fields(plan.get(5));
    Map<Integer, ByteBuffer> timing = fields(plan.get(8));
    name = StandardCharsets.UTF_8.decode(plan.get(2)).toString();
    for (int axis = 0; axis < 2; ++axis) {
      origin[axis] = number(domain, 1 + axis, -1e13, 1e13);
      size[axis] = number(domain, 3 + axis, 1e-6, 1e9);
      modes[axis] = modes(basis, 1 + axis);
    }
    if (basis.containsKey(6)) {
      origin[2] = number(domain, 5, -1e13, 1e13);
      size[2] = number(domain, 6, 1e-6, 1e9);
      modes[2] = modes(basis, 6);
    }
    int count = modes[0] * modes[1] * modes[2];
    dt = number(timing, 1, 1e-9, 1e6);
    lastTick = varint(timing.get(2));
    require(lastTick >= 1 && lastTick <= MAX_TICKS);
    duration = lastTick * dt;
    require(name.length() <= 64 && count <= MAX_MODES_TOGETHER);
    freeDomain = basis.containsKey(7);
    target = coefficients(plan.get(6), count);
    cosineTarget = freeDomain ? coefficients(plan.get(24), count) : target;
    each(ByteBuffer.wrap(bytes), (field, value) -> {
      if (field == WALLS) walls.add(places(fields(value).get(1)));
      if (field == KINDS) {
        ByteBuffer ofKind = fields(value).get(12);
        if (ofKind != null) stations.add(places(ofKind));
      }
    });
    separated = timing.containsKey(12) && count > LOW_MODES;
    wire = inOrder();
  }

  /** The modes of a block with room for `room` numbers, in their order; empty without such a block. */
  int[] modesOf(int block, int room) {
    int first = separated && block > 0 ? LOW_MODES : 0;
    long begin = first + (block - (first > 0 ? 1L : 0L)) * room;
    if (block < 0 || begin >= wire.length) return new int[0];
    int most = separated && block == 0 ? LOW_MODES : room;
    return Arrays.copyOfRange(wire, (int) begin, (int) Math.min(wire.length, begin + most));
  }

  private int[] inOrder() {
    return IntStream.range(0, target.length)
        .boxed()
        .sorted(Comparator.comparingInt(this::squaredWaveNumber)) // keeps the order of equal ones
        .mapToInt(k -> k)
        .toArray();
  }

  /** |k|^2 of mode k, by which modes are sent; 0 for all if they are sent in the order of the basis. */
  private int squaredWaveNumber(int k) {
    int n = k % modes[1];
    int m = k / modes[1] % modes[0];
    int l = k / modes[1] / modes[0];
    return separated && !freeDomain ? l * l + m * m + n * n : 0;
  }

  boolean inBox() {
    return size[2] > 0;
  }

  /**
   * The coefficients of the field averaged along the axis that is not seen, at m * modes[up] + n;
   * m counts waves along the axis across.
   */
  double[] seen(double[] coefficients, int across, int up) {
    double[] seen = new double[modes[across] * modes[up]];
    int[] wave = new int[3];
    for (int m = 0; m < modes[across]; ++m) {
      for (int n = 0; n < modes[up]; ++n) {
        wave[across] = m;
        wave[up] = n;
        seen[m * modes[up] + n] = coefficients[(wave[2] * modes[0] + wave[0]) * modes[1] + wave[1]];
      }
    }
    return seen;
  }

  /** Positions: x and y of each in turn. */
  private static double[] places(ByteBuffer value) {
    require(value != null && value.remaining() % 16 == 0 && value.remaining() <= 16 * MAX_PLACES);
    double[] places = new double[value.remaining() / 8];
    for (int i = 0; i < places.length; ++i)
      places[i] = within(value.getDouble(), -1e13, 1e13);
    return places;
  }

  /** The values of a message's fields by number: the last of each, as bytes still to be read. */
  private static Map<Integer, ByteBuffer> fields(ByteBuffer message) {
    Map<Integer, ByteBuffer> found = new HashMap<>();
    each(message, found::put);
    return found;
  }

  /** Passes the value of each field on, as bytes still to be read. */
  private static void each(ByteBuffer message, BiConsumer<Integer, ByteBuffer> visit) {
    while (message.hasRemaining()) {
      long key = varint(message);
      int kind = (int) (key & 7);
      int begin = message.position();
      if (kind == 0) varint(message);
      long length = kind == 0 ? message.position() - begin : kind == 1 ? 8 : kind == 5 ? 4 : 0;
      if (kind == 2) length = varint(message);
      if (kind != 0) begin = message.position();
      require((kind <= 2 || kind == 5) && length >= 0 && length <= message.limit() - begin);
      ByteBuffer value = message.duplicate().order(ByteOrder.LITTLE_ENDIAN);
      value.limit(begin + (int) length).position(begin);
      visit.accept((int) (key >>> 3), value);
      message.position(begin + (int) length);
    }
  }

  private static long varint(ByteBuffer in) {
    long value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      byte part = in.get();
      value |= (part & 127L) << shift;
      if (part >= 0) return value;
    }
    throw new IllegalArgumentException("no varint");
  }

  private static double[] coefficients(ByteBuffer numbers, int count) {
    require(numbers.remaining() == 8 * count);
    double[] all = new double[count];
    for (int k = 0; k < count; ++k) all[k] = within(numbers.getDouble(), -1.001, 1.001);
    return all;
  }

  private static int modes(Map<Integer, ByteBuffer> basis, int field) {
    return (int) within(varint(basis.get(field)), 1, MAX_MODES);
  }

  private static double number(
      Map<Integer, ByteBuffer> message, int field, double low, double high) {
    ByteBuffer value = message.get(field);
    return within(value == null ? 0 : value.getDouble(), low, high);
  }

  private static double within(double value, double low, double high) {
    require(value >= low && value <= high);
    return value;
  }

  private static void require(boolean condition) {
    if (!condition) throw new IllegalArgumentException("no plan");
  }
}
