// SPDX-License-Identifier: BSD-3-Clause
package ergocast.spy;

/** A density from its coefficients: the sum of mu_k f_k / h_k^2 over all modes. */
final class CosineSeries {
  private CosineSeries() {}

  /**
   * The density at the centres of cells x cells parts of the domain, as a multiple of the uniform
   * density; [i][j] with i along x and j along y. 0 where too few modes make it negative.
   *
   * @param coefficients the means of f_mn, not divided by h, at m * modesY + n
   */
  static double[][] density(double[] coefficients, int modesX, int modesY, int cells) {
    double[][] cosines = new double[Plan.MAX_MODES][cells];
    for (int m = 0; m < Plan.MAX_MODES; ++m) {
      for (int i = 0; i < cells; ++i) {
        // 1 / h^2 is 2 along each axis on which f is not constant, divided by the area.
        cosines[m][i] = (m == 0 ? 1 : 2) * Math.cos(m * Math.PI * (i + 0.5) / cells);
      }
    }
    double[][] alongY = new double[modesX][cells];
    for (int m = 0; m < modesX; ++m) {
      for (int n = 0; n < modesY; ++n) {
        for (int j = 0; j < cells; ++j)
          alongY[m][j] += coefficients[m * modesY + n] * cosines[n][j];
      }
    }
    double[][] density = new double[cells][cells];
    for (int i = 0; i < cells; ++i) {
      for (int m = 0; m < modesX; ++m) {
        for (int j = 0; j < cells; ++j) density[i][j] += cosines[m][i] * alongY[m][j];
      }
      for (int j = 0; j < cells; ++j) density[i][j] = Math.max(0, density[i][j]);
    }
    return density;
  }
}
