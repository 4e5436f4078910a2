// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>

#include <fmt/core.h>

namespace steadyrest::nc::interpret::test {

/// A random part in Klartext and, beside it, its moves in plain G code (G90, G90.1), worked out
/// here by other formulas than the interpreter's: corners from their tangent lengths, tangential
/// arcs from two linear equations, cycles and repeats written out.
class RandomPart {
 public:
  explicit RandomPart(std::uint32_t seed) : random_(seed) {
    both("L X+0 Y+0 Z+5 FMAX M3", "G90 G90.1 G0 X0 Y0 Z5");
    const int count = 3 + pick(8);
    for (int i = 0; i < count; ++i) {
      element();
    }
    klartext_ += "L Z+100 FMAX\nM30\n" + subprograms_;
    twin_ += "G0 Z100\n";
  }
  [[nodiscard]] const std::string& klartext() const { return klartext_; }
  [[nodiscard]] const std::string& twin() const { return twin_; }

 private:
  int pick(int below) { return static_cast<int>(random_() % static_cast<std::uint32_t>(below)); }
  /// A length in thousandths, so that both texts say the same number.
  double length(double from, double to) {
    return std::round(1000.0 *
                      (from + (to - from) * static_cast<double>(random_() % 10001) / 10000.0)) /
           1000.0;
  }
  void both(const std::string& klartext, const std::string& twin) {
    klartext_ += klartext + "\n";
    twin_ += twin + "\n";
  }
  static std::string at(double x, double y) { return fmt::format("X{:.12f} Y{:.12f}", x, y); }
  static std::string comma(const std::string& text) {
    std::string out = text;
    for (char& c : out) {
      c = c == '.' ? ',' : c;
    }
    return out;
  }
  void go(double x, double y) {
    tx_ = x - x_;
    ty_ = y - y_;
    const double way = std::hypot(tx_, ty_);
    heading_ = way > 1e-3;
    tx_ /= heading_ ? way : 1.0;
    ty_ /= heading_ ? way : 1.0;
    x_ = x;
    y_ = y;
  }

  void element() {
    switch (pick(10)) {
      case 0:
        return line();
      case 1:
        return rapid();
      case 2:
        return circle();
      case 3:
        return helix();
      case 4:
        return by_radius();
      case 5:
        return tangential();
      case 6:
        return corner();
      case 7:
        return repeat();
      case 8:
        return holes();
      default:
        return subprogram();
    }
  }

  void line() {
    const double x = length(-50, 50);
    const double y = length(-50, 50);
    const double feed = length(50, 900);
    if (pick(2) == 0) {
      both(comma(fmt::format("L {} R0 F{:.12f}", at(x, y), feed)),
           fmt::format("G1 {} F{:.12f}", at(x, y), feed));
      return go(x, y);
    }
    both(fmt::format("Q1 = {:.12f}\nL IX+Q1 IY{:+.12f} F{:.12f}", x, y, feed),
         fmt::format("G1 {} F{:.12f}", at(x_ + x, y_ + y), feed));
    go(x_ + x, y_ + y);
  }

  void rapid() {
    const double x = length(-50, 50);
    both(fmt::format("L X{:+.12f} F MAX", x), fmt::format("G0 X{:.12f}", x));
    go(x, y_);
  }

  /// A centre, a direction, and an end by its angle.
  void circle() {
    const double cx = x_ + length(1, 20);
    const double cy = y_ + length(-20, 20);
    const bool counter = pick(2) == 0;
    const double angle = length(0.2, 6.0) * (counter ? 1 : -1);
    const double ex = cx + (x_ - cx) * std::cos(angle) - (y_ - cy) * std::sin(angle);
    const double ey = cy + (x_ - cx) * std::sin(angle) + (y_ - cy) * std::cos(angle);
    both(fmt::format("CC {}\nC {} DR{} F200", at(cx, cy), at(ex, ey), counter ? '+' : '-'),
         fmt::format("G{} {} I{:.12f} J{:.12f} F200", counter ? 3 : 2, at(ex, ey), cx, cy));
    leave_arc(ex, ey, cx, cy, counter);
  }

