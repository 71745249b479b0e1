// SPDX-License-Identifier: BSD-3-Clause
package ergocast.spy;

import java.awt.BasicStroke;
import java.awt.Graphics2D;
import java.awt.Rectangle;
import java.awt.geom.Path2D;
import java.util.Locale;

/** The ergodic metric of the team over the mission's time. */
final class MetricView extends Picture {
  private static final int LEFT = 72, TOP = 58, RIGHT = 24, BOTTOM = 50; // around the plot [pixels]

  MetricView(Team team) {
    super(team);
  }

  @Override
  void draw(Graphics2D g, Team team) {
    History metric = team.metric;
    double low = Double.MAX_VALUE;
    double high = 0;
    for (int i = 0; i < metric.size(); ++i) {
      low = Math.min(low, metric.y(i));
      high = Math.max(high, metric.y(i));
    }
    boolean empty = high == 0;
    double elapsed = team.elapsed();
    Axes axes = new Axes(new Rectangle(LEFT, TOP, Math.max(20, getWidth() - LEFT - RIGHT),
                             Math.max(20, getHeight() - TOP - BOTTOM)),
        new Axes.Scale(
            "mission time [s]", 0, Math.min(team.plan.duration, nextRound(elapsed)), false),
        Axes.Scale.decades("φ²", empty ? 0.1 : low, empty ? 1 : high));
    String newest = empty ? "" : String.format(Locale.ROOT, " = %.3g", metric.y(metric.size() - 1));
    headline(g, "Ergodic metric φ²" + newest,
        (team.plan.freeDomain ? "in modes of the free domain; " : "")
            + "median of what the agents know; 0 is perfect coverage",
        LEFT);
    axes.grid(g);
    axes.frame(g);
    Path2D curve = new Path2D.Double();
    for (int i = 0; i < metric.size(); ++i) {
      double x = axes.pixelX(metric.x(i));
      double y = axes.pixelY(metric.y(i));
      if (i == 0) curve.moveTo(x, y);
      curve.lineTo(x, y);
    }
    g.clip(axes.area);
    g.setColor(Colors.INK);
    g.setStroke(new BasicStroke(2));
    g.draw(curve);
  }

  /** The end of the time axis, which grows in steps. */
  private static double nextRound(double elapsed) {
    double end = 10;
    while (end < elapsed) end *= end < 60 ? 2 : 1.5;
    return end;
  }
}
