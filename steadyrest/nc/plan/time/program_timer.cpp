// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>
#include <steadyrest/nc/plan/time/interpolator.hpp>
#include <steadyrest/nc/plan/time/program_timer.hpp>
#include <steadyrest/nc/plan/time/spindle_clock.hpp>

namespace steadyrest::nc::plan {

using kernel::machine::Machine;
using kernel::outcome::refuse;
using kernel::outcome::Result;
using kernel::signal::Motion;
using kernel::signal::PathSegment;

namespace {
// The planned path passes through rings that hold what the interpolator may still read, so memory
// does not grow with the program. A full ring makes the interpolator run until there is room.

constexpr std::size_t kSpare = 1024;  ///< segments between the averaged position and the lead
constexpr std::size_t kEvents = 256;
}  // namespace

/// The rings of the window, the interpolator over them, and the account of its periods.
class ProgramTimer::Runner final : public PathReceiver {
 public:
  explicit Runner(const Machine& machine)
      : stream(machine, *this),
        machine_(machine),
        segments_(std::bit_ceil(machine.control.look_ahead_blocks + kSpare)),
        plans_(segments_.size()),
        events_(kEvents),
        spindle_(machine.spindle) {
    time.tools.push_back({});
  }

  Result<void> start() {
    PathWindow window;
    window.segments = segments_.data();
    window.plans = plans_.data();
    window.events = events_.data();
    window.mask = segments_.size() - 1;
    window.event_mask = events_.size() - 1;
    window.complete = false;
    auto made = Interpolator::make(machine_, window);
    if (!made) {
      return std::unexpected(made.error());
    }
    interpolator_.emplace(std::move(*made));
    return {};
  }

  void on_segment(const PathSegment& segment, const SegmentPlan& plan) override {
    // The ring is full: the interpolator runs until it releases the oldest segment.
    while (end_ - interpolator_->first_segment_in_use() >= segments_.size() - 1 && !stuck()) {
      step();
    }
    segments_[end_ & (segments_.size() - 1)] = segment;
    plans_[end_ & (plans_.size() - 1)] = plan;
    (plan.rapid ? time.rapid_mm : time.cut_mm) += segment.length_mm;
    ++end_;
    interpolator_->extend(end_, event_end_, false);
  }

  void on_event(const PathEvent& event) override {
    while (event_end_ - interpolator_->first_event_in_use() >= events_.size() - 1 && !stuck()) {
      step();
    }
    events_[event_end_ & (events_.size() - 1)] = event;
    ++event_end_;
    interpolator_->extend(end_, event_end_, false);
  }

  void finish() {
    stream.finish();
    interpolator_->extend(end_, event_end_, true);
    while (!interpolator_->finished() && !stuck()) {
      step();
    }
    time.cyclogram = cyclogram_.transitions();
  }

  // A feed far too low would keep the loops above busy forever.
  [[nodiscard]] bool stuck() const { return time.total_s > kMost_s; }
  [[nodiscard]] std::uint32_t line_in_hand() const { return line_; }

  PathStream stream;
  ProgramTime time;
  Arrival arrival;
  Overrides overrides;

 private:
  // One interpolator period, and those after it that are like it, with a spindle as simple as the
  // drive's ramp.
  void step() {
    const double period = machine_.control.interpolator_period_s;
    const std::size_t event = interpolator_->first_event_in_use();
    const Overrides now{overrides.feed_ratio, overrides.rapid_ratio, spindle_.speed_rev_s(),
                        overrides.spindle_ratio};
    const Setpoint s = interpolator_->update(now);
    if (s.finished) {
      return;
    }
    // The spindle follows its command, so that waits and feeds per revolution take their time.
    spindle_.command(s.spindle_rev_s * overrides.spindle_ratio);
    const bool steady = !spindle_.ramps();
    spindle_.advance(period);
    for (std::size_t i = event; i < event_end_; ++i) {  // the current change, and those just passed
      const PathEvent& e = events_[i & (events_.size() - 1)];
      const bool passed = i < interpolator_->first_event_in_use();
      const bool in_hand =
          i == interpolator_->first_event_in_use() && s.motion == Motion::tool_change;
      if (!passed && !in_hand) {
        break;
      }
      // The new tool counts from the first period of its change.
      if (e.kind == PathEventKind::tool_change && i >= tools_seen_) {
        time.tools.push_back({static_cast<std::int64_t>(e.value), 0.0});
        tools_seen_ = i + 1;
      }
    }
    // A starved period waits for the reader, not for the machine: it is not machine time.
    if (!interpolator_->starved()) {
      account(s, period);
      if (const std::size_t alike = steady ? interpolator_->pass_alike() : 0; alike > 0) {
        account(s, period * static_cast<double>(alike));
      }
    }
  }

