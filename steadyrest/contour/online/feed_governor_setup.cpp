// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>

#include <steadyrest/contour/online/feed_governor.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

// What the governor works out once, from the machine file.
namespace steadyrest::contour::online {
namespace {

using kernel::machine::Axis;
using kernel::machine::Machine;
using kernel::outcome::refuse;
using Axes = std::span<const Axis>;

/// Assumed cost of one forecast step: twice what a 3 GHz core needs, so that slower ones keep the
/// share too. A fixed figure, so that the same input gives the same decisions everywhere.
constexpr double kForecastStepCostS = 100e-9;

/// Of the stiffest axis's 1/k: it forecasts a steady circle to 0.1 % of ε + 0.1 µm (test Forecast,
/// OfASteadyCircle…). README, "What the constants do", covers the next two as well.
constexpr double kStep = 0.12;
constexpr double kSettle = 4.0;     // of the softest axis's 1/k: e⁻⁴ of an error is left, 2 %
constexpr double kSettleLag = 3.0;  // of the longest τ: e⁻³ of the velocity loop's part is left

/// For the control's own braking. A forecast runs v/a longer than the override needs (Walk::steps
/// in forecast.cpp); neither is known yet here, so v/a is taken for 12 m/min at 2 m/s².
constexpr double kBrakingS = 0.1;

/// In which the envelope takes a path offset out: kernel/override/offset_envelope.
constexpr double kOffsetOut_s = 0.2;

/// How far the tool point's command may jump at a corner: the axes are given a change of speed of
/// k times it at once.
constexpr double kToolTurn_mm = 0.07;

/// The axes that make the contour.
Axes path_axes(Axes axes) noexcept {
  return axes.first(std::min<std::size_t>(3, axes.size()));
}

double largest(Axes axes, double Axis::* value, double at_least) noexcept {
  double largest = at_least;
  for (const Axis& axis : path_axes(axes)) {
    largest = std::max(largest, axis.*value);
  }
  return largest;
}

// The stiffest axis sets the forecast's step; the softest one sets how far back the foot is and how
// long a change takes to settle.
double stiffest(Axes axes) noexcept {
  return largest(axes, &Axis::servo_gain_1_s, 1.0);
}

double softest(Axes axes) noexcept {
  return contour_config(axes).servo_gain_1_s;
}

double longest_lag(Axes axes) noexcept {
  return largest(axes, &Axis::velocity_lag_s, 0.0);
}

/// Time over which the control's jerk limit averages the acceleration, A/J; its mean delay is half
/// of it.
double jerk_time(Axes axes) noexcept {
  double time = 0.0;
  for (const Axis& axis : path_axes(axes)) {
    if (std::isfinite(axis.max_jerk_au_s3) && axis.max_jerk_au_s3 > 0.0) {
      time = std::max(time, axis.max_acceleration_au_s2 / axis.max_jerk_au_s3);
    }
  }
  return std::min(time, 0.5);
}

/// What a step gives; the control clips the table.
double ratio_of(const kernel::machine::OverrideTable& table, std::size_t step) noexcept {
  return std::min(table.ratio[step], table.max_ratio);
}

constexpr double kRounding = 1e-9;  ///< ratios closer than this are the same

/// The steps that the search looks at: the first of each ratio, or, for a table finer than the
/// forecast's, as many as that holds, evenly spread and including both ends.
std::vector<std::size_t> searched_steps(const kernel::machine::OverrideTable& table) {
  std::vector<std::size_t> distinct;
  for (std::size_t i = 0; i < table.ratio.size(); ++i) {
    if (distinct.empty() || ratio_of(table, i) > ratio_of(table, distinct.back()) + kRounding) {
      distinct.push_back(i);
    }
  }
  const std::size_t steps = distinct.size();
  const std::size_t count = std::min(steps, Forecast::kMaxTable);
  std::vector<std::size_t> index(count);
  for (std::size_t i = 0; i < count; ++i) {
    index[i] = distinct[count == steps ? i : (i * (steps - 1) + (count - 1) / 2) / (count - 1)];
  }
  return index;
}

/// A word that is not latched walks from neighbour to neighbour, one per scan, over repeated steps
/// too: the slowest pace of that among the searched steps.
double walking_1_s(const kernel::machine::OverrideTable& table,
                   const std::vector<double>& candidate,
                   const std::vector<std::size_t>& step) noexcept {
  double slowest = std::numeric_limits<double>::infinity();
  if (table.latched_word || !(table.scan_period_s > 0.0)) {
    return slowest;
  }
  for (std::size_t i = 1; i < candidate.size(); ++i) {
    const double walk_s = static_cast<double>(step[i] - step[i - 1]) * table.scan_period_s;
    slowest = std::min(slowest, (candidate[i] - candidate[i - 1]) / walk_s);
  }
  return slowest;
}

double largest_count_mm(Axes axes) noexcept {
  double count_mm = 0.0;
  for (const Axis& axis : path_axes(axes)) {
    count_mm = std::max(count_mm, axis.encoder.count_au);
  }
  return count_mm;
}

kernel::outcome::Result<void> check(const FeedGovernor::Config& config) {
  if (config.axes.empty()) {
    return refuse("the machine has no axis; allowed: one or more", "add an [[axis]] for each axis");
  }
  if (!(config.contour.limit_mm > 0.0)) {
    return refuse(
        "the contour limit is " + std::to_string(config.contour.limit_mm) + " mm; allowed: above 0",
        "correct limit_um in [contour]");
  }
  if (!(config.contour.margin >= 0.0 && config.contour.margin < 1.0)) {
    return refuse(
        "the contour margin is " + std::to_string(config.contour.margin) + "; allowed: 0 … below 1",
        "correct margin_percent in [contour]");
  }
  if (!(config.contour.min_ratio > 0.0 && config.contour.min_ratio <= config.contour.max_ratio)) {
    return refuse("the feed ratios of [contour] are " + std::to_string(config.contour.min_ratio) +
                      " … " + std::to_string(config.contour.max_ratio) +
                      "; allowed: above 0, rising",
                  "correct min_percent and max_percent in [contour]");
  }
  if (!(config.envelope.feed_fall_1_s > 0.0 && config.envelope.feed_rise_1_s > 0.0)) {
    return refuse("the feed's slew limits are " + std::to_string(config.envelope.feed_fall_1_s) +
                      " 1/s down and " + std::to_string(config.envelope.feed_rise_1_s) +
                      " 1/s up; allowed: above 0",
                  "correct the slew limits in [envelope]");
  }
  if (!(config.work_share > 0.0 && config.work_share <= 1.0)) {
    return refuse("work_share is " + std::to_string(config.work_share) + "; allowed: above 0 … 1",
                  "correct work_share");
  }
  if (config.objective == nullptr) {
    return refuse("no objective is given", "give a function of a candidate");
  }
  return {};
}

}  // namespace

// Both terms run from 0 to 1 over the permitted range, so that the weights compare like with like.
double combined_objective(const Candidate& c) noexcept {
  const double span = c.max_ratio - c.min_ratio;
  const double slowness = span > 0.0 ? (c.max_ratio - c.ratio) / span : 0.0;
  return c.weight_contour * c.error_mm / c.limit_mm + c.weight_feed * slowness;
}

FeedGovernor::Config FeedGovernor::Config::of(const Machine& machine) {
  Config config;
  config.axes = machine.axes;
  config.feed_override = machine.feed_override;
  config.contour = machine.contour;
  config.envelope = machine.envelope;
  config.control = machine.control;
  config.cycle_s = kernel::machine::layer_cycle_s(machine);
  return config;
}

kernel::outcome::Result<FeedGovernor> FeedGovernor::make(const Machine& machine) {
  return make(Config::of(machine));
}

kernel::outcome::Result<FeedGovernor> FeedGovernor::make(const Config& given) {
  if (auto fit = check(given); !fit) {
    return std::unexpected(fit.error());
  }
  Config config = given;
  config.cycle_s = given.cycle_s > 0.0 ? given.cycle_s : given.control.interpolator_period_s;
  auto contour = ContourError::make(contour_config(config.axes));
  if (!contour) {
    return std::unexpected(contour.error());
  }
  auto servo = ServoModel::make(config.axes, config.cycle_s);
  if (!servo) {
    return std::unexpected(servo.error());
  }
  auto precompensator =
      Precompensator::make({.axes = config.axes,
                            .max_offset_mm = config.envelope.max_path_offset_mm,
                            .delay_s = config.path_offset_delay_s,
                            .acceleration_mm_s2 = config.path_offset_acceleration_mm_s2});
  if (!precompensator) {
    return std::unexpected(precompensator.error());
  }
  FeedGovernor governor(config, *contour, *servo, *std::move(precompensator));
  if (auto seen = governor.check_reach(); !seen) {
    return std::unexpected(seen.error());
  }
  if (governor.candidate_.empty()) {
    return refuse(
        "no step of the override table lies between min_percent and max_percent of [contour]",
        "widen that range until it holds a step");
  }
  return governor;
}

FeedGovernor::FeedGovernor(const Config& config, const ContourError& contour,
                           const ServoModel& servo, Precompensator precompensator)
    : config_(config),
      contour_(contour),
      original_(contour),
      servo_(servo),
      ahead_(config.axes, config.control.max_path_acceleration_mm_s2,
             kToolTurn_mm * softest(config.axes)),
      precompensator_(std::move(precompensator)),
      guess_(config.axes, config.control.max_path_acceleration_mm_s2) {
  const Config& m = config_;
  // The strictest of the three: [contour], the envelope and the table. Steps at 0 stop the machine
  // and are no candidates.
  const double low = std::max(m.contour.min_ratio, m.envelope.min_feed_ratio);
  const double high =
      std::min({m.contour.max_ratio, m.envelope.max_feed_ratio, m.feed_override.max_ratio});
  for (const std::size_t i : searched_steps(m.feed_override)) {
    const double ratio = ratio_of(m.feed_override, i);
    table_ratio_.push_back(ratio);
    if (ratio > 0.0 && ratio >= low - kSameRatio && ratio <= high + kSameRatio) {
      candidate_.push_back(ratio);
      table_step_.push_back(i);
    }
  }
  softest_gain_1_s_ = softest(m.axes);
  for (std::size_t i = 0; i < path_axes(m.axes).size(); ++i) {
    half_backlash_mm_[i] = 0.5 * m.axes[i].backlash_au;
  }
  forecast_.set_half_backlash(half_backlash_mm_);
  reserve_ = Reserve({.limit_mm = m.contour.limit_mm,
                      .margin = m.contour.margin,
                      .half_backlash_mm = std::ranges::max(half_backlash_mm_),
                      .count_mm = largest_count_mm(m.axes)});
  // Deciding more often than the control scans the word changes nothing.
  decision_s_ = config_.decision_s > 0.0 ? config_.decision_s
                                         : std::clamp(m.feed_override.scan_period_s, 0.004, 0.010);
  decision_s_ = std::max(decision_s_, m.cycle_s);
  search_steps_ =
      static_cast<std::size_t>(std::max(1.0, config_.work_share * m.cycle_s / kForecastStepCostS));
  Forecast::Timing timing;
  // The step itself is exact; the change of curvature within one step must stay small.
  timing.step_s = config_.forecast_step_s > 0.0 ? config_.forecast_step_s
                                                : std::clamp(kStep / stiffest(m.axes), 5e-4, 4e-3);
  // A word written now acts after the table's dead time, one interpolator cycle and half of the
  // jerk filter.
  timing.dead_s =
      m.feed_override.dead_time_s + m.control.interpolator_period_s + 0.5 * jerk_time(m.axes);
  timing.scan_s = m.feed_override.scan_period_s + m.cycle_s;
  const double walk_1_s = walking_1_s(m.feed_override, candidate_, table_step_);
  timing.fall_1_s = std::min(m.envelope.feed_fall_1_s, walk_1_s);
  timing.rise_1_s = std::min(m.envelope.feed_rise_1_s, walk_1_s);
  timing.settle_s = kSettle / softest(m.axes) + kSettleLag * longest_lag(m.axes);
  forecast_.set_timing(timing);
  forecast_.set_table(table_ratio_);
  // How far ahead a decision must see: until a fall that begins at the next decision has run all
  // the way from 1 to 0, the control has braked, and the axes have settled.
  reach_s_ = timing.dead_s + timing.scan_s + decision_s_ + kBrakingS + 1.0 / timing.fall_1_s +
             timing.settle_s;
  back_s_ = timing.dead_s + timing.scan_s + decision_s_ + timing.settle_s +
            std::max({precompensator_.enabled() ? kOffsetOut_s : 0.0, (1.0 - low) / timing.rise_1_s,
                      (high - 1.0) / timing.fall_1_s});
  refresh_model(0.0);
  history_.fill(1.0);
}

// A word is followed from when it was told until it acts: no longer than the history of words and
// half of the forecast reach, so that the other half shows what the next one does.
kernel::outcome::Result<void> FeedGovernor::check_reach() const {
  const Forecast::Timing& timing = forecast_.timing();
  const double most_s = std::min(static_cast<double>(kHistory - 1) * config_.cycle_s,
                                 0.5 * static_cast<double>(Forecast::kMaxSteps) * timing.step_s);
  if (timing.dead_s + timing.scan_s <= most_s) {
    return {};
  }
  return refuse("a feed override word acts up to " +
                    std::to_string(1e3 * (timing.dead_s + timing.scan_s)) +
                    " ms after it is written; allowed: at most " + std::to_string(1e3 * most_s) +
                    " ms with this servo gain and interpolator period",
                "correct dead_time_ms and scan_period_ms in [feed_override], or switch [contour] "
                "off: an override this slow cannot hold a contour");
}

// A search may overshoot its budget by one look, which is up to two forecasts; the fall and one
// look along it are always made. The objective's search overshoots by one forecast.
std::size_t FeedGovernor::most_forecast_steps() const noexcept {
  const bool by_objective =
      config_.contour.strategy != kernel::machine::ContourStrategy::feed_priority;
  const std::size_t objective = by_objective ? search_steps_ + Forecast::kMaxSteps : 0;
  const std::size_t offsets =
      precompensator_.acceleration_mm_s2() > 0.0 ? 2 * Forecast::kMaxSteps : 0;
  return objective + offsets + search_steps_ + 4 * Forecast::kMaxSteps;
}

}  // namespace steadyrest::contour::online
