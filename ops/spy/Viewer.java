// SPDX-License-Identifier: BSD-3-Clause
package ergocast.spy;

import java.awt.Dimension;
import java.awt.Window;
import java.awt.event.ActionEvent;
import java.beans.PropertyVetoException;
import java.util.Locale;
import java.util.function.Function;
import javax.swing.AbstractAction;
import javax.swing.JComponent;
import javax.swing.JDesktopPane;
import javax.swing.JInternalFrame;
import javax.swing.SwingUtilities;
import javax.swing.Timer;
import lcm.spy.ChannelData;

/** Opens a picture of the team in a window of lcm-spy and updates it. */
final class Viewer extends AbstractAction {
  private static final int REFRESH_MS = 250;

  private final JDesktopPane desktop;
  private final ChannelData channel;
  private final Function<Team, JComponent> picture;
  private final Dimension size;

  /**
   * lcm-spy first asks only for the name, without desktop and channel, and later for the action.
   */
  Viewer(String name, JDesktopPane desktop, ChannelData channel, Function<Team, JComponent> picture,
      Dimension size) {
    super(name);
    this.desktop = desktop;
    this.channel = channel;
    this.picture = picture;
    this.size = size;
  }

  @Override
  public void actionPerformed(ActionEvent event) {
    Team team = Buses.teamOf(channel);
    if (team == null) return;
    JInternalFrame frame = new JInternalFrame(title(team), true, true, true, true);
    frame.setContentPane(picture.apply(team));
    frame.setSize(size);
    desktop.add(frame);
    frame.setVisible(true);
    fill(frame);
    Timer refresh = new Timer(REFRESH_MS, tick -> {
      frame.setTitle(title(team));
      frame.getContentPane().revalidate(); // the mission may have arrived, which changes the shape
      frame.repaint();
      if (frame.isClosed() || !desktop.isShowing()) ((Timer) tick.getSource()).stop();
    });
    refresh.start();
  }

  /** lcm-spy 1.2 and later open a small window for each viewer; earlier ones have one for all. */
  private void fill(JInternalFrame frame) {
    Window window = SwingUtilities.getWindowAncestor(desktop);
    if (window == null || desktop.getAllFrames().length > 1) return;
    window.setSize(size);
    try {
      frame.setMaximum(true);
    } catch (PropertyVetoException remainsSmall) {
      frame.setLocation(0, 0);
    }
  }

  private static String title(Team team) {
    synchronized (team) {
      if (team.plan == null) return "waiting for the mission, which is said once a second";
      return String.format(Locale.ROOT, "%s%s: %.1f of %.0f s%s",
          team.replay ? "replay of " : "", team.plan.name,
          team.elapsed(), team.plan.duration,
          team.status.isEmpty() ? "" : ", " + team.status);
    }
  }
}
