// SPDX-License-Identifier: BSD-3-Clause
package ergocast.spy;

import java.awt.Color;

/** The colours of the report, and more of them for large teams. */
final class Colors {
  static final Color INK = new Color(0x1d2127);
  static final Color SOFT = new Color(0x5b6470);
  static final Color GRID = new Color(0xe6e9ed);
  static final Color UNKNOWN = new Color(0xd9dce1);

  private static final int[] AGENTS = {
      0x0072b2, 0xd55e00, 0x009e73, 0xcc79a7, 0xe69f00, 0x56b4e9, 0x7a4fb5};
  private static final int[] VIRIDIS = {0x440154, 0x482878, 0x3e4989, 0x31688e, 0x26828e, 0x1f9e89,
      0x35b779, 0x6ece58, 0xb5de2b, 0xfde725};
  private static final int[] PENCIL = {0xffffff, 0xd9dce1, 0x9aa0aa};
  private static final double GOLDEN_ANGLE = 0.381966;

  private Colors() {}

  static Color agent(int id) {
    if (id < AGENTS.length) return new Color(AGENTS[id]);
    return Color.getHSBColor((float) (id * GOLDEN_ANGLE), 0.85f, 0.55f + 0.1f * (id % 4));
  }

  /** From dark to bright, for 0 to 1. */
  static int viridis(double level) {
    return blend(VIRIDIS, level);
  }

  /** From white to grey: coloured lines stay visible on it. */
  static int pencil(double level) {
    return blend(PENCIL, level);
  }

  private static int blend(int[] scale, double level) {
    double at = Math.max(0, Math.min(1, level)) * (scale.length - 1);
    int low = Math.min((int) at, scale.length - 2);
    int color = 0;
    for (int shift = 0; shift <= 16; shift += 8) {
      int from = scale[low] >> shift & 255;
      int to = scale[low + 1] >> shift & 255;
      color |= (int) Math.round(from + (to - from) * (at - low)) << shift;
    }
    return color;
  }
}
