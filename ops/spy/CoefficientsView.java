// SPDX-License-Identifier: BSD-3-Clause
package ergocast.spy;

import java.awt.FontMetrics;
import java.awt.Graphics2D;
import java.awt.Rectangle;
import java.awt.image.BufferedImage;
import java.util.ArrayList;
import java.util.List;
import java.util.Locale;

/**
 * Each mode's |coefficient| as a square of colour: of target, team, their difference, each agent.
 */
final class CoefficientsView extends Picture {
  private static final int LEFT = 40, TOP = 62, RIGHT = 70,
                           BOTTOM = 24; // around all tiles [pixels]
  private static final int GAP = 14, CAPTION = 18;
  private static final double FAINTEST = 1e-5;

  /** One image with the words above it. */
  private static final class Tile {
    final String caption;
    final double[] coefficients;

    Tile(String caption, double[] coefficients) {
      this.caption = caption;
      this.coefficients = coefficients;
    }
  }

  CoefficientsView(Team team) {
    super(team);
  }

  @Override
  void draw(Graphics2D g, Team team) {
    String aboveOnly = team.plan.inBox() ? " without waves along z" : "";
    headline(g,
        "Coefficients of the " + team.plan.modes[0] + " × " + team.plan.modes[1] + " modes"
            + aboveOnly + (team.plan.freeDomain ? " of the free domain" : ""),
        (team.plan.freeDomain ? "ascending upwards, then to the right" : "m to the right, n upwards")
            + "; sums divided by the time they cover; grey: not heard",
        LEFT);
    List<Tile> tiles = tiles(team);
    int width = Math.max(20, getWidth() - LEFT - RIGHT);
    int height = Math.max(20, getHeight() - TOP - BOTTOM);
    int columns = columns(tiles.size(), width, height);
    int side = side(tiles.size(), columns, width, height);
    for (int i = 0; i < tiles.size(); ++i) {
      int x = LEFT + i % columns * (side + GAP);
      int y = TOP + i / columns * (side + GAP + CAPTION);
      drawTile(g, tiles.get(i), team.plan, new Rectangle(x, y + CAPTION, side, side));
    }
    Rectangle besideTheBar = new Rectangle(
        LEFT, TOP + CAPTION, columns * (side + GAP) - GAP, Math.min(height - CAPTION - 20, 260));
    Axes.colorBar(g, besideTheBar, new Axes.Scale("|c|", FAINTEST, 1, true), Colors::viridis);
  }

  private static List<Tile> tiles(Team team) {
    List<Tile> tiles = new ArrayList<>();
    double[] all = team.coverage.coefficients(any -> true);
    double[] difference = new double[all.length];
    for (int k = 0; k < all.length; ++k) difference[k] = all[k] - team.plan.target[k];
    tiles.add(new Tile("target", team.plan.target));
    tiles.add(new Tile("team", all));
    tiles.add(new Tile("team − target", difference));
    for (int agent : team.coverage.agents()) {
      tiles.add(new Tile(String.format(Locale.ROOT, "agent %d, %.0f s", agent,
                             team.coverage.elapsed(id -> id == agent)),
          team.coverage.coefficients(id -> id == agent)));
    }
    return tiles;
  }

  /** The number of columns that makes the tiles largest. */
  private static int columns(int tiles, int width, int height) {
    int best = 1;
    for (int columns = 2; columns <= tiles; ++columns) {
      if (side(tiles, columns, width, height) > side(tiles, best, width, height)) best = columns;
    }
    return best;
  }

  private static int side(int tiles, int columns, int width, int height) {
    int rows = (tiles + columns - 1) / columns;
    return Math.max(
        4, Math.min((width + GAP) / columns - GAP, (height + GAP) / rows - GAP - CAPTION));
  }

  private static void drawTile(Graphics2D g, Tile tile, Plan plan, Rectangle area) {
    int across = plan.modes[0];
    int up = plan.modes[1];
    BufferedImage image = new BufferedImage(across, up, BufferedImage.TYPE_INT_RGB);
    for (int m = 0; m < across; ++m) {
      for (int n = 0; n < up; ++n) {
        double c = Math.abs(tile.coefficients[m * up + n]);
        double level = 1 - Math.log10(Math.max(c, FAINTEST)) / Math.log10(FAINTEST);
        int color = Double.isFinite(c) ? Colors.viridis(level) : Colors.UNKNOWN.getRGB();
        image.setRGB(m, up - 1 - n, color);
      }
    }
    g.drawImage(image, area.x, area.y, area.width, area.height, null);
    g.setColor(Colors.SOFT);
    g.draw(area);
    FontMetrics font = g.getFontMetrics();
    g.setColor(Colors.INK);
    if (font.stringWidth(tile.caption) <= area.width + GAP)
      g.drawString(tile.caption, area.x, area.y - 5);
  }
}
