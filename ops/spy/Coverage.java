// SPDX-License-Identifier: BSD-3-Clause
package ergocast.spy;

import java.util.Arrays;
import java.util.Map;
import java.util.TreeMap;
import java.util.function.IntPredicate;

/** The received running sums of all agents. Like an agent, it keeps the one with most steps. */
final class Coverage {
  private static final double UNITS = 32767; // an average of 1 in 16 bits
  private static final int MAX_AUTHORS = 512;

  /** One incarnation of an agent, by mode. */
  private static final class Row {
    final int agent;
    final long[] steps;
    final double[] elapsed; // [s]
    final double[] sums; // [s]

    Row(int agent, int modes) {
      this.agent = agent;
      steps = new long[modes];
      elapsed = new double[modes];
      sums = new double[modes];
    }
  }

  private final Plan plan;
  private final int modes;
  private final Map<Long, Row> rows = new TreeMap<>(); // by incarnation

  Coverage(Plan plan) {
    this.plan = plan;
    modes = plan.target.length;
  }

  void add(ergocast.contribution_t heard) {
    add(heard.header, heard.steps, heard.elapsed_s, heard.mode_count, heard.block, heard.sums);
  }

  void add(ergocast.averages_t heard) {
    add(heard.header, heard.averages_steps, heard.averages_elapsed_s, heard.averages_mode_count,
        heard.averages_block, sums(heard.averages, heard.averages_elapsed_s));
  }

  void add(ergocast.low_sums_t heard) {
    add(heard.header, heard.low_steps, heard.low_elapsed_s, heard.low_mode_count, heard.low_block,
        heard.low_sums);
  }

  void add(ergocast.low_averages_t heard) {
    add(heard.header, heard.low_steps, heard.low_elapsed_s, heard.low_mode_count, heard.low_block,
        sums(heard.low_averages, heard.low_elapsed_s));
  }

  private static double[] sums(short[] averages, double elapsed) {
    double[] sums = new double[averages.length];
    for (int k = 0; k < sums.length; ++k) sums[k] = averages[k] / UNITS * elapsed;
    return sums;
  }

  private void add(ergocast.header_t header, long steps, double elapsed, int modeCount, int block,
      double[] sums) {
    int[] said = plan.modesOf(block, sums.length);
    boolean sane = modeCount == modes && said.length > 0 && elapsed > 0 && elapsed < 1e12;
    if (!sane || !Arrays.stream(sums).allMatch(sum -> Math.abs(sum) <= 1.001 * elapsed)) return;
    Row row = rows.get(header.incarnation);
    if (row == null && rows.size() < MAX_AUTHORS) {
      row = new Row(header.sender, modes);
      rows.put(header.incarnation, row);
    }
    if (row == null || row.agent != header.sender || row.steps[said[0]] >= steps) return;
    for (int i = 0; i < said.length; ++i) {
      row.steps[said[i]] = steps;
      row.elapsed[said[i]] = elapsed;
      row.sums[said[i]] = sums[i];
    }
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
        elapsed[k] += row.elapsed[k];
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
