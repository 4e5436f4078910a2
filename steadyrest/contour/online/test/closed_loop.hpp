// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <functional>
#include <limits>
#include <vector>

#include <steadyrest/contour/online/feed_governor.hpp>
#include <steadyrest/kernel/override/table.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>

/// A small machine for tests, written independently of what it tests: a control with look-ahead and
/// trapezoidal speed, an override that is slewed, quantised, scanned and delayed, and axes
/// integrated finely from their differential equation.
namespace steadyrest::contour::online::test {

using kernel::machine::Machine;
using kernel::signal::Frame;
using kernel::signal::PathSegment;
using kernel::signal::PathView;
using kernel::signal::Point;

inline std::vector<double> siemens_23() {
  std::vector<double> table{0,    0.01, 0.02, 0.04, 0.06, 0.08, 0.10, 0.20, 0.30, 0.40, 0.50, 0.60,
                            0.70, 0.75, 0.80, 0.85, 0.90, 0.95, 1.00, 1.05, 1.10, 1.15, 1.20};
  return table;
}
inline std::vector<double> dmg_31() {
  return {0,    0.005, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07, 0.08, 0.09,
          0.10, 0.15,  0.20, 0.30, 0.40, 0.50, 0.60, 0.70, 0.75, 0.80, 0.85,
          0.90, 0.95,  1.00, 1.05, 1.10, 1.15, 1.20, 1.30, 1.50};
}

inline Machine mill(double gain_1_s = 50.0) {
  Machine machine;
  machine.axes.resize(3);
  const char* names[] = {"X", "Y", "Z"};
  for (std::size_t i = 0; i < 3; ++i) {
    machine.axes[i].name = names[i];
    machine.axes[i].servo_gain_1_s = gain_1_s;
    machine.axes[i].encoder.count_au = 0.0001;
  }
  machine.feed_override.ratio = siemens_23();
  machine.feed_override.scan_period_s = 0.010;
  machine.feed_override.dead_time_s = 0.030;
  return machine;
}

struct LoopSample {
  double time_s = 0.0;
  double error_mm = 0.0;  ///< true, of the axes without encoder
  double effective = 1.0;
  double requested = 1.0;
  double speed_mm_s = 0.0;
  double position_mm = 0.0;
  bool cutting = false;
  FeedGovernor::Output output;
};

struct LoopResult {
  std::vector<LoopSample> sample;
  double cycle_time_s = 0.0;
  double largest_mm = 0.0;
  double over_limit_share = 0.0;
  int changes = 0;
};

class ClosedLoop {
 public:
  /// `machine` is the true one; `passport` what the governor believes.
  ClosedLoop(const Machine& machine, const Machine& passport, PathView path)
      : machine_(machine),
        path_(path),
        governor_(FeedGovernor::make(passport).value()),
        truth_(
            ContourError::make({.servo_gain_1_s = machine.axes[0].servo_gain_1_s * 0.8}).value()) {
    period_ = machine.control.interpolator_period_s;
    for (std::size_t i = 0; i < 3; ++i) {
      x_[i] = path.front().start_mm[i];
    }
  }
  ClosedLoop(const Machine& machine, PathView path) : ClosedLoop(machine, machine, path) {}

  bool with_layer = true;
  bool show_path = true;
  bool offsets_act = false;  ///< for the governor alone: no axis is moved by one
  double panel = 1.0;
  double fixed_ratio = 1.0;
  std::function<void(Frame&)> disturb;

  [[nodiscard]] bool done() const {
    const PathSegment& last = path_.back();
    return s_ >= last.position_mm + last.length_mm - 1e-3 && speed_ < 0.1;
  }
  FeedGovernor& governor() { return governor_; }
  /// The last ratio told to the override, as the envelope would hand it down.
  [[nodiscard]] kernel::signal::InForce in_force() const {
    return {
        .feed = {.ratio = slewed_, .word_ratio = word_}, .active = offsets_act, .written = true};
  }

  LoopSample step() {
    override_step();
    speed_step();
    axes_step();
    time_ += period_;
    Frame frame = make_frame();
    if (disturb) {
      disturb(frame);
    }
    LoopSample sample;
    if (with_layer) {
      sample.output = governor_.update(frame, in_force());
      request_ = sample.output.request.ratio;
      wishes_ = sample.output.request.ratio < 1.0 ||
                static_cast<unsigned>(sample.output.request.reason) >= 200;
    }
    ContourError::Input input = contour_input(frame);
    input.path = path_;
    input.path_index = index_;
    input.command_mm = command_;
    input.actual_mm = x_;
    sample.error_mm = truth_.update(input).error_mm;
    sample.time_s = time_;
    sample.effective = effective_;
    sample.requested = request_;
    sample.speed_mm_s = speed_;
    sample.position_mm = s_;
    sample.cutting = path_[index_].motion == kernel::signal::Motion::feed;
    return sample;
  }

  LoopResult run(double limit_mm, double from_s = 0.0, double max_s = 1e9) {
    LoopResult result;
    std::size_t over = 0;
    std::size_t counted = 0;
    double before = effective_;
    while (!done() && time_ < max_s) {
      result.sample.push_back(step());
      const LoopSample& s = result.sample.back();
      if (s.time_s >= from_s && s.cutting) {
        ++counted;
        over += std::abs(s.error_mm) > limit_mm ? 1 : 0;
        result.largest_mm = std::max(result.largest_mm, std::abs(s.error_mm));
        result.changes += s.effective != before ? 1 : 0;
      }
      before = s.effective;
    }
    result.cycle_time_s = time_;
    result.over_limit_share =
        counted > 0 ? static_cast<double>(over) / static_cast<double>(counted) : 0.0;
    return result;
  }