  void leave_arc(double ex, double ey, double cx, double cy, bool counter) {
    x_ = ex;
    y_ = ey;
    const double radius = std::hypot(ex - cx, ey - cy);
    tx_ = (counter ? -1 : 1) * (ey - cy) / radius;
    ty_ = (counter ? 1 : -1) * (ex - cx) / radius;
    heading_ = true;
  }

  void helix() {
    const double cx = x_ + length(1, 20);
    const double cy = y_ + length(-20, 20);
    const bool counter = pick(2) == 0;
    const double turned = length(10, 1500) * (counter ? 1 : -1);
    const double angle = turned * std::numbers::pi / 180.0;
    const double ex = cx + (x_ - cx) * std::cos(angle) - (y_ - cy) * std::sin(angle);
    const double ey = cy + (x_ - cx) * std::sin(angle) + (y_ - cy) * std::cos(angle);
    const double z = length(-9, 9);
    const int turns = static_cast<int>(std::abs(turned) / 360.0) + 1;
    both(fmt::format("CC {}\nCP IPA{:+.12f} Z{:+.12f} DR{} F200", at(cx, cy), turned, z,
                     counter ? '+' : '-'),
         fmt::format("G{} {} Z{:.12f} I{:.12f} J{:.12f} P{} F200", counter ? 3 : 2, at(ex, ey), z,
                     cx, cy, turns));
    leave_arc(ex, ey, cx, cy, counter);
    heading_ = heading_ && z == z_;
    z_ = z;
  }

  void by_radius() {
    const double x = length(1, 20);
    const double y = length(-20, 20);
    const double radius = std::ceil(1000.0 * (0.5 * std::hypot(x, y) + length(0.1, 9))) / 1000.0;
    const bool counter = pick(2) == 0;
    const bool large = pick(2) == 0;
    both(fmt::format("CR IX{:+.12f} IY{:+.12f} R{}{:.12f} DR{} F300", x, y, large ? '-' : '+',
                     radius, counter ? '+' : '-'),
         fmt::format("G{} {} R{}{:.12f} F300", counter ? 3 : 2, at(x_ + x, y_ + y),
                     large ? "-" : "", radius));
    x_ += x;
    y_ += y;
    heading_ = false;  // its centre is not worked out here
    line();
  }

  /// The centre c lies on the normal of the heading t and as far from the end: (c − p)·t = 0 and
  /// 2 c·(e − p) = e² − p².
  void tangential() {
    if (!heading_) {
      return line();
    }
    const double ex = x_ + length(-20, 20);
    const double ey = y_ + length(-20, 20);
    const double dx = ex - x_;
    const double dy = ey - y_;
    if (std::abs(tx_ * dy - ty_ * dx) < 0.05 * std::hypot(dx, dy) || std::hypot(dx, dy) < 1.0) {
      return line();
    }
    const double a = x_ * tx_ + y_ * ty_;
    const double b = 0.5 * (ex * ex + ey * ey - x_ * x_ - y_ * y_);
    const double d = tx_ * dy - ty_ * dx;
    const double cx = (a * dy - b * ty_) / d;
    const double cy = (tx_ * b - dx * a) / d;
    const bool counter = tx_ * (cy - y_) - ty_ * (cx - x_) > 0.0;
    both(fmt::format("CT {} F400", at(ex, ey)),
         fmt::format("G{} {} I{:.12f} J{:.12f} F400", counter ? 3 : 2, at(ex, ey), cx, cy));
    leave_arc(ex, ey, cx, cy, counter);
  }

