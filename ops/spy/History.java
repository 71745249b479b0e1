// SPDX-License-Identifier: BSD-3-Clause
package ergocast.spy;

/**
 * Points over time, two or three numbers each, at most CAPACITY. When the memory is full, every second point is dropped, and
 * the distance between later points is doubled.
 */
final class History {
  static final int CAPACITY = 2048;

  private final long[] tick = new long[CAPACITY];
  private final double[][] numbers = new double[3][CAPACITY];
  private long ticksBetween = 1;
  private int size;

  /** Keeps the point if it is newer than the last one and not too close to it in time. */
  void add(long atTick, double... point) {
    if (size > 0 && atTick < tick[size - 1] + ticksBetween) return;
    if (size == CAPACITY) thin();
    tick[size] = atTick;
    for (int axis = 0; axis < point.length; ++axis) numbers[axis][size] = point[axis];
    ++size;
  }

  int size() {
    return size;
  }

  double x(int i) {
    return at(0, i);
  }

  double y(int i) {
    return at(1, i);
  }

  double at(int axis, int i) {
    return numbers[axis][i];
  }

  private void thin() {
    for (int i = 0; 2 * i < CAPACITY; ++i) {
      tick[i] = tick[2 * i];
      for (double[] axis : numbers) axis[i] = axis[2 * i];
    }
    size = CAPACITY / 2;
    ticksBetween *= 2;
  }
}
