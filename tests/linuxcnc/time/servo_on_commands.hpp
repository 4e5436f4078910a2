// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include <tests/linuxcnc/time/timed_programs.hpp>

#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>
#include <steadyrest/nc/plan/path/plan_program.hpp>
#include <steadyrest/nc/plan/time/interpolator.hpp>

/// The contour error that a servo ẋ = k·(c − x) makes of a control's commands, each 1 ms.
namespace steadyrest::linuxcnc_test {

using kernel::signal::Point;

/// The path that the text says, in straight pieces: what cuts, chords within 0.05 µm.
inline std::vector<Point> programmed_path(const std::string& text) {
  auto machine = mill();
  machine.control = {};
  machine.control.blend_share = 0.0;  // no corner is rounded
  const auto path = nc::plan::plan_text(text, {}, machine, "").value();
  std::vector<Point> points;
  for (const auto& s : path.segments) {
    if (s.motion != kernel::signal::Motion::feed) {
      continue;
    }
    const bool arc = s.geometry == kernel::signal::Geometry::arc;
    const double step_rad = arc ? 2.0 * std::sqrt(1e-4 / s.radius_mm) : 1.0;
    const int pieces = arc ? static_cast<int>(std::ceil(s.sweep_rad / step_rad)) : 1;
    if (points.empty()) {
      points.push_back(s.start_mm);
    }
    for (int i = 1; i <= pieces; ++i) {
      points.push_back(math::geometry::point_at(s, static_cast<double>(i) / pieces));
    }
  }
  return points;
}

inline std::vector<Point> planned_commands(const std::string& text) {
  const auto machine = mill();
  const auto path = nc::plan::plan_text(text, {}, machine, "").value();
  auto interpolator = nc::plan::Interpolator::make(machine, nc::plan::whole(path)).value();
  std::vector<Point> out;
  for (;;) {
    const auto setpoint = interpolator.update({});
    if (setpoint.finished) {
      return out;
    }
    out.push_back({setpoint.position[0], setpoint.position[1], setpoint.position[2]});
  }
}

/// The sampler's log: number, in position, speed, line, x, y, z.
inline std::vector<Point> logged_commands(const std::string& log) {
  std::ifstream in(log);
  std::vector<Point> out;
  double number = 0.0;
  double in_position = 0.0;
  double speed = 0.0;
  double line = 0.0;
  Point p{};
  while (in >> number >> in_position >> speed >> line >> p[0] >> p[1] >> p[2]) {
    out.push_back(p);
    in.ignore(1000, '\n');
  }
  return out;
}

/// Distances to a path that is followed in its order.
class Distances {
 public:
  explicit Distances(const std::vector<Point>& path) : path_(path) {}

  double from(const Point& p) {
    double best = 1e9;
    double walked = 0.0;
    std::size_t at = place_;
    for (std::size_t i = place_ > kBack ? place_ - kBack : 0;
         i + 1 < path_.size() && (walked < kAhead_mm || i < place_ + 2); ++i) {
      const Point leg = math::geometry::subtract(path_[i + 1], path_[i]);
      const Point to = math::geometry::subtract(p, path_[i]);
      const double square = math::geometry::dot(leg, leg);
      const double u = std::clamp(math::geometry::dot(to, leg) / square, 0.0, 1.0);
      const double d = math::geometry::norm(math::geometry::add_scaled(to, leg, -u));
      if (d < best) {
        best = d;
        at = i;
      }
      walked += i > place_ ? std::sqrt(square) : 0.0;
    }
    place_ = std::max(place_, at);
    return best;
  }

 private:
  static constexpr std::size_t kBack = 40;
  static constexpr double kAhead_mm = 3.0;
  const std::vector<Point>& path_;
  std::size_t place_ = 0;
};

struct Cut {
  double seconds = 0.0;
  double rms_k20_um = 0.0;
  double rms_k50_um = 0.0;
};

inline double rms_um(const std::vector<Point>& commands, const std::vector<Point>& path,
                     std::size_t first, std::size_t last, double gain_1_s) {
  const double keep = std::exp(-gain_1_s * 0.001);
  Distances distances(path);
  Point at = commands.front();
  double sum = 0.0;
  for (std::size_t i = 0; i < last; ++i) {
    if (i >= first) {
      const double d = distances.from(at);
      sum += d * d;
    }
    const Point& command = commands[std::min(i, commands.size() - 1)];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      at[axis] = command[axis] + (at[axis] - command[axis]) * keep;
    }
  }
  return 1e3 * std::sqrt(sum / static_cast<double>(last - first));
}

/// From the first rest at the start of the cut to the last motion, and 150 ms more for the error.
inline Cut cut_by(const std::vector<Point>& commands, const std::vector<Point>& path) {
  constexpr double kThere_mm = 2e-3;
  const auto there = [&](const Point& p) {
    return math::geometry::distance(p, path.front()) < kThere_mm;
  };
  const auto begin = std::find_if(commands.begin(), commands.end(), there);
  const auto leaves = std::find_if_not(begin, commands.end(), there);
  auto last = commands.end() - 1;
  while (last != leaves && *last == *(last - 1)) {
    --last;
  }
  const auto first_index = static_cast<std::size_t>(leaves - commands.begin()) - 1;
  const auto last_index = static_cast<std::size_t>(last - commands.begin());
  Cut cut;
  cut.seconds = 0.001 * static_cast<double>(last_index - first_index);
  cut.rms_k20_um = rms_um(commands, path, first_index, last_index + 150, 20.0);
  cut.rms_k50_um = rms_um(commands, path, first_index, last_index + 150, 50.0);
  return cut;
}

}  // namespace steadyrest::linuxcnc_test
