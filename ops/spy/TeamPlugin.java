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

  /** A map and the metric; of a box from above, from the front and from the side, in quarters. */
  static JComponent picture(Team team) {
    MapView map = new MapView(team);
    MapView front = new MapView(team, 0, 2);
    MapView side = new MapView(team, 1, 2);
    MetricView metric = new MetricView(team);
    JPanel all = new JPanel(null) {
      @Override
      public void doLayout() {
        boolean box = map.inBox();
        int height = box ? getHeight() / 2 : getHeight();
        int left = box ? getWidth() / 2 : Math.min(getWidth() / 2, map.widthFor(height));
        map.setBounds(0, 0, left, height);
        metric.setBounds(left, 0, getWidth() - left, height);
        front.setBounds(0, height, box ? left : 0, getHeight() - height);
        side.setBounds(left, height, box ? getWidth() - left : 0, getHeight() - height);
      }
    };
    for (JComponent picture : new JComponent[] {map, metric, front, side}) all.add(picture);
    return all;
  }
}
