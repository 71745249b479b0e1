// SPDX-License-Identifier: BSD-3-Clause
package ergocast.spy;

import java.awt.Dimension;
import javax.swing.Action;
import javax.swing.JComponent;
import javax.swing.JDesktopPane;
import javax.swing.JPanel;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/** WORLD_STATE and TEAM_STATUS: the positions and tracks of the team, and its ergodic metric. */
public final class TeamPlugin implements SpyPlugin {
  /** Listens from lcm-spy's start if the base URL is known, so that tracks are complete. */
  public TeamPlugin() {
    String base = System.getProperty(Buses.BASE_URL);
    if (base != null) Buses.team(base);
  }

  @Override
  public boolean canHandle(long fingerprint) {
    return fingerprint == ergocast.world_state_t.LCM_FINGERPRINT
        || fingerprint == ergocast.team_status_t.LCM_FINGERPRINT;
  }

  @Override
  public Action getAction(JDesktopPane desktop, ChannelData channel) {
    return new Viewer("Team", desktop, channel, TeamPlugin::picture, new Dimension(1040, 560));
  }

  private static JComponent picture(Team team) {
    MapView map = new MapView(team);
    MetricView metric = new MetricView(team);
    JPanel both = new JPanel(null) {
      @Override
      public void doLayout() {
        int left = Math.min(getWidth() / 2, map.widthFor(getHeight()));
        map.setBounds(0, 0, left, getHeight());
        metric.setBounds(left, 0, getWidth() - left, getHeight());
      }
    };
    both.add(map);
    both.add(metric);
    return both;
  }
}
