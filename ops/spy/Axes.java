// SPDX-License-Identifier: BSD-3-Clause
package ergocast.spy;

import java.awt.Color;
import java.awt.FontMetrics;
import java.awt.Graphics2D;
import java.awt.Rectangle;
import java.awt.geom.AffineTransform;
import java.math.BigDecimal;
import java.math.MathContext;
import java.util.function.DoubleToIntFunction;

/** A rectangle of a picture with a scale along each side. */
final class Axes {
  private static final int MARKS = 5;

  /** The scale of one side: linear, or decades where `low` and `high` are powers of ten. */
  static final class Scale {
    final String title;
    final double low, high;
    final boolean log;

    Scale(String title, double low, double high, boolean log) {
      this.title = title;
      this.low = low;
      this.high = high > low ? high : low + 1;
      this.log = log;
    }

    /** A scale of whole decades that contains `low` and `high`, both above 0. */
    static Scale decades(String title, double low, double high) {
      double first = Math.floor(Math.log10(low));
      double last = Math.max(first + 1, Math.ceil(Math.log10(high)));
      return new Scale(title, Math.pow(10, first), Math.pow(10, last), true);
    }

    /** The position of `value` along the scale, 0 to 1. */
    double position(double value) {
      return log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
    }

    double[] marks() {
      return log ? powersOfTen() : roundSteps();
    }

    String label(double value) {
      if (!log) return trimmed(value);
      int decade = (int) Math.round(Math.log10(value));
      return decade >= -3 && decade <= 4 ? trimmed(value) : "1e" + decade;
    }

    private double[] powersOfTen() {
      int first = (int) Math.round(Math.log10(low));
      int last = (int) Math.round(Math.log10(high));
      int stride = 1 + (last - first) / 8;
      double[] marks = new double[(last - first) / stride + 1];
      for (int i = 0; i < marks.length; ++i) marks[i] = Math.pow(10, first + i * stride);
      return marks;
    }

    private double[] roundSteps() {
      double rough = (high - low) / MARKS;
      double decade = Math.pow(10, Math.floor(Math.log10(rough)));
      double factor = rough > 5 * decade ? 10 : rough > 2 * decade ? 5 : rough > decade ? 2 : 1;
      double step = factor * decade;
      double first = Math.ceil(low / step - 1e-9);
      int count = (int) Math.floor(high / step - first + 1e-9) + 1;
      double[] marks = new double[Math.max(0, Math.min(count, 2 * MARKS))];
      for (int i = 0; i < marks.length; ++i) marks[i] = (first + i) * step;
      return marks;
    }

    private static String trimmed(double value) {
      BigDecimal rounded = BigDecimal.valueOf(value).round(new MathContext(6));
      return rounded.signum() == 0 ? "0" : rounded.stripTrailingZeros().toPlainString();
    }
  }

  final Rectangle area;
  final Scale x, y;

  Axes(Rectangle area, Scale x, Scale y) {
    this.area = area;
    this.x = x;
    this.y = y;
  }

  double pixelX(double value) {
    return area.x + area.width * x.position(value);
  }

  double pixelY(double value) {
    return area.y + area.height * (1 - y.position(value));
  }

  void grid(Graphics2D g) {
    g.setColor(Colors.GRID);
    for (double mark : x.marks()) {
      int at = (int) Math.round(pixelX(mark));
      g.drawLine(at, area.y, at, area.y + area.height);
    }
    for (double mark : y.marks()) {
      int at = (int) Math.round(pixelY(mark));
      g.drawLine(area.x, at, area.x + area.width, at);
    }
  }

  /** The frame, and labels outside of it: 56 pixels to the left, 40 below. */
  void frame(Graphics2D g) {
    FontMetrics font = g.getFontMetrics();
    g.setColor(Colors.SOFT);
    g.draw(area);
    int bottom = area.y + area.height;
    for (double mark : x.marks()) {
      String label = x.label(mark);
      int at = (int) Math.round(pixelX(mark));
      g.drawLine(at, bottom, at, bottom + 4);
      g.drawString(label, at - font.stringWidth(label) / 2, bottom + 6 + font.getAscent());
    }
    for (double mark : y.marks()) {
      String label = y.label(mark);
      int at = (int) Math.round(pixelY(mark));
      g.drawLine(area.x - 4, at, area.x, at);
      g.drawString(label, area.x - 7 - font.stringWidth(label), at + font.getAscent() / 2 - 1);
    }
    g.setColor(Colors.INK);
    g.drawString(x.title, area.x + (area.width - font.stringWidth(x.title)) / 2, bottom + 36);
    AffineTransform upright = g.getTransform();
    g.rotate(-Math.PI / 2, area.x - 46, area.y + area.height / 2.0);
    g.drawString(y.title, area.x - 46 - font.stringWidth(y.title) / 2, area.y + area.height / 2);
    g.setTransform(upright);
  }

  /** A strip of colours to the right of `area`, with its own scale; takes 70 pixels there. */
  static void colorBar(Graphics2D g, Rectangle area, Scale scale, DoubleToIntFunction color) {
    Rectangle bar = new Rectangle(area.x + area.width + 12, area.y, 12, area.height);
    for (int line = 0; line < bar.height; ++line) {
      g.setColor(new Color(color.applyAsInt(1 - (line + 0.5) / bar.height)));
      g.fillRect(bar.x, bar.y + line, bar.width, 1);
    }
    g.setColor(Colors.SOFT);
    g.draw(bar);
    FontMetrics font = g.getFontMetrics();
    for (double mark : scale.marks()) {
      int at = bar.y + (int) Math.round(bar.height * (1 - scale.position(mark)));
      g.drawLine(bar.x + bar.width, at, bar.x + bar.width + 4, at);
      g.drawString(scale.label(mark), bar.x + bar.width + 7, at + font.getAscent() / 2 - 1);
    }
    g.setColor(Colors.INK);
    g.drawString(scale.title, bar.x, bar.y + bar.height + 24);
  }
}
