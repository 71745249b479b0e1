// SPDX-License-Identifier: BSD-3-Clause
package ergocast.spy;

import java.util.Arrays;
import java.util.Map;
import java.util.TreeMap;
import java.util.function.IntPredicate;

/** The running sums of all agents received: of each block the one with most steps, as agents do. */
final class Coverage {
  static final int BLOCK = 128;
  private static final int MAX_AUTHORS = 512;

  /** One incarnation of an agent. */
  private static final class Row {
    final int agent;
    final long[] steps; // by block
    final double[] elapsed; // by block [s]
    final double[] sums; // by mode [s]

    Row(int agent, int modes) {
      this.agent = agent;
      int blocks = (modes + BLOCK - 1) / BLOCK;
      steps = new long[blocks];
      elapsed = new double[blocks];
      sums = new double[blocks * BLOCK];
    }
  }

  private final int modes;
  private final Map<Long, Row> rows = new TreeMap<>(); // by incarnation

  Coverage(int modes) {
    this.modes = modes;
  }

  void add(ergocast.contribution_t heard) {
    boolean sane = heard.mode_count == modes && heard.block >= 0
        && heard.block * (long) BLOCK < modes && heard.elapsed_s > 0 && heard.elapsed_s < 1e12;
    if (!sane
        || !Arrays.stream(heard.sums).allMatch(sum -> Math.abs(sum) <= 1.001 * heard.elapsed_s)) {
      return;
    }
    Row row = rows.get(heard.header.incarnation);
    if (row == null && rows.size() < MAX_AUTHORS) {
      row = new Row(heard.header.sender, modes);
      rows.put(heard.header.incarnation, row);
    }
    if (row == null || row.agent != heard.header.sender || row.steps[heard.block] >= heard.steps)
      return;
    row.steps[heard.block] = heard.steps;
    row.elapsed[heard.block] = heard.elapsed_s;
    System.arraycopy(heard.sums, 0, row.sums, heard.block * BLOCK, BLOCK);
  }

  int[] agents() {
    return rows.values().stream().mapToInt(row -> row.agent).distinct().sorted().toArray();
  }

  /** c of the selected agents together; NaN where nothing was received. */
  double[] coefficients(IntPredicate which) {
    double[] sums = new double[modes];
    double[] elapsed = new double[modes];
    for (Row row : rows.values()) {
      if (!which.test(row.agent)) continue;
      for (int k = 0; k < modes; ++k) {
        sums[k] += row.sums[k];
        elapsed[k] += row.elapsed[k / BLOCK];
      }
    }
    for (int k = 0; k < modes; ++k) sums[k] /= elapsed[k];
    return sums;
  }

  /** The time that the selected agents have covered [s]. */
  double elapsed(IntPredicate which) {
    return rows.values()
        .stream()
        .filter(row -> which.test(row.agent))
        .mapToDouble(row -> row.elapsed[0])
        .sum();
  }
}
