// SPDX-License-Identifier: BSD-3-Clause
package ergocast.spy;

import java.awt.Dimension;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/** CONTRIBUTION: the coefficients of target, team and each agent's coverage. */
public final class CoefficientsPlugin implements SpyPlugin {
  @Override
  public boolean canHandle(long fingerprint) {
    return fingerprint == ergocast.contribution_t.LCM_FINGERPRINT
        || fingerprint == ergocast.averages_t.LCM_FINGERPRINT
        || fingerprint == ergocast.low_sums_t.LCM_FINGERPRINT
        || fingerprint == ergocast.low_averages_t.LCM_FINGERPRINT;
  }

  @Override
  public Action getAction(JDesktopPane desktop, ChannelData channel) {
    return new Viewer(
        "Coefficients", desktop, channel, CoefficientsView::new, new Dimension(860, 500));
  }
}
