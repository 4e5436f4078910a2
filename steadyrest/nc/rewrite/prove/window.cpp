// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/rewrite/prove/window.hpp>

namespace steadyrest::nc::rewrite {

using kernel::outcome::refuse;
using kernel::outcome::Result;

Result<std::unique_ptr<Window>> Window::make(const KnownTimes* known,
                                             const kernel::machine::Machine& machine,
                                             const Plan& plan, const Settings& settings,
                                             const std::string& changed) {
  std::unique_ptr<Window> made(new Window(plan, settings, changed));
  // The ticket encodes both numbers: change · axes + axis.
  auto clock =
      Clock::make(known, machine, [&changes = made->changes_](std::uint64_t ticket, double time_s) {
        changes[ticket % changes.size()][ticket / changes.size()].time_s = time_s;
      });
  if (!clock) {
    return std::unexpected(clock.error());
  }
  made->clock_ = std::move(*clock);
  return made;
}

// The clock delivers the time later; the ticket tells whose it is.
void Window::ask(std::size_t axis, const WrittenChange& change) {
  clock_->ask(changes_[axis].size() * changes_.size() + axis);
  changes_[axis].push_back(change);
}

Result<double> Window::finish() {
  const auto total = clock_->finish();
  if (!total) {
    return total;
  }
  // For a plan of another program the windows would only show the symptom.
  if (auto fits = check_total(plan_, *total); !fits) {
    return std::unexpected(fits.error());
  }
  for (std::size_t axis = 0; axis < changes_.size(); ++axis) {
    if (auto fault = mismatch(plan_.axes[axis], settings_, changes_[axis])) {
      return refuse(changed_, fault->line, std::move(fault->what),
                    "make the changed program again, or allow a wider --window-s");
    }
  }
  return total;
}

}  // namespace steadyrest::nc::rewrite
