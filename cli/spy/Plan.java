// SPDX-License-Identifier: BSD-3-Clause
package ergocast.spy;

import java.nio.ByteBuffer;
import java.nio.ByteOrder;
import java.nio.charset.StandardCharsets;
import java.util.ArrayList;
import java.util.HashMap;
import java.util.List;
import java.util.Map;
import java.util.function.BiConsumer;

/** The few fields of a compiled plan, listed in plan/plan.proto, that the view needs. */
final class Plan {
  private static final int MAX_CORNERS = 1024; // of a ring
  private static final int WALLS = 21;

  final String name;
  final double[] origin = new double[2], size = new double[2]; // x and y [m]
  final double dt; // [s]
  final long lastTick;
  final List<double[]> walls = new ArrayList<>(); // rings: x and y of each corner in turn [m]

  /**
   * Reads Protobuf's wire format. A number that is not there is 0.
   *
   * @throws RuntimeException for bytes that are no plan
   */
  Plan(byte[] bytes) {
    Map<Integer, ByteBuffer> plan = fields(ByteBuffer.wrap(bytes));
    Map<Integer, ByteBuffer> domain = fields(plan.get(4));
    Map<Integer, ByteBuffer> timing = fields(plan.get(8));
    name = StandardCharsets.UTF_8.decode(plan.get(2)).toString();
    require(name.length() <= 64);
    for (int axis = 0; axis < 2; ++axis) {
      origin[axis] = number(domain, 1 + axis, -1e13, 1e13);
      size[axis] = number(domain, 3 + axis, 1e-6, 1e9);
    }
    dt = number(timing, 1, 1e-9, 1e6);
    lastTick = (long) within(varint(timing.get(2)), 1, 1e8);
    each(ByteBuffer.wrap(bytes), (field, value) -> {
      if (field == WALLS) walls.add(ring(fields(value).get(1)));
    });
  }

  private static double[] ring(ByteBuffer value) {
    require(value.remaining() % 16 == 0 && value.remaining() <= 16 * MAX_CORNERS);
    double[] ring = new double[value.remaining() / 8];
    for (int i = 0; i < ring.length; ++i) ring[i] = within(value.getDouble(), -1e13, 1e13);
    return ring;
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
