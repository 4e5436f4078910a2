// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/live/loop.hpp>

namespace steadyrest::live {
namespace {

using kernel::machine::Mode;
using kernel::outcome::Reason;
using kernel::outcome::Result;

constexpr double kShortestPeriod_s = 1.0 / 4000.0;
constexpr double kLongestPeriod_s = 1.0;
constexpr double kRounding = 1e-9;
constexpr double kLongestHold_s = 120.0;

std::size_t place_of(Reason reason) noexcept {
  const auto all = kernel::outcome::reasons();
  const auto at = std::ranges::lower_bound(all, reason, {}, &kernel::outcome::ReasonEntry::reason);
  return static_cast<std::size_t>(at - all.begin());
}

}  // namespace

Result<void> Loop::check(const Config& config) {
  if (!(config.period_s >= kShortestPeriod_s - kRounding &&
        config.period_s <= kLongestPeriod_s + kRounding)) {
    return kernel::outcome::refuse(
        fmt::format("the cycle of {:g} Hz is out of range; allowed: 1 … 4000 Hz",
                    1.0 / config.period_s),
        "set the period of the control in the machine file");
  }
  return {};
}

Loop::Loop(kernel::port::Port& port, supervisor::Supervisor& layer, Pace& pace, Config config)
    : layer_(&layer),
      port_(port, pace, config.holds_s, layer_),
      pace_(pace),
      config_(std::move(config)),
      wanted_(config_.mode) {
  figures_.by_reason.assign(kernel::outcome::reasons().size(), 0);
  now_.contour_limit_mm = config_.contour_limit_mm;
}

const LoopFigures& Loop::run() noexcept {
  for (;;) {
    Pace::Wake wake;
    // A port that fails at once sets no pace.
    if (!config_.port_paces || now_.port_fault) {
      wake = pace_.wait();
    }
    succeed();
    pass_note_on();
    grant_wish();
    if (!goes_on(pace_.now_s())) {
      end();
      return figures_;
    }
    cycle();
    beats_.fetch_add(1);
    const double work_s = pace_.now_s() - port_.read_s;
    figures_.work.add(work_s);
    figures_.lateness.add(config_.port_paces ? port_.age_s : wake.lateness_s);
    figures_.overruns +=
        config_.port_paces ? static_cast<std::uint64_t>(work_s > config_.period_s) : wake.missed;
    watch();
  }
}

/// Between two cycles, so that no cycle sees two layers.
void Loop::succeed() noexcept {
  Successor* const next = offered_.exchange(nullptr);
  if (next == nullptr) {
    return;
  }
  next->layer.take_over(*layer_, next->kept);
  layer_ = &next->layer;
  config_.contour_limit_mm = next->machine.contour.limit_mm;
  now_.contour_limit_mm = config_.contour_limit_mm;
  if (config_.on_reload) {
    config_.on_reload(next->text);
  }
  status_.store(now_);
  taken_.fetch_add(1);  // last: what was before may go from here on, and the status shows it
}

bool Loop::note(std::string_view words) {
  LoopNote note{.size = std::min(words.size(), LoopNote::kLongest), .text = {}};
  std::copy_n(words.begin(), note.size, note.text.begin());
  const std::scoped_lock lock(noting_);
  return notes_.try_push(note);
}

void Loop::pass_note_on() noexcept {
  if (const auto note = notes_.try_pop(); note && config_.on_note) {
    config_.on_note({note->text.data(), note->size});
  }
}

/// Told to the record whatever became of it: an outlier counts too.
void Loop::grant_wish() noexcept {
  const supervisor::Wish* const wish = wishes_.take();
  if (wish == nullptr) {
    return;
  }
  const supervisor::WishOutcome outcome = supervisor::grant(*layer_, *wish);
  if (config_.on_wish) {
    config_.on_wish(*wish, outcome);
  }
  wishes_.answer(outcome);
}

void Loop::end() noexcept {
  figures_.ended_in_fault = now_.port_fault;
  figures_.last_fault = now_.port_words.data();
}

bool Loop::stops(double now_s) const noexcept {
  return stop_.load() || (config_.most_cycles > 0 && figures_.cycles >= config_.most_cycles) ||
         (config_.most_s > 0.0 && now_s - began_s_ >= config_.most_s) ||
         (config_.finished && config_.finished());
}

/// Sets the mode of the next cycle; false once there is none.
bool Loop::goes_on(double now_s) noexcept {
  began_s_ = began_s_ < 0.0 ? now_s : began_s_;
  const bool stops = this->stops(now_s);
  if (stops && stop_asked_s_ < 0.0) {
    stop_asked_s_ = now_s;
  }
  // In a thread nothing can be handed back.
  const bool held =
      kernel::signal::is_locked(port_.last.motion) && now_s - stop_asked_s_ <= kLongestHold_s;
  if (stops && (stopped_s_ < 0.0 || held)) {
    stopped_s_ = now_s;
  }
  const Mode mode = stops ? Mode::observe : wanted_.load();
  if (stops && layer_->mode_in_force() != Mode::act) {
    return false;
  }
  if (stops && now_s - stopped_s_ > config_.handback_s) {
    figures_.handed_back = false;
    if (config_.on_fault) {
      config_.on_fault("kept: ended before all was handed back");
    }
    return false;
  }
  layer_->set_mode(mode);
  if (config_.on_mode && told_ != mode) {
    config_.on_mode(mode);
    told_ = mode;
  }
  return true;
}

void Loop::cycle() noexcept {
  const auto command = layer_->cycle(port_, {});
  ++figures_.cycles;
  now_.port_fault = !command;
  if (command) {
    if (config_.on_command) {
      config_.on_command(*command);
    }
    count(*command);
    publish();
  } else {
    ++figures_.port_faults;
    note_fault(command.error());
    const Reason lost = Reason::heartbeat_lost;
    count({.feed_reason = lost,
           .spindle_reason = lost,
           .offset_reason = lost,
           .path_offset_reason = lost});
    publish();
  }
}

void Loop::watch() noexcept {
  const std::string_view why =
      black_box_.update({.now_s = port_.read_s,
                         .port_fault = now_.port_fault,
                         .unfit = now_.port_fault ? Reason::none : layer_->unfit(),
                         .overruns = figures_.overruns});
  if (!why.empty() && config_.on_fault) {
    config_.on_fault(why);
  }
}

void Loop::count(const kernel::signal::Command& command) noexcept {
  now_.reasons = {command.feed_reason, command.spindle_reason, command.offset_reason,
                  command.path_offset_reason};
  for (std::size_t i = 0; i < now_.reasons.size(); ++i) {
    // One cycle counts once for each reason.
    const auto end = now_.reasons.cbegin() + static_cast<std::ptrdiff_t>(i);
    if (std::find(now_.reasons.cbegin(), end, now_.reasons[i]) == end) {
      const std::size_t place = place_of(now_.reasons[i]);
      figures_.by_reason[std::min(place, figures_.by_reason.size() - 1)] += 1;
    }
  }
}

void Loop::publish() noexcept {
  look_at(*layer_, now_);
  now_.chatter = chatter_.update(*layer_, config_.period_s);
  figures_.listens = now_.chatter.listens;
  figures_.chatter_events = now_.chatter.events;
  figures_.chatter_s = now_.chatter.chatter_s;
  now_.cycles = figures_.cycles;
  now_.overruns = figures_.overruns;
  now_.mode_wanted = wanted_.load();
  now_.error_known = now_.error_known && !now_.port_fault;
  if (now_.error_known && std::abs(now_.contour_error_mm) > config_.contour_limit_mm) {
    figures_.over_limit_s += config_.period_s;
  }
  status_.store(now_);
  if (config_.tap != nullptr) {
    config_.tap->put(now_, port_.last);
    config_.tap->look_at_steps(now_, *layer_);
    config_.tap->look_at_heat(now_, *layer_);
  }
}

void Loop::note_fault(const kernel::outcome::Refusal& refusal) noexcept {
  const std::size_t length = std::min(refusal.what.size(), now_.port_words.size() - 1);
  std::copy_n(refusal.what.begin(), length, now_.port_words.begin());
  now_.port_words[length] = '\0';
}

}  // namespace steadyrest::live
