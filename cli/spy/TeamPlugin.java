// SPDX-License-Identifier: BSD-3-Clause
package ergocast.spy;

import java.awt.Window;
import java.awt.event.ActionEvent;
import java.beans.PropertyVetoException;
import javax.swing.AbstractAction;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import javax.swing.JInternalFrame;
import javax.swing.SwingUtilities;
import javax.swing.Timer;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/** Opens the view of the team for WORLD_STATE and TEAM_STATUS in a window of lcm-spy. */
public final class TeamPlugin implements SpyPlugin {
  private static final int WIDTH = 560, HEIGHT = 620;
  private static final int REFRESH_MS = 250;

  /** Listens from lcm-spy's start if the base URL is known: LCM repeats no old message. */
  public TeamPlugin() {
    String base = System.getProperty(Buses.BASE_URL);
    if (base != null) Buses.team(base);
  }

  @Override
  public boolean canHandle(long fingerprint) {
    return fingerprint == ergocast.world_state_t.LCM_FINGERPRINT
        || fingerprint == ergocast.team_status_t.LCM_FINGERPRINT;
  }

  /** lcm-spy first asks for the name alone, with neither desktop nor channel. */
  @Override
  public Action getAction(JDesktopPane desktop, ChannelData channel) {
    return new AbstractAction("Team") {
      @Override
      public void actionPerformed(ActionEvent event) {
        Team team = Buses.teamOf(channel);
        if (team != null) open(desktop, team);
      }
    };
  }

  private static void open(JDesktopPane desktop, Team team) {
    JInternalFrame frame = new JInternalFrame("Team", true, true, true, true);
    frame.setContentPane(new TeamView(team));
    frame.setSize(WIDTH, HEIGHT);
    desktop.add(frame);
    frame.setVisible(true);
    fill(desktop, frame);
    Timer refresh = new Timer(REFRESH_MS, tick -> {
      frame.repaint();
      if (frame.isClosed() || !desktop.isShowing()) ((Timer) tick.getSource()).stop();
    });
    refresh.start();
  }

  /** lcm-spy 1.2 and later open a small window for each viewer; earlier ones have one for all. */
  private static void fill(JDesktopPane desktop, JInternalFrame frame) {
    Window window = SwingUtilities.getWindowAncestor(desktop);
    if (window == null || desktop.getAllFrames().length > 1) return;
    window.setSize(WIDTH, HEIGHT);
    try {
      frame.setMaximum(true);
    } catch (PropertyVetoException remainsSmall) {
      frame.setLocation(0, 0);
    }
  }
}