  void account(const Setpoint& s, double period) {
    if (s.line != line_) {
      line_ = s.line;
      if (arrival) {
        arrival(s.line, time.total_s);
      }
    }
    // The cyclogram feeds the thermal forecast: the spindle as it really turns. The path speed
    // already includes the feed override.
    Setpoint in_force = s;
    in_force.spindle_rev_s *= overrides.spindle_ratio;
    cyclogram_.add(in_force, time.tools.back().number, time.total_s, period);
    time.total_s += period;
    time.tools.back().seconds += period;
    // Callers that want arrivals do not need the seconds by line, a table as long as the program.
    if (!arrival) {
      if (s.line >= time.line_s.size()) {
        time.line_s.resize(s.line + 1U, 0.0);
      }
      time.line_s[s.line] += period;
    }
    switch (s.motion) {
      case Motion::rapid:
        time.rapid_s += period;
        break;
      case Motion::dwell:
        time.dwell_s += period;
        break;
      case Motion::tool_change:
        time.tool_change_s += period;
        break;
      case Motion::spindle_wait:
        time.spindle_wait_s += period;
        break;
      default:
        time.cut_s += period;
    }
  }

  const Machine& machine_;
  std::vector<PathSegment> segments_;
  std::vector<SegmentPlan> plans_;
  std::vector<PathEvent> events_;
  std::optional<Interpolator> interpolator_;
  std::size_t end_ = 0;
  std::size_t event_end_ = 0;
  std::size_t tools_seen_ = 0;
  Cyclogram cyclogram_;
  SpindleClock spindle_;
  std::uint32_t line_ = 0;
};

Result<ProgramTimer> ProgramTimer::make(const Machine& machine) {
  auto runner = std::make_unique<Runner>(machine);
  if (auto started = runner->start(); !started) {
    return std::unexpected(started.error());
  }
  return ProgramTimer(std::move(runner));
}

ProgramTimer::ProgramTimer(std::unique_ptr<Runner> runner) : runner_(std::move(runner)) {}
ProgramTimer::ProgramTimer(ProgramTimer&& other) noexcept : runner_(std::move(other.runner_)) {}
ProgramTimer::~ProgramTimer() = default;

void ProgramTimer::on_move(const interpret::Move& move) {
  ++runner_->time.moves;
  runner_->stream.on_move(move);
}

void ProgramTimer::on_event(const interpret::Event& event) {
  runner_->stream.on_event(event);
}

void ProgramTimer::set_arrival(Arrival arrival) {
  runner_->arrival = std::move(arrival);
}

void ProgramTimer::set_overrides(double feed_ratio, double rapid_ratio, double spindle_ratio) {
  runner_->overrides.feed_ratio = feed_ratio;
  runner_->overrides.rapid_ratio = rapid_ratio;
  runner_->overrides.spindle_ratio = spindle_ratio;
}

Result<ProgramTime> ProgramTimer::take() {
  runner_->finish();
  if (runner_->stream.refusal()) {
    return std::unexpected(*runner_->stream.refusal());
  }
  if (runner_->stuck()) {
    return refuse("", runner_->line_in_hand(), "the program takes longer than 30 days up to here",
                  "look for a feed or a dwell in the wrong unit");
  }
  ProgramTime& time = runner_->time;
  // The program began with a tool change: nothing was done with the tool before it.
  if (time.tools.size() > 1 && time.tools.front().seconds == 0.0) {
    time.tools.erase(time.tools.begin());
  }
  return std::move(time);
}

}  // namespace steadyrest::nc::plan
