// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <utility>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/rewrite/walk/clock.hpp>

namespace steadyrest::nc::rewrite {

using kernel::outcome::Result;

// A place asks for its time before its line's moves are fed; the timer, which looks ahead, answers
// later. For that, moves and events get running numbers, since lines repeat in loops.
Result<std::unique_ptr<Clock>> Clock::make(const kernel::machine::Machine& machine, Told told) {
  auto timer = plan::SegmentTimer::make(machine);
  if (!timer) {
    return std::unexpected(timer.error());
  }
  std::unique_ptr<Clock> made(new Clock(std::move(told)));
  made->timer_.emplace(std::move(*timer));
  made->timer_->set_arrival([clock = made.get()](std::uint32_t sequence, double time_s) {
    clock->arrived(sequence, time_s);
  });
  return made;
}

std::unique_ptr<Clock> Clock::of(const KnownTimes& known, Told told) {
  std::unique_ptr<Clock> made(new Clock(std::move(told)));
  made->known_ = &known;
  return made;
}

void Clock::arrived(std::uint32_t sequence, double time_s) {
  // A block that takes no time is reached with the next move.
  while (!asked_.empty() && asked_.front().sequence <= sequence) {
    told_(asked_.front().ticket, time_s);
    asked_.pop_front();
  }
}

void Clock::tell(const Walk& walk) {
  // Known times come from a walk over the same file just before (README, "Limits").
  for (; !asked_.empty(); asked_.pop_front()) {
    const auto at = known_->line_s.find(walk.line());
    if (at != known_->line_s.end()) {
      told_(asked_.front().ticket, at->second);
    } else {
      unknown_line_ = walk.line();
    }
  }
}

// A block's events come before its moves, except a stop and the program's end.
void Clock::feed(Walk& walk) {
  if (known_ != nullptr) {
    tell(walk);
    return;
  }
  for (interpret::Event event : walk.events()) {
    if (event.kind != interpret::EventKind::end && event.kind != interpret::EventKind::stop) {
      event.line = ++sequence_;
      timer_->on_event(event);
    }
  }
  for (interpret::Move& move : walk.moves()) {
    move.line = ++sequence_;
    timer_->on_move(move);
  }
  for (interpret::Event event : walk.events()) {
    if (event.kind == interpret::EventKind::end || event.kind == interpret::EventKind::stop) {
      event.line = ++sequence_;
      timer_->on_event(event);
    }
  }
}

Result<double> Clock::finish() {
  if (unknown_line_ != 0) {
    return kernel::outcome::refuse("", unknown_line_,
                                   "the time of this line is needed but was not found before",
                                   "verify the changed program separately");
  }
  if (known_ != nullptr) {
    return known_->program_s;
  }
  const auto time = timer_->take();
  if (!time) {
    return std::unexpected(time.error());
  }
  // Lines after the last move are reached at the program's end.
  arrived(std::numeric_limits<std::uint32_t>::max(), *time);
  return *time;
}

}  // namespace steadyrest::nc::rewrite
