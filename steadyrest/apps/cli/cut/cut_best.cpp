// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/core.h>

#include <steadyrest/apps/cli/cut/cut_best.hpp>
#include <steadyrest/apps/cli/program/ahead/over_lines.hpp>
#include <steadyrest/apps/cli/program/ahead/predicted_change.hpp>
#include <steadyrest/apps/page/cut/report.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::apps::cli::cut {

using trial::cut::BestWays;
using trial::cut::Figures;
using trial::cut::OverLimitLine;
using trial::cut::Way;
using trial::cut::WayFigures;

namespace {

constexpr double kSameTime = 1.02;
constexpr double kSameShare =
    1e-3;  ///< of the cut: shares over the limit that differ by less count as equal

double share_over(const Figures& figures) {
  return figures.samples == 0 ? 0.0
                              : static_cast<double>(figures.samples_over_limit) /
                                    static_cast<double>(figures.samples);
}

/// Nothing over the limit is better than the least share.
double steps_over(const Figures& figures) {
  return figures.samples_over_limit == 0 ? 0.0 : 1.0 + std::floor(share_over(figures) / kSameShare);
}

bool by_layer(Way way) {
  return way == Way::feed_override || way == Way::path_offsets;
}

std::string lead_of(const std::string& head, const Figures& figures, double limit_mm) {
  using kernel::units::percent_from_ratio;
  return fmt::format("{:<18} {} largest, {} RMS, {:.2g} % of the cut over {}, in {:.2f} s", head,
                     in_um(figures.contour_error_max_mm), in_um(figures.contour_error_rms_mm),
                     percent_from_ratio(share_over(figures)), in_um(limit_mm),
                     figures.cycle_time_s);
}

std::string more_time(const Figures& now, const Figures& then) {
  return fmt::format(" ({:+.1f} %)", 100.0 * (then.cycle_time_s / now.cycle_time_s - 1.0));
}

}  // namespace

BestWays best_of(const std::vector<WayFigures>& ways) {
  BestWays best;
  const auto alone = std::ranges::find(ways, Way::alone, &WayFigures::way);
  if (alone == ways.end()) {
    return best;
  }
  const Figures& now = alone->figures;
  const auto same = [](const Figures& f) {
    return std::tuple(steps_over(f), f.contour_error_rms_mm);
  };
  const auto any = [](const Figures& f) { return std::tuple(steps_over(f), f.cycle_time_s); };
  for (const WayFigures& way : ways) {
    if (way.way == Way::alone) {
      continue;
    }
    if (way.way == Way::setting) {
      if (!best.setting || same(way.figures) < same(best.setting->figures)) {
        best.setting = way;
      }
      continue;
    }
    if (way.figures.cycle_time_s <= kSameTime * now.cycle_time_s &&
        same(way.figures) < same(best.same_time ? best.same_time->figures : now)) {
      best.same_time = way;
    }
  }
  const Figures& to_beat = best.same_time ? best.same_time->figures : now;
  for (const WayFigures& way : ways) {
    if (way.way != Way::setting && steps_over(way.figures) < steps_over(to_beat) &&
        way.figures.contour_error_max_mm <= to_beat.contour_error_max_mm &&
        (!best.any_time || any(way.figures) < any(best.any_time->figures))) {
      best.any_time = way;
    }
  }
  return best;
}

std::string put_best(Answer& answer, const BestWays& best, const Figures& now, double limit_mm) {
  answer.json["best"] = page::to_object(best);
  std::string text = lead_of("as programmed", now, limit_mm) + "\n";
  const auto put = [&](const char* head, const WayFigures& way) {
    text += lead_of(head, way.figures, limit_mm) + more_time(now, way.figures) + "\n";
    text += fmt::format("{:<18} {}\n", by_layer(way.way) ? "  by" : "  write it", way.get);
  };
  if (best.same_time) {
    put("best, same time", *best.same_time);
  } else if (now.samples_over_limit == 0) {
    text += "nothing to correct  the program keeps the limit as it is\n";
  }
  if (best.any_time) {
    put("best, more time", *best.any_time);
  }
  if (best.setting) {
    text += lead_of("cheapest: setting", best.setting->figures, limit_mm) + "\n" +
            fmt::format("{:<18} {}\n", "  set", best.setting->get);
  }
  return text + "\n";
}

OverLimitLine in_words(const contour::offline::OverLine& over, double limit_mm) {
  return {.line = over.line,
          .error_um = kernel::units::um_from_mm(over.error_mm),
          .reason = over.reason,
          .cure = cure_words(over, limit_mm)};
}

std::string put_over(Answer& answer, const std::vector<OverLimitLine>& over) {
  answer.json["over_limit"] = Json::array();
  for (const OverLimitLine& one : over) {
    answer.json["over_limit"].push_back(page::to_object(one));
  }
  if (over.empty()) {
    return {};
  }
  return "\nover the limit in the best way of the same time, by the servo model:\n" +
         first_of(over.size(), [&](std::size_t i) {
           const OverLimitLine& one = over[i];
           return fmt::format("line {}: {:.1f} µm, {}{}\n", one.line, one.error_um, one.reason,
                              one.cure.empty() ? "" : "; " + one.cure);
         });
}

}  // namespace steadyrest::apps::cli::cut
