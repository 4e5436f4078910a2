// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

/// Small programs, each for one thing that LinuxCNC's planner does, with what LinuxCNC 2.9.0~pre1
/// (Debian 12) made of them on 29 November 2026: joint commands of measure.sh each 1 ms, the limits
/// of examples/machines/linuxcnc-mill.toml, servos ẋ = k·(c − x) behind them.
namespace steadyrest::linuxcnc_test {

struct MeasuredProgram {
  std::string name;
  std::string text;
  double cut_s = 0.0;       ///< from the start of the cut to the last motion
  double rms_k20_um = 0.0;  ///< contour error over the cut and 150 ms more, k = 20 1/s
  double rms_k50_um = 0.0;
};

namespace programs {

using Place = std::array<double, 3>;

inline std::string program(const std::string& mode, double feed_mm_min, const Place& start,
                           const std::string& body) {
  return fmt::format(
      "G21 G90 G17 G94 {}\nG0 X{:.5f} Y{:.5f} Z{:.5f}\nG4 P0.3\nG1 F{}\n{}G4 P0.3\nM2\n", mode,
      start[0], start[1], start[2], feed_mm_min, body);
}

template <class F>
std::string through(int points, F&& at) {
  std::string out;
  for (int i = 1; i <= points; ++i) {
    const Place p = at(i);
    out += fmt::format("G1 X{:.5f} Y{:.5f} Z{:.5f}\n", p[0], p[1], p[2]);
  }
  return out;
}

inline Place polar(double radius, double angle) {
  return {radius * std::cos(angle), radius * std::sin(angle), 0.0};
}

/// A circle of 8 mm in chords.
inline std::string chords(const std::string& mode, double chord_mm, int count) {
  return program(mode, 1800, {8, 0, 0},
                 through(count, [&](int i) { return polar(8.0, i * chord_mm / 8.0); }));
}

inline std::string star(const std::string& mode) {
  return program(mode, 2400, {12, 0, 0}, through(20, [](int i) {
                   return polar(i % 2 == 0 ? 12.0 : 6.0, std::numbers::pi / 10 * i);
                 }));
}

inline std::string wave_in_space(const std::string& mode) {
  return program(mode, 2000, {0, 0, 0}, through(240, [](int i) {
                   const double t = i * 0.15;
                   return Place{t, 3 * std::sin(0.4 * t), 1.5 * std::cos(0.5 * t) - 1.5};
                 }));
}

inline std::string spiral(const std::string& mode) {
  return program(mode, 2400, {2, 0, 0},
                 through(199, [](int i) { return polar(2 + 0.3 * (0.1 * i), 0.1 * i); }));
}

/// Lines of 4 mm with sharper and sharper corners.
inline std::string corners(const std::string& mode) {
  constexpr std::array kTurns_deg = {0.0, 0.1, 0.2, 0.3,  0.4,  0.5, 0.7,
                                     1.0, 2.0, 5.0, 10.0, 20.0, 45.0};
  double along = 0.0;
  Place p{};
  const std::string body = through(13, [&](int i) {
    along += kTurns_deg.at(static_cast<std::size_t>(i - 1)) * std::numbers::pi / 180;
    p[0] += 4 * std::cos(along);
    p[1] += 4 * std::sin(along);
    return p;
  });
  return program(mode, 1200, {0, 0, 0}, body);
}

/// Lines of 5 mm, each with a kink into an arc of 6 mm that bends one way or the other.
inline std::string lines_and_arcs(const std::string& mode) {
  constexpr std::array kKinks_deg = {0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0};
  double x = 0.0;
  double y = 0.0;
  double along = 0.0;
  std::string body;
  const auto line = [&] {
    x += 5 * std::cos(along);
    y += 5 * std::sin(along);
    body += fmt::format("G1 X{:.5f} Y{:.5f}\n", x, y);
  };
  for (std::size_t i = 0; i < kKinks_deg.size(); ++i) {
    line();
    along += kKinks_deg.at(i) * std::numbers::pi / 180;
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    const double to_x = -side * 6 * std::sin(along);
    const double to_y = side * 6 * std::cos(along);
    along += side * std::numbers::pi / 3;
    const double end_x = x + to_x + side * 6 * std::sin(along);
    const double end_y = y + to_y - side * 6 * std::cos(along);
    body += fmt::format("G{} X{:.5f} Y{:.5f} I{:.5f} J{:.5f}\n", side > 0 ? 3 : 2, end_x, end_y,
                        to_x, to_y);
    x = end_x;
    y = end_y;
  }
  line();
  return program(mode, 2000, {0, 0, 0}, body);
}

/// Quarter turns that go down by different slopes.
inline std::string helix(const std::string& mode) {
  std::string body;
  double z = 0.0;
  for (int i = 0; i < 12; ++i) {
    const Place from = polar(10.0, std::numbers::pi / 2 * i);
    const Place to = polar(10.0, std::numbers::pi / 2 * (i + 1));
    z -= 0.02 * (1 + (i % 4) * 1.5);
    body += fmt::format("G3 X{:.5f} Y{:.5f} Z{:.5f} I{:.5f} J{:.5f}\n", to[0], to[1], z, -from[0],
                        -from[1]);
  }
  return program(mode, 2400, {10, 0, 0}, body);
}

/// Ten teeth: arcs at the tips and the roots, straight flanks.
inline std::string gear(const std::string& mode) {
  std::string body;
  const double quarter = 2 * std::numbers::pi / 10 / 4;
  const auto to = [&](const char* word, double radius, double angle, const char* arc) {
    const Place p = polar(radius, angle);
    body += fmt::format("{} X{:.5f} Y{:.5f}{}\n", word, p[0], p[1], arc);
  };
  for (int i = 0; i < 10; ++i) {
    const double a = 2 * std::numbers::pi * i / 10;
    to("G3", 12, a + quarter, " R12");
    to("G1", 9, a + 1.3 * quarter, "");
    to("G3", 9, a + 2.7 * quarter, " R9");
    to("G1", 12, a + 3 * quarter, "");
    to("G3", 12, a + 4 * quarter, " R12");
  }
  return program(mode, 1500, {12, 0, 0}, body);
}

/// Four rounded squares, one inside the other.
inline std::string pocket(const std::string& mode) {
  std::string body;
  for (int k = 0; k < 4; ++k) {
    const int a = 20 - 4 * k;
    const int r = k < 3 ? 3 : 2;
    body += fmt::format(
        "G1 X{0} Y-{1}\nG3 X{1} Y-{0} I0 J{2}\nG1 X{1} Y{0}\nG3 X{0} Y{1} I-{2} J0\nG1 X-{0} "
        "Y{1}\nG3 X-{1} Y{0} I0 J-{2}\nG1 X-{1} Y-{0}\nG3 X-{0} Y-{1} I{2} J0\n",
        a - r, a, r);
  }
  return program(mode, 3000, {0, -20, 0}, body);
}

/// Half circles from 0.3 to 3 mm between straight walls.
inline std::string slots(const std::string& mode) {
  std::string body;
  double x = 0.0;
  for (const double r : {0.3, 0.5, 1.0, 1.5, 2.0, 3.0}) {
    body +=
        fmt::format("G1 X{:.5f} Y10\nG2 X{:.5f} Y10 I{} J0\nG1 X{:.5f} Y0\nG3 X{:.5f} Y0 I{} J0\n",
                    x, x + 2 * r, r, x + 2 * r, x + 4 * r, r);
    x += 4 * r;
  }
  return program(mode, 3000, {0, 0, 0}, body);
}

/// Half circles that meet at reversals of their bend.
inline std::string half_circles(const std::string& mode) {
  std::string body;
  double x = 0.0;
  for (const auto& [first, second] :
       std::array<std::array<double, 2>, 4>{{{5, 5}, {5, 2}, {2, 8}, {8, 1}}}) {
    body += fmt::format("G2 X{:.5f} Y0 I{} J0\n", x + 2 * first, first);
    body += fmt::format("G3 X{:.5f} Y0 I{} J0\n", x + 2 * first + 2 * second, second);
    x += 2 * first + 2 * second;
  }
  return program(mode, 2400, {0, 0, 0}, body);
}

/// Feeds that change where the direction does not.
inline std::string feeds(const std::string& mode) {
  return program(mode, 600, {0, 0, 0},
                 "G1 X5 F600\nG1 X10 F3000\nG1 X15 F1200\nG3 X25 Y10 I0 J10 F2400\nG3 X15 Y20 I-10 "
                 "J0 F900\nG1 X5 F3000\nG1 X0 F300\n");
}

}  // namespace programs

/// What LinuxCNC made of them.
inline std::vector<MeasuredProgram> measured_programs() {
  using namespace programs;
  return {
      {"corners, G61", corners("G61"), 2.690, 29.30, 5.98},
      {"corners, G64", corners("G64"), 2.615, 35.11, 9.37},
      {"corners, G64 P0.02", corners("G64 P0.02"), 2.615, 35.06, 10.14},
      {"lines and arcs, G61", lines_and_arcs("G61"), 3.070, 120.63, 22.56},
      {"lines and arcs, G64", lines_and_arcs("G64"), 2.880, 134.38, 25.11},
      {"lines and arcs, G64 P0.01", lines_and_arcs("G64 P0.01"), 2.882, 134.18, 24.94},
      {"helix, G61", helix("G61"), 4.846, 183.00, 30.39},
      {"helix, G64", helix("G64"), 4.776, 187.88, 31.38},
      {"helix, G64 P0.01", helix("G64 P0.01"), 4.808, 185.31, 30.62},
      {"chords of 0.05 mm, G64", chords("G64", 0.05, 300), 0.548, 97.51, 17.06},
      {"chords of 0.4 mm, G61", chords("G61", 0.4, 126), 3.620, 28.82, 4.35},
      {"chords of 0.4 mm, G64 P0.01", chords("G64 P0.01", 0.4, 126), 1.705, 132.19, 27.50},
      {"chords of 0.4 mm, G64 P0.02 Q0.02", chords("G64 P0.02 Q0.02", 0.4, 126), 1.700, 142.38,
       37.62},
      {"chords of 2.0 mm, G61", chords("G61", 2.0, 25), 2.050, 80.34, 13.01},
      {"star, G61", star("G61"), 3.692, 173.57, 31.18},
      {"star, G64 P0.02", star("G64 P0.02"), 3.669, 178.94, 34.21},
      {"gear, G61", gear("G61"), 5.577, 161.99, 30.28},
      {"gear, G64", gear("G64"), 4.676, 245.92, 72.91},
      {"gear, G64 P0.02", gear("G64 P0.02"), 5.190, 193.61, 44.21},
      {"spiral, G61", spiral("G61"), 6.274, 57.57, 8.65},
      {"spiral, G64 P0.02 Q0.01", spiral("G64 P0.02 Q0.01"), 2.523, 334.37, 64.33},
      {"wave in space, G61", wave_in_space("G61"), 4.543, 29.38, 4.68},
      {"wave in space, G64", wave_in_space("G64"), 1.546, 239.15, 46.87},
      {"wave in space, G64 P0.01 Q0.005", wave_in_space("G64 P0.01 Q0.005"), 1.536, 241.41, 48.51},
      {"pocket, G64", pocket("G64"), 8.551, 276.71, 59.41},
      {"pocket, G64 P0.01", pocket("G64 P0.01"), 8.607, 271.28, 57.96},
      {"slots, G64", slots("G64"), 3.645, 399.59, 109.78},
      {"half circles, G64", half_circles("G64"), 2.887, 310.01, 67.83},
      {"feeds, G64", feeds("G64"), 3.537, 58.59, 10.14},
  };
}

}  // namespace steadyrest::linuxcnc_test
