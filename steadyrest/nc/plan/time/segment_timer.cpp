// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/plan/path/limits.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>
#include <steadyrest/nc/plan/time/interpolator.hpp>
#include <steadyrest/nc/plan/time/program_timer.hpp>
#include <steadyrest/nc/plan/time/segment_timer.hpp>
#include <steadyrest/nc/plan/time/spindle_clock.hpp>

namespace steadyrest::nc::plan {

using kernel::machine::Machine;
using kernel::outcome::refuse;
using kernel::outcome::Result;
using kernel::signal::PathSegment;

namespace {

/// S is rebased before its rounding reaches the square of a slow junction's speed.
constexpr double kMostSum = 1e9;
constexpr double kWholePeriod = 1e-6;

struct Stretch {
  double length_mm = 0.0;
  double acceleration_mm_s2 = 0.0;
  double target_mm_s = 0.0;  ///< feed per revolution: at the commanded speed
  double feed_mm = 0.0;      ///< per revolution; 0 = not per revolution
  double speed_limit_mm_s = 0.0;
  double spindle_rev_s = 0.0;  ///< commanded by G96 from here on; 0 = no change
  double exit_limit_mm_s = 0.0;
  double sum = 0.0;  ///< S at its end
  std::uint32_t line = 0;
  kernel::signal::Motion motion = kernel::signal::Motion::rapid;
};

}  // namespace

/// The window of segments, the sliding minimum over it, and the time up to the current segment.
class SegmentTimer::Runner final : public PathReceiver {
 public:
  explicit Runner(const Machine& machine)
      : stream(machine, *this),
        period_s_(machine.control.interpolator_period_s),
        tool_change_s_(machine.control.tool_change_s),
        blocks_(std::min<std::size_t>(machine.control.look_ahead_blocks, 1U << 16U)),
        spindle_(machine.spindle),
        window_(std::bit_ceil(blocks_ + 2)),
        lowest_(window_.size()) {}

  // A junction limit needs the target after it, so the successor closes a segment; it is timed once
  // the look-ahead is full or an event stops the path.
  void on_segment(const PathSegment& segment, const SegmentPlan& plan) override {
    if (plan.spindle_rev_s != 0.0) {
      planned_spindle_rev_s_ = plan.spindle_rev_s;
    }
    double target = plan.feed_mm_s;
    if (plan.per_revolution) {
      target *= std::abs(planned_spindle_rev_s_);
    }
    target = std::min(target, plan.speed_limit_mm_s);
    if (end_ > begin_) {
      close(target);
    }
    sum_ += 2.0 * plan.acceleration_mm_s2 * plan.length_mm;
    at(end_) = {.length_mm = plan.length_mm,
                .acceleration_mm_s2 = plan.acceleration_mm_s2,
                .target_mm_s = target,
                .feed_mm = plan.per_revolution ? plan.feed_mm_s : 0.0,
                .speed_limit_mm_s = plan.speed_limit_mm_s,
                .spindle_rev_s = plan.spindle_rev_s,
                .exit_limit_mm_s = plan.exit_speed_limit_mm_s,
                .sum = sum_,
                .line = segment.line,
                .motion = segment.motion};
    ++end_;
    if (end_ - begin_ >= blocks_) {
      pass();
    }
  }

  void on_event(const PathEvent& event) override {
    drain();
    switch (event.kind) {
      case PathEventKind::dwell:
        wait(event, event.value);
        break;
      case PathEventKind::tool_change:
        tool_ = static_cast<std::int64_t>(event.value);
        wait(event, tool_change_s_);
        break;
      case PathEventKind::spindle:
        command(event.value);
        planned_spindle_rev_s_ = event.value;
        break;
      case PathEventKind::spindle_wait:
        // wait() rounds to the nearest period. The interpolator checks once a period whether the
        // speed is reached, which rounds up: half a period more.
        wait(event, spindle_.seconds_to_speed() + 0.5 * period_s_);
        break;
      case PathEventKind::coolant:
        coolant_ = event.value != 0.0;
        break;
      case PathEventKind::stop:
      case PathEventKind::end:
        break;
    }
  }

  void finish() {
    stream.finish();
    drain();
  }

  [[nodiscard]] double time_s() const noexcept { return time_s_; }
  [[nodiscard]] const std::vector<Transition>& cyclogram() const noexcept {
    return cyclogram_.transitions();
  }

  PathStream stream;
  Arrival arrival;
  std::optional<ProgramTimer> stepper;  ///< instead of all this, where the jerk is limited

 private:
  Stretch& at(std::size_t i) noexcept { return window_[i & (window_.size() - 1)]; }
  std::size_t& lowest(std::size_t i) noexcept { return lowest_[i & (lowest_.size() - 1)]; }

