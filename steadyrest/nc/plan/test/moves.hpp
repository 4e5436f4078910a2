// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/nc/interpret/state/move.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>
#include <steadyrest/nc/plan/time/interpolator.hpp>

/// Hand-made programs and a run of the interpolator over them.
namespace steadyrest::nc::plan::test {

inline kernel::machine::Machine mill(double jerk_mm_s3 = kernel::machine::kUnlimited) {
  kernel::machine::Machine m;
  for (const char* name : {"X", "Y", "Z"}) {
    kernel::machine::Axis axis;
    axis.name = name;
    axis.max_jerk_au_s3 = jerk_mm_s3;
    m.axes.push_back(axis);
  }
  return m;
}

/// Collects moves that start where the last one ended.
struct Program {
  std::vector<interpret::Move> moves;
  interpret::Axes at{};
  interpret::PathMode mode = interpret::PathMode::exact_path;
  double tolerance_mm = 0.0;

  interpret::Move& add(interpret::MoveKind kind, const interpret::Axes& end, double feed_mm_s) {
    interpret::Move m;
    m.kind = kind;
    m.line = static_cast<std::uint32_t>(moves.size() + 1);
    m.start = at;
    m.end = end;
    m.feed_mm_s = feed_mm_s;
    m.path_mode = mode;
    m.path_tolerance_mm = tolerance_mm;
    at = end;
    moves.push_back(m);
    return moves.back();
  }
  interpret::Move& line(double x, double y, double feed_mm_s, double z = 0.0) {
    return add(interpret::MoveKind::linear, {x, y, z}, feed_mm_s);
  }
  interpret::Move& rapid(double x, double y, double z = 0.0) {
    return add(interpret::MoveKind::rapid, {x, y, z}, 0.0);
  }
  interpret::Move& arc(double x, double y, double cx, double cy, int turns, double feed_mm_s,
                       double z = 0.0) {
    const double z0 = at[2];
    auto& m = add(interpret::MoveKind::arc, {x, y, z}, feed_mm_s);
    m.centre_mm = {cx, cy, z0};
    m.normal = {0, 0, 1};
    m.turns = turns;
    return m;
  }
  interpret::Move& dwell(double seconds) {
    auto& m = add(interpret::MoveKind::dwell, at, 0.0);
    m.dwell_s = seconds;
    return m;
  }
};

inline PlannedPath plan_of(const kernel::machine::Machine& machine, const Program& program) {
  PathBuilder builder(machine);
  for (const auto& move : program.moves) {
    builder.on_move(move);
  }
  return builder.take().value();
}

/// All setpoints until the program is finished; `overrides` is asked before each cycle.
template <class F>
std::vector<Setpoint> run(const kernel::machine::Machine& machine, const PlannedPath& path,
                          F&& overrides, std::size_t most = 2000000) {
  auto interpolator = Interpolator::make(machine, whole(path)).value();
  std::vector<Setpoint> out;
  while (out.size() < most) {
    const Setpoint s = interpolator.update(overrides(out.size()));
    if (s.finished) {
      break;
    }
    out.push_back(s);
  }
  return out;
}

inline std::vector<Setpoint> run(const kernel::machine::Machine& machine, const PlannedPath& path) {
  return run(machine, path, [](std::size_t) { return Overrides{}; });
}

}  // namespace steadyrest::nc::plan::test
