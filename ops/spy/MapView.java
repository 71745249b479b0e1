// SPDX-License-Identifier: BSD-3-Clause
package ergocast.spy;

import java.awt.AlphaComposite;
import java.awt.BasicStroke;
import java.awt.Color;
import java.awt.Graphics2D;
import java.awt.Rectangle;
import java.awt.RenderingHints;
import java.awt.Shape;
import java.awt.geom.Ellipse2D;
import java.awt.geom.Path2D;
import java.awt.image.BufferedImage;
import java.util.Arrays;
import java.util.Map;

/** The target in grey, and on it each agent with its track. */
final class MapView extends Picture {
  private static final int CELLS = 200;
  private static final int LEFT = 72, TOP = 58, RIGHT = 84, BOTTOM = 50; // around the map [pixels]
  private static final int MOST_POINTS = 24000; // drawn, of all tracks together
  private static final int RECENT = 200; // last points of a track, drawn strongly
  private static final float RADIUS = 6;

  private Plan drawnPlan;
  private BufferedImage target;
  private double densest;

  MapView(Team team) {
    super(team);
  }

  /** The width that a map of this height can use. */
  int widthFor(int height) {
    double aspect = drawnPlan == null ? 1 : drawnPlan.sizeX / drawnPlan.sizeY;
    return LEFT + RIGHT + (int) Math.min(10000, (height - TOP - BOTTOM) * aspect);
  }

  @Override
  void draw(Graphics2D g, Team team) {
    Plan plan = team.plan;
    if (plan != drawnPlan) drawTarget(plan);
    Axes axes = axes(plan);
    headline(g, "Target and team",
        "grey: the target of " + plan.modesX + " × " + plan.modesY
            + " modes, 0 where they make it negative"
            + (plan.modesZ == 1 ? "" : "; seen from above, averages along z"),
        LEFT);
    g.setRenderingHint(
        RenderingHints.KEY_INTERPOLATION, RenderingHints.VALUE_INTERPOLATION_BILINEAR);
    Rectangle area = axes.area;
    g.drawImage(target, area.x, area.y, area.width, area.height, null);
    axes.frame(g);
    Axes.colorBar(g, area, new Axes.Scale("× uniform", 0, densest, false), Colors::pencil);

    Shape all = g.getClip();
    g.clip(area);
    int points = Math.max(100, MOST_POINTS / Math.max(1, team.agents.size()));
    team.agents.forEach((id, agent) -> drawTrack(g, axes, id, agent, points));
    g.setClip(all);
    for (Map.Entry<Integer, Team.Agent> entry : team.agents.entrySet()) {
      drawAgent(g, axes, entry.getKey(), entry.getValue(), team.agents.size());
    }
  }

  private void drawTarget(Plan plan) {
    double[][] density = CosineSeries.density(plan.target, plan.modesX, plan.modesY, CELLS);
    densest = Arrays.stream(density).flatMapToDouble(Arrays::stream).max().orElse(1);
    target = new BufferedImage(CELLS, CELLS, BufferedImage.TYPE_INT_RGB);
    for (int i = 0; i < CELLS; ++i) {
      for (int j = 0; j < CELLS; ++j) {
        target.setRGB(i, CELLS - 1 - j, Colors.pencil(density[i][j] / densest));
      }
    }
    drawnPlan = plan;
  }

  /** The largest axes with equal scales; a very narrow domain fills the available area instead. */
  private Axes axes(Plan plan) {
    int width = Math.max(20, getWidth() - LEFT - RIGHT);
    int height = Math.max(20, getHeight() - TOP - BOTTOM);
    double scale = Math.min(width / plan.sizeX, height / plan.sizeY);
    width = Math.max(20, (int) (scale * plan.sizeX));
    height = Math.max(20, (int) (scale * plan.sizeY));
    return new Axes(new Rectangle(LEFT, TOP, width, height),
        new Axes.Scale("x [m]", plan.originX, plan.originX + plan.sizeX, false),
        new Axes.Scale("y [m]", plan.originY, plan.originY + plan.sizeY, false));
  }

  private static void drawTrack(Graphics2D g, Axes axes, int id, Team.Agent agent, int points) {
    int end = agent.track.size();
    g.setColor(Colors.agent(id));
    g.setComposite(AlphaComposite.getInstance(AlphaComposite.SRC_OVER, 0.5f));
    g.setStroke(new BasicStroke(1));
    g.draw(path(axes, agent, Math.max(0, end - points), Math.max(0, end - RECENT)));
    g.setComposite(AlphaComposite.SrcOver);
    g.setStroke(new BasicStroke(2));
    Path2D recent = path(axes, agent, Math.max(0, end - RECENT), end);
    if (end > 0) recent.lineTo(axes.pixelX(agent.x), axes.pixelY(agent.y));
    g.draw(recent);
  }

  /** Points begin to end of an agent's track, both inclusive if they exist. */
  private static Path2D path(Axes axes, Team.Agent agent, int begin, int end) {
    Path2D path = new Path2D.Double();
    for (int i = begin; i <= end && i < agent.track.size(); ++i) {
      double x = axes.pixelX(agent.track.x(i));
      double y = axes.pixelY(agent.track.y(i));
      if (i == begin) path.moveTo(x, y);
      path.lineTo(x, y);
    }
    return path;
  }

  private static void drawAgent(Graphics2D g, Axes axes, int id, Team.Agent agent, int agents) {
    if (agent.tick < 0) return;
    float x = (float) axes.pixelX(agent.x);
    float y = (float) axes.pixelY(agent.y);
    Shape disc = new Ellipse2D.Float(x - RADIUS, y - RADIUS, 2 * RADIUS, 2 * RADIUS);
    g.setStroke(new BasicStroke(1.5f));
    g.setColor(Colors.agent(id));
    g.fill(disc);
    g.setColor(Color.WHITE);
    g.draw(disc);
    g.setColor(Colors.INK);
    if (agents <= 32) g.drawString(Integer.toString(id), x + RADIUS + 2, y - RADIUS + 2);
  }
}
