// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/program/ahead/choose_speeds.hpp>
#include <steadyrest/chatter/offline/plan/planner.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::apps::cli {
namespace {

using chatter::offline::PlanDecision;
using kernel::machine::Machine;
using kernel::outcome::Result;
using kernel::units::rev_s_from_rpm;
using kernel::units::rpm_from_rev_s;
using nc::rewrite::SpindleSpan;

constexpr int kFirstPercent = 1;
constexpr int kLastPercent = 400;

/// A machine whose spindle override has these ratios as its steps.
Machine with_steps(Machine machine, double most_ratio) {
  auto& table = machine.spindle_override;
  table.ratio.clear();
  table.code.clear();
  for (int percent = kFirstPercent; percent <= kLastPercent; ++percent) {
    if (const double ratio = percent / 100.0; ratio <= most_ratio || percent <= 100) {
      table.ratio.push_back(ratio);
      table.code.push_back(static_cast<std::uint32_t>(percent));
    }
  }
  table.max_ratio = table.ratio.back();
  return machine;
}

/// As far as the feed per minute may rise with the speed.
double most_ratio(const Machine& machine, const SpindleSpan& span) noexcept {
  double most_mm_s = machine.control.max_feed_mm_s;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, machine.axes.size()); ++i) {
    if (machine.axes[i].present) {
      most_mm_s = std::min(most_mm_s, machine.axes[i].max_speed_au_s);
    }
  }
  return span.most_feed_mm_s > 0.0 ? std::max(1.0, most_mm_s / span.most_feed_mm_s) : 1e9;
}

/// S is written in whole rpm; the feed follows what is written.
double written_ratio(double speed_rev_s, double ratio) noexcept {
  const double rpm = rpm_from_rev_s(speed_rev_s);
  return std::round(rpm * ratio) / rpm;
}

/// What keeps a span from being planned; empty when nothing does.
std::string not_planned(const SpeedTask& task, const SpindleSpan& span) {
  if (span.surface_speed) {
    return "it cuts under G96, where the speed follows the radius";
  }
  if (task.tool && span.tool != *task.tool) {
    return fmt::format("the process is for tool {}", *task.tool);
  }
  if (!(span.speed.value > 0.0)) {
    return "the spindle is stopped";
  }
  return span.stays;
}

}  // namespace

Result<std::vector<SpeedChoice>> choose_speeds(const SpeedTask& task,
                                               const std::vector<SpindleSpan>& spans) {
  std::vector<SpeedChoice> out;
  std::map<std::pair<double, double>, chatter::offline::Plan> plans;  // by speed and its ceiling
  for (std::size_t i = 0; i < spans.size(); ++i) {
    const SpindleSpan& span = spans[i];
    SpeedChoice choice;
    choice.speed_rev_s = rev_s_from_rpm(span.speed.value);
    choice.decision = "stays";
    choice.why = span.first_cut == 0 ? "it does not cut" : not_planned(task, span);
    if (choice.why.empty()) {
      const double most = most_ratio(task.machine, span);
      const auto key = std::pair(choice.speed_rev_s, most);
      auto found = plans.find(key);
      if (found == plans.end()) {
        chatter::offline::PlanOptions options;
        options.laws.clear();
        options.progress = [&](double share, std::string_view what) {
          task.progress((static_cast<double>(i) + share) / static_cast<double>(spans.size()), what);
        };
        auto plan = chatter::offline::plan(task.process, with_steps(task.machine, most),
                                           choice.speed_rev_s, task.depth_mm, options);
        if (!plan) {
          return std::unexpected(plan.error());
        }
        found = plans.emplace(key, std::move(*plan)).first;
      }
      const chatter::offline::Plan& plan = found->second;
      choice.decision = chatter::offline::name(plan.decision);
      choice.limit_depth_mm = plan.chosen.limit_depth_mm;
      if (plan.decision == PlanDecision::constant) {
        choice.ratio = written_ratio(choice.speed_rev_s, plan.chosen.ratio);
      } else if (plan.decision == PlanDecision::nothing) {
        choice.why = fmt::format("no speed keeps {:g} mm; {:.3g} mm are likely to be stable",
                                 task.depth_mm, plan.likely_depth_mm);
      }
    }
    out.push_back(std::move(choice));
  }
  return out;
}

}  // namespace steadyrest::apps::cli