  /// Puts the last segment's junction limit, now known, into the sliding minimum.
  void close(double next_target_mm_s) noexcept {
    Stretch& last = at(end_ - 1);
    const double c =
        std::min({last.exit_limit_mm_s, last.target_mm_s, std::max(next_target_mm_s, 0.0)});
    last.exit_limit_mm_s = c;
    // c² + S, comparable over the whole window because S grows by 2aℓ per segment: S_i is taken off
    // at the end.
    const double value = c * c + last.sum;
    // Sliding minimum: a later, lower value makes earlier ones meaningless, so each enters and
    // leaves once.
    while (lowest_end_ != lowest_begin_ && value_of(lowest(lowest_end_ - 1)) >= value) {
      --lowest_end_;
    }
    lowest(lowest_end_++) = end_ - 1;
  }

  [[nodiscard]] double value_of(std::size_t i) noexcept {
    const Stretch& s = at(i);
    return s.exit_limit_mm_s * s.exit_limit_mm_s + s.sum;
  }

  /// Passes the first segment of the window.
  void pass() {
    while (lowest_begin_ != lowest_end_ && lowest(lowest_begin_) < begin_) {
      ++lowest_begin_;
    }
    const Stretch& s = at(begin_);
    double w = at(end_ - 1).sum;  // the window ends in a stop
    if (lowest_begin_ != lowest_end_) {
      w = std::min(w, value_of(lowest(lowest_begin_)));
    }
    go(s, std::max(0.0, w - s.sum));
    ++begin_;
    if (sum_ > kMostSum) {
      count_anew();
    }
  }

  // Only differences of S count. Near 1e9 mm²/s² too few digits would be left for c².
  void count_anew() noexcept {
    const double taken = begin_ > 0 ? at(begin_ - 1).sum : 0.0;
    for (std::size_t i = begin_; i < end_; ++i) {
      at(i).sum -= taken;
    }
    sum_ -= taken;
  }

  void go(const Stretch& s, double exit_square) {
    if (arrival && s.line != line_) {
      line_ = s.line;
      arrival(s.line, time_s_);
    }
    if (s.spindle_rev_s != 0.0) {
      command(s.spindle_rev_s);
    }
    const double from_s = time_s_;
    double length = s.length_mm;
    double target = s.target_mm_s;
    if (s.feed_mm > 0.0) {
      target = follow_spindle(s, length);
    }
    const double a2 = 2.0 * s.acceleration_mm_s2 * length;
    const double in = std::min(speed_mm_s_, target);
    const double in_square = in * in;
    const double out_square = std::min(exit_square, in_square + a2);
    // Where accelerating from v_in meets braking to v_out, or the target.
    const double peak_square = std::min(target * target, 0.5 * (in_square + out_square + a2));
    // No root without a change: its rounding would turn a constant speed into a ramp.
    const double out = out_square == in_square ? in : std::sqrt(out_square);
    const double peak = std::max({std::sqrt(peak_square), in, out});
    double seconds = length / peak;
    if (peak > in || peak > out) {
      const double ramps =
          (2.0 * peak * peak - in_square - out_square) / (2.0 * s.acceleration_mm_s2);
      seconds =
          (2.0 * peak - in - out) / s.acceleration_mm_s2 + std::max(0.0, length - ramps) / peak;
    }
    if (length > 0.0) {
      advance(seconds);
    }
    speed_mm_s_ = out;
    if (s.exit_limit_mm_s <= 0.0) {
      stand();
    }
    account(s.motion, s.line, from_s, s.length_mm);
  }

  void command(double speed_rev_s) noexcept {
    spindle_.command(speed_rev_s);
    commanded_rev_s_ = speed_rev_s;
  }

  /// Accounts for the time since `from_s`, over `length_mm` of path.
  void account(kernel::signal::Motion motion, std::uint32_t line, double from_s, double length_mm) {
    const double seconds = time_s_ - from_s;
    if (seconds > 0.0) {
      done_.motion = motion;
      done_.line = line;
      done_.spindle_rev_s = commanded_rev_s_;
      done_.coolant = coolant_;
      done_.path_speed_mm_s = length_mm / seconds;
      cyclogram_.add(done_, tool_, from_s, seconds);
    }
  }

  /// While the spindle ramps, a feed per revolution follows it; returns the target afterwards.
  double follow_spindle(const Stretch& s, double& length_mm) {
    // Period by period: the spindle's ramp and the limits of the axes have no common closed form.
    while (spindle_.ramps() && length_mm > 0.0 && time_s_ < ProgramTimer::kMost_s) {
      const double v = std::min(s.feed_mm * std::abs(spindle_.speed_rev_s()), s.speed_limit_mm_s);
      const double step = std::min(length_mm, v * period_s_);
      advance(v > 0.0 ? step / v : period_s_);
      length_mm -= step;
      speed_mm_s_ = v;
    }
    return std::min(s.feed_mm * std::abs(spindle_.speed_rev_s()), s.speed_limit_mm_s);
  }