 private:
  void override_step() {
    const auto& envelope = machine_.envelope;
    const double target = !with_layer ? fixed_ratio : wishes_ ? std::min(request_, panel) : panel;
    slewed_ = std::clamp(target, slewed_ - envelope.feed_fall_1_s * period_,
                         slewed_ + envelope.feed_rise_1_s * period_);
    slewed_ = with_layer ? std::min(slewed_, panel) : slewed_;
    word_ = panel;
    if (wishes_ || !with_layer) {
      word_ = 0.0;
      for (const double ratio : machine_.feed_override.ratio) {
        word_ = ratio <= slewed_ + 1e-9 ? ratio : word_;
      }
    }
    if (time_ + 1e-12 >= next_scan_) {
      pipeline_.push_back({time_ + machine_.feed_override.dead_time_s, word_});
      next_scan_ += machine_.feed_override.scan_period_s;
    }
    while (!pipeline_.empty() && pipeline_.front().time <= time_ + 1e-12) {
      effective_ = pipeline_.front().ratio;
      pipeline_.pop_front();
    }
  }

  [[nodiscard]] double target_of(const PathSegment& segment) const {
    const bool cutting = segment.motion == kernel::signal::Motion::feed;
    return std::min(segment.feed_mm_s * (cutting ? effective_ : 1.0), segment.speed_limit_mm_s);
  }

  void speed_step() {
    const double a = machine_.axes[0].max_acceleration_au_s2;
    const double goal = target_of(path_[index_]);
    double next =
        speed_ < goal ? std::min(goal, speed_ + a * period_) : std::max(goal, speed_ - a * period_);
    double bound = std::numeric_limits<double>::infinity();
    for (std::size_t i = index_; i < path_.size(); ++i) {
      const double left =
          path_[i].position_mm + path_[i].length_mm - s_ - 0.5 * (speed_ + next) * period_;
      const double joint = i + 1 < path_.size()
                               ? std::min(path_[i].exit_speed_limit_mm_s, target_of(path_[i + 1]))
                               : 0.0;
      bound = std::min(bound, std::sqrt(joint * joint + 2.0 * a * std::max(0.0, left)));
      if (left > next * next / (2.0 * a) + 1.0) {
        break;
      }
    }
    next = std::max(std::min(next, bound), std::max(0.0, speed_ - 1.5 * a * period_));
    s_ += std::max(0.5 * (speed_ + next) * period_, 1e-7);
    speed_ = next;
    while (index_ + 1 < path_.size() && s_ >= path_[index_ + 1].position_mm) {
      ++index_;
    }
    const PathSegment& last = path_.back();
    s_ = std::min(s_, last.position_mm + last.length_mm);
  }

  void axes_step() {
    const Point target = math::geometry::point_at(
        path_[index_], math::geometry::parameter_at(path_[index_], s_ - path_[index_].position_mm));
    constexpr int kSub = 8;
    const double h = period_ / kSub;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& axis = machine_.axes[i];
      const double rate = first_ ? 0.0 : (target[i] - command_[i]) / period_;
      // Slope of the commanded velocity: parabola through the last three commanded points.
      const double bend = first_ ? 0.0 : (rate - rate_[i]) / period_;
      for (int n = 0; n < kSub; ++n) {
        const double tm = h * (n + 0.5) - period_;
        const double c = target[i] + rate * tm + 0.5 * bend * tm * (tm + period_);
        const double dc = rate + bend * (tm + 0.5 * period_);
        if (axis.velocity_lag_s < 1e-4) {
          const double goal = c + axis.feed_forward * dc / axis.servo_gain_1_s;
          x_[i] += (goal - x_[i]) * -std::expm1(-axis.servo_gain_1_s * h);
        } else {
          const double wish = axis.servo_gain_1_s * (c - x_[i]) + axis.feed_forward * dc;
          const double v = v_[i];
          v_[i] += (wish - v) * -std::expm1(-h / axis.velocity_lag_s);
          x_[i] += 0.5 * (v + v_[i]) * h;
        }
      }
      rate_[i] = rate;
    }
    command_ = target;
    first_ = false;
  }

  [[nodiscard]] Frame make_frame() const {
    Frame frame;
    frame.time_s = time_;
    for (std::size_t i = 0; i < 3; ++i) {
      const double count = machine_.axes[i].encoder.count_au;
      const double read = count > 0.0 ? std::round(x_[i] / count) * count : x_[i];
      frame.axis[i] = {command_[i], read, command_[i] - read};
    }
    frame.feed = {panel, effective_, 0, true};
    const PathSegment& segment = path_[index_];
    frame.motion = segment.motion;
    frame.program_line = segment.line;
    frame.programmed_feed_mm_s = segment.feed_mm_s;
    frame.path_speed_mm_s = speed_;
    if (show_path) {
      frame.path = path_;
      frame.path_index = index_;
    }
    frame.path_position_mm = s_;
    return frame;
  }

  struct Word {
    double time;
    double ratio;
  };

  Machine machine_;
  PathView path_;
  FeedGovernor governor_;
  ContourError truth_;
  double period_ = 0.001;
  double time_ = 0.0;
  double s_ = 0.0;
  double speed_ = 0.0;
  std::size_t index_ = 0;
  Point command_{};
  Point x_{};
  Point v_{};
  Point rate_{};
  bool first_ = true;
  double request_ = 1.0;
  bool wishes_ = false;
  double slewed_ = 1.0;
  double word_ = 1.0;
  double effective_ = 1.0;
  double next_scan_ = 0.0;
  std::deque<Word> pipeline_;
};

}  // namespace steadyrest::contour::online::test
