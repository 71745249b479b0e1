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

/** The target in grey, walls, stations, and on them each agent with its track, seen along one axis. */
final class MapView extends Picture {
  private static final String[] AXES = {"x", "y", "z"};
  private static final int CELLS = 200;
  private static final int LEFT = 72, TOP = 58, RIGHT = 84, BOTTOM = 50; // around the map [pixels]
  private static final int MOST_POINTS = 24000; // drawn, of all tracks together
  private static final int RECENT = 200; // last points of a track, drawn strongly
  private static final float RADIUS = 6;
  private static final int STATION = 10; // half a side

  private final int across, up; // the axes that are seen; x and y in a plane
  private Plan drawnPlan;
  private BufferedImage target;
  private double densest;

  MapView(Team team) {
    this(team, 0, 1);
  }

  MapView(Team team, int across, int up) {
    super(team);
    this.across = across;
    this.up = up;
  }

  /** Whether a mission in a box was drawn. */
  boolean inBox() {
    return drawnPlan != null && drawnPlan.inBox();
  }

  /** The width that a map of this height can use. */
  int widthFor(int height) {
    double aspect = drawnPlan == null ? 1 : drawnPlan.size[across] / drawnPlan.size[up];
    return LEFT + RIGHT + (int) Math.min(10000, (height - TOP - BOTTOM) * aspect);
  }

  @Override
  void draw(Graphics2D g, Team team) {
    Plan plan = team.plan;
    if (plan != drawnPlan) drawTarget(plan);
    Axes axes = axes(plan);
    String modes = plan.modes[0] + " × " + plan.modes[1] + (plan.inBox() ? " × " + plan.modes[2] : "");
    if (plan.freeDomain) modes += " cosine";
    headline(g, plan.inBox() ? "Target and team along " + AXES[3 - across - up] : "Target and team",
        plan.inBox() ? "grey: the average of the target of " + modes + " modes"
                     : "grey: the target of " + modes + " modes, 0 where they make it negative",
        LEFT);
    g.setRenderingHint(
        RenderingHints.KEY_INTERPOLATION, RenderingHints.VALUE_INTERPOLATION_BILINEAR);
    Rectangle area = axes.area;
    g.drawImage(target, area.x, area.y, area.width, area.height, null);
    axes.frame(g);
    Axes.colorBar(g, area, new Axes.Scale("× uniform", 0, densest, false), Colors::pencil);

    Shape all = g.getClip();
    g.clip(area);
    drawWalls(g, axes, plan);
    int points = Math.max(100, MOST_POINTS / Math.max(1, team.agents.size()));
    team.agents.forEach((id, agent) -> drawTrack(g, axes, id, agent, points));
    g.setClip(all);
    if (up == 1) drawStations(g, axes, plan);
    for (Map.Entry<Integer, Team.Agent> entry : team.agents.entrySet()) {
      drawAgent(g, axes, entry.getKey(), entry.getValue(), team.agents.size());
    }
  }

  private void drawTarget(Plan plan) {
    double[][] density = CosineSeries.density(
        plan.seen(plan.cosineTarget, across, up), plan.modes[across], plan.modes[up], CELLS);
    densest = Arrays.stream(density).flatMapToDouble(Arrays::stream).max().orElse(1);
    target = new BufferedImage(CELLS, CELLS, BufferedImage.TYPE_INT_RGB);
    for (int i = 0; i < CELLS; ++i) {
      for (int j = 0; j < CELLS; ++j) {
        target.setRGB(i, CELLS - 1 - j, Colors.pencil(density[i][j] / densest));
      }
    }
    drawnPlan = plan;
  }

  /** The largest axes with equal scales; but a flat box is drawn at least a quarter as high. */
  private Axes axes(Plan plan) {
    int width = Math.max(20, getWidth() - LEFT - RIGHT);
    int height = Math.max(20, getHeight() - TOP - BOTTOM);
    double most = height;
    double scale = Math.min(width / plan.size[across], height / plan.size[up]);
    width = Math.max(20, (int) (scale * plan.size[across]));
    height = Math.max(20, (int) (scale * plan.size[up]));
    if (up == 2) height = (int) Math.max(height, Math.min(most, width / 4.0));
    return new Axes(
        new Rectangle(LEFT, TOP, width, height), scale(plan, across), scale(plan, up));
  }

  private static Axes.Scale scale(Plan plan, int axis) {
    double low = plan.origin[axis];
    return new Axes.Scale(AXES[axis] + " [m]", low, low + plan.size[axis], false);
  }

  /** Fills the places that an odd number of rings enclose. */
  private static void drawWalls(Graphics2D g, Axes axes, Plan plan) {
    Path2D walls = new Path2D.Double(Path2D.WIND_EVEN_ODD);
    for (double[] ring : plan.walls) {
      for (int i = 0; i + 1 < ring.length; i += 2) {
        double x = axes.pixelX(ring[i]);
        double y = axes.pixelY(ring[i + 1]);
        if (i == 0) walls.moveTo(x, y);
        walls.lineTo(x, y);
      }
      if (ring.length > 0) walls.closePath();
    }
    g.setColor(Color.GRAY);
    g.fill(walls);
  }

  /** Draws stations, where agents must be at the end, as open squares. */
  private static void drawStations(Graphics2D g, Axes axes, Plan plan) {
    for (double[] places : plan.stations) {
      for (int i = 0; i + 1 < places.length; i += 2) {
        int x = (int) Math.round(axes.pixelX(places[i]));
        int y = (int) Math.round(axes.pixelY(places[i + 1]));
        g.setColor(Color.WHITE);
        g.setStroke(new BasicStroke(4));
        g.drawRect(x - STATION, y - STATION, 2 * STATION, 2 * STATION);
        g.setColor(Colors.INK);
        g.setStroke(new BasicStroke(1.6f));
        g.drawRect(x - STATION, y - STATION, 2 * STATION, 2 * STATION);
      }
    }
  }

  private void drawTrack(Graphics2D g, Axes axes, int id, Team.Agent agent, int points) {
    int end = agent.track.size();
    g.setColor(Colors.agent(id));
    g.setComposite(AlphaComposite.getInstance(AlphaComposite.SRC_OVER, 0.5f));
    g.setStroke(new BasicStroke(1));
    g.draw(path(axes, agent, Math.max(0, end - points), Math.max(0, end - RECENT)));
    g.setComposite(AlphaComposite.SrcOver);
    g.setStroke(new BasicStroke(2));
    Path2D recent = path(axes, agent, Math.max(0, end - RECENT), end);
    if (end > 0) recent.lineTo(axes.pixelX(agent.place[across]), axes.pixelY(agent.place[up]));
    g.draw(recent);
  }

  /** Points begin to end of an agent's track, both inclusive if they exist. */
  private Path2D path(Axes axes, Team.Agent agent, int begin, int end) {
    Path2D path = new Path2D.Double();
    for (int i = begin; i <= end && i < agent.track.size(); ++i) {
      double x = axes.pixelX(agent.track.at(across, i));
      double y = axes.pixelY(agent.track.at(up, i));
      if (i == begin) path.moveTo(x, y);
      path.lineTo(x, y);
    }
    return path;
  }

  private void drawAgent(Graphics2D g, Axes axes, int id, Team.Agent agent, int agents) {
    if (agent.tick < 0) return;
    float x = (float) axes.pixelX(agent.place[across]);
    float y = (float) axes.pixelY(agent.place[up]);
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