  void advance(double seconds) noexcept {
    time_s_ += seconds;
    spindle_.advance(seconds);
  }

  /// The path has stopped: the rest of this period is lost.
  void stand() noexcept {
    speed_mm_s_ = 0.0;
    const double periods = (time_s_ - stood_s_) / period_s_;
    // The interpolator stops at the end of a period; what is left of it is lost.
    const double whole_s = stood_s_ + std::ceil(periods - kWholePeriod) * period_s_;
    advance(std::max(0.0, whole_s - time_s_));
    stood_s_ = time_s_;
  }

  void wait(const PathEvent& event, double seconds) {
    // As the interpolator counts: to the nearest period.
    const double periods = std::ceil(seconds / period_s_ - 0.5 - kWholePeriod);
    if (!(periods > 0.0)) {
      return;
    }
    if (arrival) {
      line_ = event.line;
      arrival(event.line, time_s_);
    }
    const double from_s = time_s_;
    advance(std::min(periods * period_s_, 2.0 * ProgramTimer::kMost_s));
    stood_s_ = time_s_;
    account(kernel::signal::Motion::dwell, event.line, from_s, 0.0);
  }

  /// The known path ends in a stop.
  void drain() {
    if (end_ > begin_) {
      at(end_ - 1).exit_limit_mm_s = 0.0;
      close(0.0);
    }
    while (begin_ < end_) {
      pass();
    }
    lowest_begin_ = lowest_end_;
  }

  double period_s_;
  double tool_change_s_;
  std::size_t blocks_;
  SpindleClock spindle_;
  double planned_spindle_rev_s_ = 0.0;

  std::vector<Stretch> window_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  double sum_ = 0.0;
  std::vector<std::size_t> lowest_;  ///< segments whose value no later one undercuts
  std::size_t lowest_begin_ = 0;
  std::size_t lowest_end_ = 0;

  Cyclogram cyclogram_;
  Setpoint done_;  ///< for the cyclogram; its other fields stay unchanged
  std::int64_t tool_ = 0;
  double commanded_rev_s_ = 0.0;
  bool coolant_ = false;
  double time_s_ = 0.0;
  double stood_s_ = 0.0;
  double speed_mm_s_ = 0.0;
  std::uint32_t line_ = 0;
};

Result<SegmentTimer> SegmentTimer::make(const Machine& machine) {
  // Only for its refusals: what it refuses is not timed either.
  if (auto possible = Interpolator::make(machine, PathWindow{}); !possible) {
    return std::unexpected(possible.error());
  }
  auto runner = std::make_unique<Runner>(machine);
  if (PathLimits(machine.axes, machine.control).jerk_time_s() >
      machine.control.interpolator_period_s) {
    auto stepper = ProgramTimer::make(machine);
    if (!stepper) {
      return std::unexpected(stepper.error());
    }
    runner->stepper.emplace(std::move(*stepper));
  }
  return SegmentTimer(std::move(runner));
}

SegmentTimer::SegmentTimer(std::unique_ptr<Runner> runner) : runner_(std::move(runner)) {}
SegmentTimer::SegmentTimer(SegmentTimer&& other) noexcept : runner_(std::move(other.runner_)) {}
SegmentTimer::~SegmentTimer() = default;

void SegmentTimer::on_move(const interpret::Move& move) {
  if (runner_->stepper) {
    runner_->stepper->on_move(move);
  } else {
    runner_->stream.on_move(move);
  }
}

void SegmentTimer::on_event(const interpret::Event& event) {
  if (runner_->stepper) {
    runner_->stepper->on_event(event);
  } else {
    runner_->stream.on_event(event);
  }
}

void SegmentTimer::set_arrival(Arrival arrival) {
  if (runner_->stepper) {
    runner_->stepper->set_arrival(std::move(arrival));
  } else {
    runner_->arrival = std::move(arrival);
  }
}

Result<SegmentTimer::Timed> SegmentTimer::take_cyclogram() {
  if (runner_->stepper) {
    auto time = runner_->stepper->take();
    return time ? Result<Timed>(Timed{time->total_s, std::move(time->cyclogram)})
                : std::unexpected(time.error());
  }
  runner_->finish();
  if (runner_->stream.refusal()) {
    return std::unexpected(*runner_->stream.refusal());
  }
  if (!(runner_->time_s() <= ProgramTimer::kMost_s)) {
    return refuse("the program takes longer than 30 days",
                  "look for a feed or a dwell in the wrong unit");
  }
  return Timed{runner_->time_s(), runner_->cyclogram()};
}

Result<double> SegmentTimer::take() {
  const auto timed = take_cyclogram();
  return timed ? Result<double>(timed->total_s) : std::unexpected(timed.error());
}

}  // namespace steadyrest::nc::plan
