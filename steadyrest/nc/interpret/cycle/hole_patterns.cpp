// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/nc/interpret/control/smoothing.hpp>
#include <steadyrest/nc/interpret/cycle/call_values.hpp>

// Patterns of holes, which the modal cycle drills, and CYCLE832 (manual "Cycles").
namespace steadyrest::nc::interpret {

using kernel::units::kDegree;
using read::Flow;

namespace {

constexpr double kMostHoles = 1e4;

bool is_count(double number) noexcept {
  return number >= 1.0 && number <= kMostHoles && number == std::floor(number);
}

}  // namespace

bool CycleCalls::hole_at(double first_mm, double second_mm) {
  const PlaneAxes axes = axes_of(state_.plane);
  Axes over = state_.position;
  over[axes.first] = first_mm;
  over[axes.second] = second_mm;
  out_.move(MoveKind::rapid, over);
  return after_move();
}

// HOLES1 (SPCA, SPCO, STA1, FDIS, DBH, NUM): from the reference point along the angle STA1. The
// cycle begins at whichever end of the row is nearer to the tool.
bool CycleCalls::row(const Flow& call) {
  const double count = value(call, 5);
  if (!is_count(count)) {
    return refuse(call, "out_of_range",
                  "the number of holes (NUM) is not valid; allowed: whole numbers from 1 to 10000");
  }
  const PlaneAxes axes = axes_of(state_.plane);
  const double unit = state_.unit_mm;
  const double along_first = std::cos(value(call, 2) * kDegree);
  const double along_second = std::sin(value(call, 2) * kDegree);
  const auto place = [&](double hole) {
    return (std::abs(value(call, 3)) + hole * std::abs(value(call, 4))) * unit;
  };
  const auto distance = [&](double hole) {
    return std::hypot(
        value(call, 0) * unit + place(hole) * along_first - state_.position[axes.first],
        value(call, 1) * unit + place(hole) * along_second - state_.position[axes.second]);
  };
  const bool from_far_end = distance(count - 1.0) < distance(0.0);
  for (double i = 0.0; i < count; i += 1.0) {
    const double at = place(from_far_end ? count - 1.0 - i : i);
    if (!hole_at(value(call, 0) * unit + at * along_first,
                 value(call, 1) * unit + at * along_second)) {
      return false;
    }
  }
  return true;
}

// HOLES2 (CPA, CPO, RAD, STA1, INDA, NUM): on a circle, INDA apart; with 0 all around it.
bool CycleCalls::circle(const Flow& call) {
  const double count = value(call, 5);
  const double radius = value(call, 2);
  if (!is_count(count) || !(radius > 0.0)) {
    return refuse(call, "out_of_range",
                  "the radius (RAD) or the number of holes (NUM) is not valid; allowed: above 0, "
                  "whole numbers from 1 to 10000");
  }
  const double unit = state_.unit_mm;
  const double apart = value(call, 4) != 0.0 ? value(call, 4) : 360.0 / count;
  for (double i = 0.0; i < count; i += 1.0) {
    const double angle = (value(call, 3) + i * apart) * kDegree;
    if (!hole_at((value(call, 0) + radius * std::cos(angle)) * unit,
                 (value(call, 1) + radius * std::sin(angle)) * unit)) {
      return false;
    }
  }
  return true;
}

// CYCLE832 (TOL, mode, OTOL): the last digit of the mode is 0 off, 1 finishing, 2 semi-finishing,
// 3 roughing, 4 precision; with 1 as the digit before it OTOL follows. Further digits choose how
// the control smooths (older versions: path mode, feed-forward, jerk, compressor). Of all that the
// tolerance acts here, as CTOL with rounding and a compressor; Assumptions report the rest. The
// tens of the older versions switch a transformation on.
bool CycleCalls::tolerance(const Flow& call) {
  const double mode = value(call, 1);
  const bool whole = mode >= 0.0 && mode <= 1e7 && mode == std::floor(mode);
  const unsigned digits = whole ? static_cast<unsigned>(mode) : 0U;
  const unsigned machining = digits % 10;
  const unsigned orientation = digits / 10 % 10;
  if (!whole || machining > 4 || orientation > 1 || !(value(call, 0) >= 0.0)) {
    return refuse(
        call, "cycle_value",
        "a tolerance or a mode of CYCLE832 that is not interpreted; allowed: modes ending "
        "in 0 to 4, or in 10 to 14 with an orientation tolerance");
  }
  if (orientation == 1 && !(value(call, 2) > 0.0)) {
    return refuse(call, "transformation",
                  "CYCLE832 with a transformation, or without its orientation tolerance");
  }
  if (!given(call, 1) && given(call, 0) && value(call, 0) != 0.0) {
    return refuse(call, "cycle_word_missing", "CYCLE832 without its mode");
  }
  Smoothing& smoothing = state_.smoothing;
  const bool on = machining != 0;
  smoothing.tolerance_mm = on && value(call, 0) > 0.0 ? value(call, 0) * state_.unit_mm : -1.0;
  smoothing.by_tolerance = on;
  smoothing.compressor = on;
  // Off is what the control begins with.
  state_.path_mode = on ? PathMode::continuous : control_.config.path_mode;
  apply_smoothing(state_);
  return true;
}

}  // namespace steadyrest::nc::interpret
