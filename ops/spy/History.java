// SPDX-License-Identifier: BSD-3-Clause
package ergocast.spy;

/**
 * Points over time, at most CAPACITY. When the memory is full, every second point is dropped, and
 * the distance between later points is doubled.
 */
final class History {
  static final int CAPACITY = 2048;

  private final long[] tick = new long[CAPACITY];
  private final double[] x = new double[CAPACITY];
  private final double[] y = new double[CAPACITY];
  private long ticksBetween = 1;
  private int size;

  /** Keeps the point if it is newer than the last one and not too close to it in time. */
  void add(long atTick, double atX, double atY) {
    if (size > 0 && atTick < tick[size - 1] + ticksBetween) return;
    if (size == CAPACITY) thin();
    tick[size] = atTick;
    x[size] = atX;
    y[size] = atY;
    ++size;
  }

  int size() {
    return size;
  }

  double x(int i) {
    return x[i];
  }

  double y(int i) {
    return y[i];
  }

  private void thin() {
    for (int i = 0; 2 * i < CAPACITY; ++i) {
      tick[i] = tick[2 * i];
      x[i] = x[2 * i];
      y[i] = y[2 * i];
    }
    size = CAPACITY / 2;
    ticksBetween *= 2;
  }
}
