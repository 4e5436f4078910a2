// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <cmath>

#include <fmt/core.h>
#include <tbb/parallel_for.h>

#include <steadyrest/chatter/offline/cycle/stability.hpp>
#include <steadyrest/chatter/offline/depth/depth_line.hpp>
#include <steadyrest/chatter/offline/depth/limit_depth.hpp>
#include <steadyrest/chatter/offline/plan/alternative_check.hpp>
#include <steadyrest/chatter/offline/plan/override_course.hpp>
#include <steadyrest/kernel/units/constants.hpp>

// The cheapest check comes first: drive and override, then stability of the given cut, growth of
// one vibration, the share of possible cuts, growth of the worst vibration, and last the law as the
// override writes it. An alternative that fails keeps its reason for the report.
namespace steadyrest::chatter::offline {
namespace {

using kernel::units::kInfinity;

constexpr std::size_t kMostLimitPasses = 128;   ///< of a law whose limit depth is sought
constexpr std::size_t kMostLimitWork = 12'000;  ///< likewise, of one that is rejected anyway

std::optional<DelayCycle> cycle_at(const Process& process, double speed_rev_s,
                                   const Modulation& modulation, double depth_mm) {
  DelayCycle::Config config;
  config.speed_rev_s = speed_rev_s;
  config.modulation = modulation;
  config.most_depth_mm = depth_mm;
  auto made = DelayCycle::make(process, config);
  if (!made) {
    return std::nullopt;
  }
  made->set_depth(depth_mm);
  return std::move(*made);
}

/// ln of the growth of one vibration over three periods, from its minimum to its later maximum: a
/// lower bound of the peak growth, and close to it where one solution leads.
double log_growth_seen(DelayCycle& cycle) {
  Eigen::VectorXd state = Eigen::VectorXd::Zero(cycle.state_size());
  for (Eigen::Index i = 0; i < state.size(); ++i) {
    // Any start with a share of every solution will do; a formula instead of a generator gives the
    // same start everywhere.
    state[i] = std::sin(1.0 + 2.3 * static_cast<double>(i));
  }
  double scale = 0.0;
  double least = kInfinity;
  double most = 0.0;
  for (std::size_t k = 0; k < 3 * cycle.passes(); ++k) {
    cycle.advance(k % cycle.passes(), state);
    const double size = state.cwiseAbs().maxCoeff();
    if (!(size > 0.0) || !std::isfinite(size)) {
      break;
    }
    scale += std::log(size);
    state /= size;
    // From its minimum on: a vibration that first dies and then grows counts from the bottom.
    least = std::min(least, scale);
    most = std::max(most, scale - least);
  }
  return most;
}

}  // namespace

AlternativeCheck::AlternativeCheck(const Process& process, const kernel::machine::Machine& machine,
                                   double programmed_rev_s, double depth_mm, double most_depth_mm,
                                   const PlanOptions& options)
    : process_(&process),
      machine_(&machine),
      speed_rev_s_(programmed_rev_s),
      depth_mm_(depth_mm),
      most_depth_mm_(most_depth_mm),
      options_(&options),
      possible_(possible_cuts(process, options.uncertainty)) {}

double AlternativeCheck::probability(const Alternative& a, double depth_mm) const {
  std::atomic<std::size_t> stable{0};
  tbb::parallel_for(std::size_t{0}, possible_.size(), [&](std::size_t i) {
    // A possible cut that the solver refuses counts as unstable.
    auto line = DepthLine::make(possible_[i], speed(a), a.modulation, depth_mm);
    if (line && line->log_radius(depth_mm) < 0.0) {
      ++stable;
    }
  });
  return static_cast<double>(stable.load()) / static_cast<double>(possible_.size());
}

double AlternativeCheck::likely_depth_mm(const Alternative& a) const {
  double low = 0.0;
  double high = depth_mm_;
  // Assumed to fall with the depth. Islands are left to the limit depth.
  while (high - low > 0.01 * depth_mm_) {
    const double middle = 0.5 * (low + high);
    (probability(a, middle) >= options_->least_probability ? low : high) = middle;
  }
  return low;
}

void AlternativeCheck::reject_unlikely(Alternative& a) const {
  a.probability = probability(a, depth_mm_);
  if (*a.probability < options_->least_probability) {
    a.reasons.push_back(
        fmt::format("only {:.0f} % of the possible cuts are stable; {:.0f} % must be",
                    100.0 * *a.probability, 100.0 * options_->least_probability));
  }
}

void AlternativeCheck::reject_below_depth(Alternative& a) const {
  if (!a.stable) {
    a.reasons.push_back(
        fmt::format("unstable{}",
                    a.limit_depth_mm ? fmt::format(" from {:.4g} mm on", *a.limit_depth_mm) : ""));
  } else if (a.limit_depth_mm && *a.limit_depth_mm < depth_mm_) {
    a.reasons.push_back(
        fmt::format("stable again at this depth, but unstable from {:.4g} mm on, and the tool "
                    "passes through that on its way in",
                    *a.limit_depth_mm));
  }
}

void AlternativeCheck::step(Alternative& a) const {
  for (const DriveViolation& violation : a.demand.violations) {
    a.reasons.push_back(violation.reason);
  }
  auto line = DepthLine::make(*process_, speed(a), {}, most_depth_mm_);
  if (!line) {
    a.reasons.push_back(line.error().what);
    return;
  }
  a.limit_depth_mm = limit_depth_mm(*line, most_depth_mm_).value_or(kInfinity);
  // Above a lower border the cut may be stable again; reject_below_depth() decides whether it can
  // be reached.
  a.stable = *a.limit_depth_mm > depth_mm_ || line->log_radius(depth_mm_) < 0.0;
  reject_below_depth(a);
  reject_unlikely(a);
  // Growth at a constant speed rejects nothing; the report shows it.
  if (a.stable) {
    if (auto cycle = cycle_at(*process_, speed(a), {}, depth_mm_)) {
      a.peak_growth = std::exp(std::min(700.0, log_peak_growth(*cycle)));
    }
  }
}

double AlternativeCheck::log_radius(Alternative& law) const {
  auto cycle = cycle_at(*process_, speed(law), law.modulation, depth_mm_);
  if (!cycle) {
    return kInfinity;
  }
  const Stability found = stability(*cycle, {});
  law.stable = found.stable;
  law.log_radius = found.log_radius;
  if (!found.stable) {
    law.reasons.emplace_back("unstable");
  }
  return found.log_radius_per_pass;
}

void AlternativeCheck::judge(Alternative& law) const {
  auto cycle = cycle_at(*process_, speed(law), law.modulation, depth_mm_);
  if (!cycle) {
    return;
  }
  const double most = std::log(options_->most_growth);
  const auto too_much = [&](double log_growth, bool bound) {
    law.peak_growth = std::exp(std::min(700.0, log_growth));
    law.growth_is_lower_bound = bound;
    if (log_growth > most) {
      law.reasons.push_back(
          fmt::format("a vibration grows {}{:.3g}-fold before it dies; {:.3g}-fold is allowed",
                      bound ? "at least " : "", *law.peak_growth, options_->most_growth));
    }
    return log_growth > most;
  };
  // One vibration costs three periods, the worst of all a whole basis: the cheap rejection comes
  // first.
  if (too_much(log_growth_seen(*cycle), true)) {
    return;
  }
  reject_unlikely(law);
  if (law.accepted()) {
    too_much(log_peak_growth(*cycle), false);
  }
  if (law.accepted()) {
    reject_unstable_as_written(law);
  }
}

/// Checks the law as the override writes it: its steps, scans and slew, the drive's ramps.
void AlternativeCheck::reject_unstable_as_written(Alternative& law) const {
  auto course = override_course(*machine_, speed(law), law.modulation);
  if (!course) {
    law.reasons.push_back(course.error().what);
    return;
  }
  DelayCycle::Config config;
  // The course replaces the law; the mean speed below only scales what the course does not give.
  config.course = std::move(*course);
  config.speed_rev_s = speed(law);
  config.most_depth_mm = depth_mm_;
  auto cycle = DelayCycle::make(*process_, config);
  if (!cycle) {
    law.reasons.push_back(cycle.error().what);
    return;
  }
  cycle->set_depth(depth_mm_);
  law.written_log_radius = stability(*cycle, {}).log_radius;
  if (*law.written_log_radius >= 0.0) {
    law.reasons.push_back(
        fmt::format("stable under the ideal law (ln ρ {:.3g}), but unstable as the override writes "
                    "it (ln ρ {:.3g})",
                    law.log_radius.value_or(0.0), *law.written_log_radius));
    return;
  }
  const double grown = log_growth_seen(*cycle);
  if (grown > std::log(options_->most_growth)) {
    law.reasons.push_back(fmt::format(
        "as the override writes the law, a vibration grows at least {:.3g}-fold before it dies; "
        "{:.3g}-fold is allowed",
        std::exp(std::min(700.0, grown)), options_->most_growth));
  }
}

void AlternativeCheck::limit(Alternative& law) const {
  auto line = DepthLine::make(*process_, speed(law), law.modulation, most_depth_mm_);
  const double passes =
      static_cast<double>(process_->even_pitch() ? process_->tool.teeth : 1) / law.modulation.rvf;
  if (!line || passes > static_cast<double>(kMostLimitPasses) ||
      (!law.accepted() && line->work() > kMostLimitWork)) {
    return;
  }
  law.limit_depth_mm = limit_depth_mm(*line, most_depth_mm_).value_or(kInfinity);
  // The only reason is "unstable" without a depth; reject_below_depth() repeats it with the depth.
  if (law.reasons.size() == 1 && !law.stable) {
    law.reasons.clear();
  }
  if (law.reasons.empty()) {
    reject_below_depth(law);
  }
}

}  // namespace steadyrest::chatter::offline
