// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <steadyrest/chatter/online/speed_table.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

// A table from the planner answers by depth; without one a rule of thumb does: n = 60·f/(N·k) puts
// a whole number k of waves between two teeth, where inner and outer wave are in phase and the chip
// keeps its thickness. The rule knows neither depth nor border, hence its narrow range.
namespace steadyrest::chatter::online {

using kernel::outcome::Reason;

namespace {

constexpr double kSameRatio = 1e-6;
// Of the speed, between the rule's and the step's: half a step of a switch in steps of 5 %.
constexpr double kRuleReach = 0.025;
// And of a wave, where there are many between two teeth. README, "What the constants do".
constexpr double kRuleWaves = 0.1;

kernel::outcome::Refusal refuse_table(const char* what) {
  return kernel::outcome::bad_input(what, "correct the table of speeds");
}

bool within(const std::vector<double>& values, double low) {
  return std::ranges::all_of(values, [low](double v) { return std::isfinite(v) && v >= low; });
}

SpeedTable::Advice unfit(Reason reason) noexcept {
  SpeedTable::Advice out;
  out.reason = out.request.reason = reason;
  return out;
}

SpeedTable::Advice found(double ratio, double speed_rev_s, Reason reason) noexcept {
  SpeedTable::Advice out;
  out.request = {.room = kernel::signal::Room::chatter, .ratio = ratio, .reason = reason};
  out.reason = reason;
  out.speed_rev_s = speed_rev_s;
  return out;
}

}  // namespace

kernel::outcome::Result<SpeedTable> SpeedTable::make(Config config) {
  if (config.speed_rev_s.size() != config.limit_depth_mm.size()) {
    return std::unexpected(refuse_table("the numbers of depths and speeds differ"));
  }
  if (!within(config.speed_rev_s, std::numeric_limits<double>::min()) ||
      std::ranges::adjacent_find(config.speed_rev_s, std::greater_equal<>{}) !=
          config.speed_rev_s.end()) {
    return std::unexpected(refuse_table("speeds are not positive and rising"));
  }
  if (!within(config.limit_depth_mm, 0.0)) {
    return std::unexpected(refuse_table("a limiting depth is negative or not finite"));
  }
  if (config.step_ratio.empty() || config.step_ratio.size() > 256 ||
      !within(config.step_ratio, 0.0) || !std::ranges::is_sorted(config.step_ratio)) {
    return std::unexpected(refuse_table("override steps are not 1…256 ratios that do not fall"));
  }
  if (config.teeth < 1 || config.teeth > 64) {
    return std::unexpected(refuse_table("teeth are not within 1…64"));
  }
  if (!(config.min_ratio >= 0.0 && config.max_ratio >= config.min_ratio &&
        config.min_rev_s >= 0.0 && config.max_rev_s > config.min_rev_s &&
        std::isfinite(config.max_ratio) && config.reserve >= 1.0)) {
    return std::unexpected(refuse_table("limits of ratio, speed or reserve are not in order"));
  }
  return SpeedTable(std::move(config));
}

double SpeedTable::limit_depth_mm(double speed_rev_s) const noexcept {
  // Nothing is known beyond the table: depth 0, so that no step there is ever advised.
  const auto& speed = config_.speed_rev_s;
  if (speed.empty() || !(speed_rev_s >= speed.front() && speed_rev_s <= speed.back())) {
    return 0.0;
  }
  const auto above = std::ranges::lower_bound(speed, speed_rev_s);
  const auto i = static_cast<std::size_t>(above - speed.begin());
  if (i == 0) {
    return config_.limit_depth_mm.front();
  }
  const double share = (speed_rev_s - speed[i - 1]) / (speed[i] - speed[i - 1]);
  return std::lerp(config_.limit_depth_mm[i - 1], config_.limit_depth_mm[i], share);
}

bool SpeedTable::permitted(double ratio, double speed_rev_s) const noexcept {
  return ratio > 0.0 && ratio >= config_.min_ratio - kSameRatio &&
         ratio <= config_.max_ratio + kSameRatio && speed_rev_s >= config_.min_rev_s &&
         speed_rev_s <= config_.max_rev_s;
}

SpeedTable::Advice SpeedTable::ask(const Question& question) const noexcept {
  if (!std::isfinite(question.programmed_rev_s) || !std::isfinite(question.ratio) ||
      !std::isfinite(question.depth_mm) || !std::isfinite(question.frequency_hz)) {
    return unfit(Reason::input_not_finite);
  }
  if (!(question.programmed_rev_s > 0.0 && question.ratio > 0.0 && question.depth_mm >= 0.0)) {
    return unfit(Reason::input_out_of_range);
  }
  if (!config_.speed_rev_s.empty()) {
    return from_table(question);
  }
  return question.frequency_hz > 0.0 ? from_rule(question) : Advice{};
}

SpeedTable::Advice SpeedTable::from_table(const Question& question) const noexcept {
  const double here_mm = limit_depth_mm(question.programmed_rev_s * question.ratio);
  // Without a depth no step has plenty: the deepest one wins.
  const double plenty_mm = question.depth_mm > 0.0
                               ? config_.reserve * std::max(question.depth_mm, here_mm)
                               : std::numeric_limits<double>::infinity();
  Advice best;
  double best_mm = here_mm;
  double best_way = std::numeric_limits<double>::infinity();
  for (const double ratio : config_.step_ratio) {
    const double speed = ratio * question.programmed_rev_s;
    const double way = std::abs(ratio - question.ratio);
    // The present step cannot be the advice: the cut chatters on it.
    if (!permitted(ratio, speed) || way < kSameRatio) {
      continue;
    }
    // All steps with plenty count the same, so the nearest wins.
    const double limit_mm = limit_depth_mm(speed);
    const double worth_mm = std::min(limit_mm, plenty_mm);
    if (worth_mm > best_mm || (best.speed_rev_s > 0.0 && worth_mm == best_mm && way < best_way)) {
      best = found(ratio, speed, Reason::chatter_better_speed);
      best.limit_depth_mm = limit_mm;
      best_mm = worth_mm;
      best_way = way;
    }
  }
  return best;
}

SpeedTable::Advice SpeedTable::from_rule(const Question& question) const noexcept {
  // Speed at which one wave fits between two teeth; at 1/k of it, k do.
  const double waves_rev_s = question.frequency_hz / static_cast<double>(config_.teeth);
  const double here = question.programmed_rev_s * question.ratio;
  const double here_waves = waves_rev_s / here;
  // A step only helps if it is nearer to whole waves than the present speed.
  const double here_off = std::abs(here_waves - std::max(1.0, std::round(here_waves)));
  Advice best;
  double best_way = std::numeric_limits<double>::infinity();
  for (const double ratio : config_.step_ratio) {
    const double speed = ratio * question.programmed_rev_s;
    const double k = std::max(1.0, std::round(waves_rev_s / std::max(speed, 1e-9)));
    const double miss = std::abs(speed * k / waves_rev_s - 1.0);
    const double way = std::abs(speed - here);
    if (permitted(ratio, speed) && std::abs(ratio - question.ratio) >= kSameRatio &&
        miss < kRuleReach && miss * k < std::min(kRuleWaves, here_off) && way < best_way) {
      best = found(ratio, speed, Reason::chatter_rule_speed);
      // Bounded before the cast: a tiny speed gives a k beyond an unsigned.
      best.waves = static_cast<unsigned>(std::min(k, 1e6));
      best_way = way;
    }
  }
  return best;
}

}  // namespace steadyrest::chatter::online
