// SPDX-License-Identifier: BSD-3-Clause
package ergocast.spy;

import java.awt.Color;
import java.awt.Font;
import java.awt.Graphics;
import java.awt.Graphics2D;
import java.awt.RenderingHints;
import java.awt.geom.AffineTransform;
import java.awt.geom.Path2D;
import javax.swing.JComponent;

/** Clock, number of agents and metric; below them the map from above: walls, agents and trails. */
final class TeamView extends JComponent {
  static final int LEFT = 20, TOP = 60, RIGHT = 30, BOTTOM = 34; // around the map [pixels]
  private static final int RADIUS = 6; // of an agent [pixels]
  private static final int[] COLORS = { // of agents, as in the report
      0x0072b2, 0xd55e00, 0x009e73, 0xcc79a7, 0xe69f00, 0x56b4e9, 0x7a4fb5};

  private final Team team;

  TeamView(Team team) {
    this.team = team;
  }

  static Color color(int agent) {
    return new Color(COLORS[agent % COLORS.length]);
  }

  @Override
  protected void paintComponent(Graphics graphics) {
    Graphics2D g = (Graphics2D) graphics.create();
    g.setColor(Color.WHITE);
    g.fillRect(0, 0, getWidth(), getHeight());
    g.setRenderingHint(RenderingHints.KEY_ANTIALIASING, RenderingHints.VALUE_ANTIALIAS_ON);
    synchronized (team) {
      g.setColor(Color.BLACK);
      g.setFont(new Font(Font.SANS_SERIF, Font.BOLD, 14));
      g.drawString(team.headline(), LEFT, 24);
      g.setFont(new Font(Font.SANS_SERIF, Font.PLAIN, 12));
      if (team.plan != null) {
        g.drawString(team.report(), LEFT, 44);
        drawMap(g, team.plan);
      }
    }
    g.dispose();
  }

  /** The largest map with equal scales. */
  private void drawMap(Graphics2D g, Plan plan) {
    double scale = Math.min((getWidth() - LEFT - RIGHT) / plan.size[0],
        (getHeight() - TOP - BOTTOM) / plan.size[1]); // [pixels/m]
    int width = Math.max(1, (int) (scale * plan.size[0]));
    int height = Math.max(1, (int) (scale * plan.size[1]));
    AffineTransform toMap = AffineTransform.getTranslateInstance(LEFT, TOP + height);
    toMap.scale(width / plan.size[0], -height / plan.size[1]);
    toMap.translate(-plan.origin[0], -plan.origin[1]);
    g.setColor(Color.GRAY);
    g.drawRect(LEFT, TOP, width, height);
    Path2D walls = new Path2D.Double(Path2D.WIND_EVEN_ODD);
    for (double[] ring : plan.walls) {
      for (int i = 0; i + 1 < ring.length; i += 2) add(walls, i == 0, ring[i], ring[i + 1]);
    }
    Graphics2D inside = (Graphics2D) g.create(LEFT, TOP, width, height);
    inside.translate(-LEFT, -TOP);
    inside.fill(toMap.createTransformedShape(walls));
    float x = (float) plan.origin[0], y = (float) plan.origin[1];
    g.drawString("x from " + x + " to " + (float) (x + plan.size[0]) + " m, y from " + y + " to "
        + (float) (y + plan.size[1]) + " m", LEFT, TOP + height + 22);
    team.agents.forEach((id, agent) -> drawAgent(g, toMap, id, agent));
  }

  private static void drawAgent(Graphics2D g, AffineTransform toMap, int id, Team.Agent agent) {
    Path2D trail = new Path2D.Double();
    for (double[] place : agent.trail) add(trail, place == agent.trail.peek(), place[0], place[1]);
    g.setColor(color(id));
    g.draw(toMap.createTransformedShape(trail));
    double[] at = new double[2];
    toMap.transform(agent.trail.getLast(), 0, at, 0, 1);
    int x = (int) Math.round(at[0]), y = (int) Math.round(at[1]);
    g.fillOval(x - RADIUS, y - RADIUS, 2 * RADIUS, 2 * RADIUS);
    g.setColor(Color.BLACK);
    g.drawString(Integer.toString(id), x + RADIUS + 2, y - RADIUS + 2);
  }

  private static void add(Path2D path, boolean first, double x, double y) {
    if (first) path.moveTo(x, y);
    path.lineTo(x, y);
  }
}
