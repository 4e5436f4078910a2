// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/thermal/thermal_parts.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::apps::cli {

using kernel::outcome::refuse;
using kernel::outcome::Result;
using thermal::offline::Measured;

namespace {

/// Just before the end of a transition: a part is finished there, and the next transition's first
/// correction comes at the very end.
constexpr double kBeforeEnd_s = 1e-3;

/// A row names its place by a transition (number or name) or by a time since the start of the plan.
class Placer {
 public:
  Placer(const ThermalPlanFile& plan, std::string file, double tolerance_mm,
         const thermal::offline::Cyclogram* work)
      : plan_(plan), file_(std::move(file)), tolerance_mm_(tolerance_mm), work_(work) {}

  Result<std::vector<PlacedPart>> place(const std::vector<Measured>& rows) const {
    std::vector<PlacedPart> out;
    for (const Measured& row : rows) {
      auto part = place(row);
      if (!part) {
        return std::unexpected(part.error());
      }
      out.push_back(*part);
    }
    return out;
  }

 private:
  Result<PlacedPart> place(const Measured& row) const {
    const auto& axes = plan_.plan.axes;
    // With one axis in the plan the column may be missing.
    const auto axis = row.axis.empty() && axes.size() == 1
                          ? axes.begin()
                          : std::ranges::find_if(axes, [&](const auto& a) {
                              return row.axis == std::string(1, a.letter);
                            });
    if (axis == axes.end()) {
      return refuse(file_, row.line,
                    row.axis.empty() ? "the plan has several axes; the row names none"
                                     : fmt::format("the plan has no axis {}", row.axis),
                    "name an axis of the plan in the column axis");
    }
    const auto time_s = instant(row);
    if (!time_s) {
      return std::unexpected(time_s.error());
    }
    const double tolerance_mm = tolerance(row, *time_s);
    if (!(tolerance_mm > 0.0)) {
      return refuse(file_, row.line, "this part has no tolerance",
                    "give a column tolerance_um, or --tolerance-um");
    }
    return PlacedPart{&row, static_cast<std::size_t>(axis - axes.begin()), *time_s, tolerance_mm};
  }

  [[nodiscard]] Result<double> instant(const Measured& row) const {
    if (row.transition.empty()) {
      const double total_s = plan_.plan.total_s;
      // One second of tolerance for times rounded to the minute's last digits.
      if (row.time_s > total_s + 1.0) {
        return refuse(
            file_, row.line,
            fmt::format("minute {:.6g} is after the plan's end at minute {:.6g}", row.time_s / 60.0,
                        total_s / 60.0),
            "count minutes from the start of the plan, and check that this is the right plan");
      }
      return std::min(row.time_s, total_s);
    }
    std::size_t number = 0;
    const auto& rows = plan_.transition;
    const char* const end = row.transition.data() + row.transition.size();
    const auto parsed = std::from_chars(row.transition.data(), end, number);
    auto found = rows.end();
    // A whole number is a transition's number from 1, anything else its name.
    if (parsed.ec == std::errc{} && parsed.ptr == end) {
      found = number >= 1 && number <= rows.size()
                  ? rows.begin() + static_cast<std::ptrdiff_t>(number - 1)
                  : rows.end();
    } else {
      found = std::ranges::find(rows, row.transition, &ThermalPlanFile::Transition::name);
    }
    if (found == rows.end()) {
      return refuse(
          file_, row.line, fmt::format("the plan has no transition {}", row.transition),
          fmt::format("write a number from 1 to {}, or a transition's name", rows.size()));
    }
    // A part is measured when its transition is done, so the state at the transition's end counts.
    return found->end_s - kBeforeEnd_s;
  }

  // The tightest source first: the row, the command line, the transition in which the part was
  // made, the plan as a whole.
  [[nodiscard]] double tolerance(const Measured& row, double time_s) const {
    if (row.tolerance_mm > 0.0) {
      return row.tolerance_mm;
    }
    if (tolerance_mm_ > 0.0) {
      return tolerance_mm_;
    }
    // Transitions follow one another, so the first whose end is not before the time contains it.
    if (work_ != nullptr) {
      double end_s = 0.0;
      for (const auto& transition : work_->transition) {
        end_s += transition.seconds;
        if (time_s <= end_s && transition.tolerance_mm > 0.0) {
          return transition.tolerance_mm;
        }
        if (time_s <= end_s) {
          break;
        }
      }
    }
    return kernel::units::mm_from_um(plan_.tolerance_um);
  }

  const ThermalPlanFile& plan_;
  std::string file_;
  double tolerance_mm_;
  const thermal::offline::Cyclogram* work_;
};

}  // namespace

/// One bad row refuses the whole file: a level learnt from part of the parts would be a guess.
Result<std::vector<PlacedPart>> place_parts(const ThermalPlanFile& plan,
                                            const std::vector<Measured>& rows,
                                            const std::string& file, double tolerance_mm,
                                            const thermal::offline::Cyclogram* work) {
  return Placer(plan, file, tolerance_mm, work).place(rows);
}

}  // namespace steadyrest::apps::cli
