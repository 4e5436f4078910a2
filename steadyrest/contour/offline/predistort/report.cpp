// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>

#include <steadyrest/contour/offline/predistort/report.hpp>

namespace steadyrest::contour::offline {
namespace {

constexpr std::size_t kMostRemaining = 1000;

}  // namespace

void add_report(Predistorted& done, double limit_mm) {
  const auto worst = [](const ErrorFigures& figures, auto&& value) {
    double most = value(figures.nominal());
    for (const auto& of : figures.others()) {
      most = std::max(most, value(of));
    }
    return most;
  };
  const auto largest = [](const ErrorFigures::Whole& of) { return of.max_mm; };
  const auto rms = [](const ErrorFigures::Whole& of) { return of.rms_mm(); };
  done.worst_before_mm = worst(done.before, largest);
  done.worst_after_mm = worst(done.after, largest);
  done.worst_rms_before_mm = worst(done.before, rms);
  done.worst_rms_after_mm = worst(done.after, rms);
  const auto& after = done.after.nominal();
  for (std::size_t line = 0; line < after.by_line_mm.size(); ++line) {
    if (after.line_mm(line) > limit_mm) {
      done.remaining.push_back({.line = static_cast<std::uint32_t>(line),
                                .before_mm = done.before.nominal().line_mm(line),
                                .after_mm = after.line_mm(line)});
    }
  }
  std::ranges::stable_sort(done.remaining, std::ranges::greater{}, &Remaining::after_mm);
  done.remaining.resize(std::min(done.remaining.size(), kMostRemaining));
  std::ranges::sort(done.worse);
  std::ranges::sort(done.too_far);
  std::ranges::sort(done.past_travel);
}

}  // namespace steadyrest::contour::offline
