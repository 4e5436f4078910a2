// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/nc/rewrite/window.hpp>

namespace steadyrest::nc::rewrite {

using kernel::outcome::Kind;
using kernel::outcome::Refusal;
using kernel::outcome::Result;

Result<std::unique_ptr<Window>> Window::make(const KnownTimes* known,
                                             const kernel::machine::Machine& machine,
                                             const Plan& plan, const Settings& settings,
                                             const std::string& changed) {
  std::unique_ptr<Window> made(new Window(plan, settings, changed));
  auto clock = Clock::make(
      known, machine,
      [window = made.get()](std::uint64_t from, double time_s) { window->told(from, time_s); });
  if (!clock) {
    return std::unexpected(clock.error());
  }
  made->clock_ = std::move(*clock);
  return made;
}

void Window::ask(const AxisPlan& axis, std::size_t from, std::size_t to, std::uint32_t line) {
  clock_->ask(from);
  asked_.push_back({.axis = &axis, .to = to, .line = line});
}

void Window::told(std::uint64_t from, double time_s) {
  const Asked asked = asked_.front();
  asked_.pop_front();
  for (std::size_t i = from; i <= asked.to && !too_far_; ++i) {
    const double planned_s = asked.axis->steps[i].time_s;
    if (std::abs(time_s - planned_s) > settings_.window_s) {
      too_far_ = Refusal{Kind::bad_input, changed_, asked.line,
                         fmt::format("a correction of {} acts at {:.1f} s; it is planned at {:.1f} "
                                     "s, and {:g} s of difference are allowed",
                                     asked.axis->letter, time_s, planned_s, settings_.window_s),
                         "make the changed program anew, or allow a wider --window-s"};
    }
  }
}

Result<double> Window::finish() {
  const auto total = clock_->finish();
  if (!total) {
    return total;
  }
  if (auto fits = check_total(plan_, *total); !fits) {
    return std::unexpected(fits.error());
  }
  if (too_far_) {
    return std::unexpected(*too_far_);
  }
  return total;
}

}  // namespace steadyrest::nc::rewrite
