// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/core.h>

#include <steadyrest/apps/cli/program/ahead/program_bounds.hpp>

namespace steadyrest::apps::cli {
namespace {

using nc::plan::PathEvent;
using nc::plan::PathEventKind;

constexpr double kMinute_s = 60.0;
constexpr double kHour_s = 3600.0;
constexpr double kDay_s = 24.0 * kHour_s;

std::string time_text(double seconds) {
  if (seconds >= kDay_s) {
    return fmt::format("{:.3g} days", seconds / kDay_s);
  }
  return seconds >= kHour_s ? fmt::format("{:.3g} h", seconds / kHour_s)
                            : fmt::format("{:.3g} min", seconds / kMinute_s);
}

/// What a program takes at least: its lengths at their feeds, and its dwells.
class LeastTimeByLine {
 public:
  explicit LeastTimeByLine(const nc::plan::PlannedPath& path) {
    double spindle_rev_s = 0.0;
    auto event = path.events.begin();
    for (std::size_t i = 0; i < path.segments.size(); ++i) {
      for (; event != path.events.end() && event->segment <= i; ++event) {
        spindle_rev_s = event->kind == PathEventKind::spindle ? event->value : spindle_rev_s;
        add(*event);
      }
      const nc::plan::SegmentPlan& plan = path.plans[i];
      const double turns = plan.spindle_rev_s != 0.0 ? plan.spindle_rev_s : spindle_rev_s;
      const double feed_mm_s = plan.feed_mm_s * (plan.per_revolution ? std::abs(turns) : 1.0);
      if (!plan.rapid && feed_mm_s > 0.0) {
        add(plan.length_mm / std::min(feed_mm_s, plan.speed_limit_mm_s), path.segments[i].line);
      }
    }
    std::for_each(event, path.events.end(), [&](const PathEvent& rest) { add(rest); });
    add(0.0, 0);  // closes the last line
  }

  double whole_s = 0.0;
  double longest_s = 0.0;  ///< the line that takes longest …
  std::uint32_t line = 0;  ///< … and its number

 private:
  void add(const PathEvent& event) {
    if (event.kind == PathEventKind::dwell) {
      add(event.value, event.line);
    }
  }
  void add(double seconds, std::uint32_t of) {
    if (of != line_) {
      line_ = of;
      line_s_ = 0.0;
    }
    line_s_ += seconds;
    whole_s += seconds;
    if (line_s_ > longest_s) {
      longest_s = line_s_;
      line = of;
    }
  }

  std::uint32_t line_ = 0;
  double line_s_ = 0.0;
};

/// Where a program covers more of an axis than any work offset allows: what it does in work
/// coordinates lies within one travel, and so does what it does in the machine's own (G28, G53).
std::optional<nc::plan::Warning> beyond_any_offset(const SourceProgram& program) {
  constexpr double kRanges = 2.0;
  const auto& axes = program.machine.axes;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, axes.size()); ++i) {
    double low = program.path.segments.front().start_mm[i];
    double high = low;
    for (const auto& segment : program.path.segments) {
      low = std::min(low, segment.end_mm[i]);
      high = std::max(high, segment.end_mm[i]);
      if (high - low > kRanges * (axes[i].max_au - axes[i].min_au)) {
        return nc::plan::Warning{
            segment.line,
            fmt::format("the program covers {:.3f} mm of {}, from {:.3f} to {:.3f} "
                        "mm; its travel is only {:g} mm, whatever the work offset",
                        high - low, axes[i].name, low, high, axes[i].max_au - axes[i].min_au)};
      }
    }
  }
  return std::nullopt;
}

/// Fanuc counts whole numbers in mm or in the least increment, as its parameter says.
std::string_view travel_advice(nc::read::Dialect dialect) {
  return dialect == nc::read::Dialect::fanuc || dialect == nc::read::Dialect::haas
             ? "look for a coordinate in the wrong unit (numbers without a point count in the "
               "least increment with --least-increment), or mend the travel in the machine file"
             : "look for a coordinate in the wrong unit, or mend the travel in the machine file";
}

}  // namespace

Result<void> within_bounds(const SourceProgram& program, const std::string& file,
                           double longest_s) {
  const auto past = program.past_travel.empty() ? beyond_any_offset(program)
                                                : std::optional(program.past_travel.front());
  if (past) {
    return refuse(file, past->line, past->text, std::string(travel_advice(program.config.dialect)));
  }
  const LeastTimeByLine least(program.path);
  if (least.whole_s > longest_s) {
    return refuse(
        file, least.line,
        fmt::format("the program takes {} at its own feeds, {} of them in this line; "
                    "allowed: up to {:g} h",
                    time_text(least.whole_s), time_text(least.longest_s), longest_s / kHour_s),
        "look for a feed or a dwell in the wrong unit, or divide the program");
  }
  return {};
}

}  // namespace steadyrest::apps::cli
