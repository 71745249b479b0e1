// SPDX-License-Identifier: BSD-3-Clause
package ergocast.spy;

import java.awt.Color;
import java.awt.Font;
import java.awt.Graphics;
import java.awt.Graphics2D;
import java.awt.RenderingHints;
import javax.swing.JComponent;

/** A picture of the team on white, or the reason why there is none yet. */
abstract class Picture extends JComponent {
  private final Team team;

  Picture(Team team) {
    this.team = team;
  }

  /** Draws a team whose plan is known; called with its lock held. */
  abstract void draw(Graphics2D g, Team known);

  @Override
  protected final void paintComponent(Graphics graphics) {
    Graphics2D g = (Graphics2D) graphics.create();
    g.setColor(Color.WHITE);
    g.fillRect(0, 0, getWidth(), getHeight());
    g.setRenderingHint(RenderingHints.KEY_ANTIALIASING, RenderingHints.VALUE_ANTIALIAS_ON);
    g.setRenderingHint(
        RenderingHints.KEY_TEXT_ANTIALIASING, RenderingHints.VALUE_TEXT_ANTIALIAS_ON);
    g.setFont(new Font(Font.SANS_SERIF, Font.PLAIN, 12));
    synchronized (team) {
      if (team.plan != null) {
        draw(g, team);
      } else {
        g.setColor(Colors.SOFT);
        g.drawString("No mission received yet.", 24, 40);
      }
    }
    g.dispose();
  }

  /** A title and an explanation, above the area at `x`. */
  static void headline(Graphics2D g, String title, String note, int x) {
    Font plain = g.getFont();
    g.setFont(plain.deriveFont(Font.BOLD, 14f));
    g.setColor(Colors.INK);
    g.drawString(title, x, 24);
    g.setFont(plain);
    g.setColor(Colors.SOFT);
    g.drawString(note, x, 42);
  }
}