  /// Two lines with a rounding or a chamfer between: the tangent length is r·tan(φ/2).
  void corner() {
    const double first = length(0, 6.28);
    const double turn = length(0.3, 2.6) * (pick(2) == 0 ? 1 : -1);
    const double px = x_ + 40 * std::cos(first);
    const double py = y_ + 40 * std::sin(first);
    const double ux = std::cos(first);
    const double uy = std::sin(first);
    const double vx = std::cos(first + turn);
    const double vy = std::sin(first + turn);
    const double ex = px + 40 * vx;
    const double ey = py + 40 * vy;
    const bool rounds = pick(2) == 0;
    const double size = length(0.1, 2.5);
    const double back = rounds ? size * std::tan(0.5 * std::abs(turn)) : size;
    both(fmt::format("L {} F500\n{}{:.12f} F100\nL {}", at(px, py), rounds ? "RND R" : "CHF ", size,
                     at(ex, ey)),
         fmt::format("G1 {} F500", at(px - back * ux, py - back * uy)));
    const double side = turn > 0 ? 1 : -1;
    const std::string arc = fmt::format(
        "G{} {} I{:.12f} J{:.12f} F100", turn > 0 ? 3 : 2, at(px + back * vx, py + back * vy),
        px - back * ux - side * size * uy, py - back * uy + side * size * ux);
    twin_ += (rounds ? arc : fmt::format("G1 {} F100", at(px + back * vx, py + back * vy))) + "\n" +
             fmt::format("G1 {} F500\n", at(ex, ey));
    x_ = px;
    y_ = py;
    go(ex, ey);
  }

  /// A section that is repeated with a growing step.
  void repeat() {
    const int repeats = pick(4);
    const double step = length(1, 3);
    const double grows = length(0.1, 1);
    const int label = ++labels_;
    klartext_ += fmt::format(
        "FN 0: Q{} = {:+.12f}\nLBL {}\nL IX+Q{} FMAX\nQ{} = Q{} + {:.12f}\nCALL LBL "
        "{} REP {}/{}\n",
        label, step, label, label, label, label, grows, label, repeats, repeats);
    double way = step;
    for (int i = 0; i <= repeats; ++i) {
      go(x_ + way, y_);
      twin_ += fmt::format("G0 X{:.12f}\n", x_);
      way += grows;
    }
  }

  void holes() {
    const double clear = length(1, 3);
    const double depth = length(5, 20);
    const double infeed = length(1, 8);
    const double second = length(4, 30);
    klartext_ += fmt::format(
        "CYCL DEF 200 DRILL ~\n Q200={:.12f} ~\n Q201=-{:.12f} ~\n Q206=150 ~\n Q202={:.12f} "
        ";INFEED ~\n"
        " Q210=0 ~\n Q203=+0 ~\n Q204={:.12f} ~\n Q211=0.1\n",
        clear, depth, infeed, second);
    const int count = 1 + pick(3);
    for (int i = 0; i < count; ++i) {
      const double x = length(-50, 50);
      both(fmt::format("L X{:+.12f} FMAX M99", x), fmt::format("G0 X{:.12f}\nZ{:.12f}", x, clear));
      double at_depth = 0;
      while (depth - at_depth > infeed + 1e-7) {
        at_depth += infeed;
        twin_ += fmt::format("G1 Z{:.12f} F150\nG0 Z{:.12f}\nZ{:.12f}\n", -at_depth, clear,
                             clear - at_depth);
      }
      twin_ +=
          fmt::format("G1 Z{:.12f} F150\nG4 P0.1\nG0 Z{:.12f}\n", -depth, std::max(clear, second));
      x_ = x;
    }
    z_ = std::max(clear, second);
    heading_ = false;
  }

  void subprogram() {
    const int label = ++labels_;
    const double x = length(-5, 5);
    const double y = length(-5, 5);
    subprograms_ +=
        fmt::format("LBL \"SUB{}\"\nL IX{:+.12f} IY{:+.12f} FMAX\nLBL 0\n", label, x, y);
    for (int i = 0; i <= pick(2); ++i) {
      go(x_ + x, y_ + y);
      both(fmt::format("CALL LBL \"SUB{}\"", label), fmt::format("G0 {}", at(x_, y_)));
    }
  }

  std::mt19937 random_;
  std::string klartext_;
  std::string twin_;
  std::string subprograms_;
  double x_ = 0;
  double y_ = 0;
  double z_ = 5;
  double tx_ = 0;
  double ty_ = 0;
  bool heading_ = false;
  int labels_ = 0;
};

}  // namespace steadyrest::nc::interpret::test
