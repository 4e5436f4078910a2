// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <steadyrest/motion/online/edges/cycle_monitor.hpp>
#include <steadyrest/motion/online/estimator/refusal.hpp>

namespace steadyrest::motion::online {
namespace {

constexpr double kMissRatio = 1.5;  // midway between one period and two
// Stamps in a row that go back; one or two are bad stamps. Test GoesOnAfterTheClockWasSetBack.
constexpr int kClockWasSet = 3;
constexpr double kBinUnitS = 1e-9;

}  // namespace

kernel::outcome::Result<CycleMonitor> CycleMonitor::make(const Config& config) {
  if (!(config.nominal_period_s >= 0.0 && config.nominal_period_s <= 1.0)) {
    return std::unexpected(refuse_config(
        "nominal period " + std::to_string(config.nominal_period_s) + " s is not within 0…1"));
  }
  if (!(config.gap_cycles > kMissRatio)) {
    return std::unexpected(
        refuse_config("gap of " + std::to_string(config.gap_cycles) + " cycles is not above 1.5"));
  }
  return CycleMonitor(config);
}

void CycleMonitor::reset() noexcept {
  started_ = false;
  learnt_ = 0;
  in_a_row_ = 0;
  has_previous_ = false;
  mean_ = squares_ = products_ = sum_first_ = sum_second_ = 0.0;
  pairs_ = 0;
  histogram_.fill(0);
  report_ = {};
  report_.nominal_period_s = config_.nominal_period_s;
}

void CycleMonitor::update(double t_s) noexcept {
  if (!std::isfinite(t_s)) {
    ++report_.not_finite;
    return;
  }
  const bool first = !started_;
  if (!first && t_s <= last_s_) {
    ++report_.backwards;
    // One or two stamps that go back are bad stamps; three mean that the clock was set.
    if (++in_a_row_ < kClockWasSet) {
      return;
    }
  }
  const bool jumped = in_a_row_ >= kClockWasSet;
  const double period_s = t_s - last_s_;
  started_ = true;
  last_s_ = t_s;
  in_a_row_ = 0;
  if (first || jumped) {
    has_previous_ = false;
    return;
  }
  if (report_.nominal_period_s > 0.0) {
    take(period_s);
  } else {
    learn(period_s);
  }
}

/// The first periods are kept until their median is known, then counted.
void CycleMonitor::learn(double period_s) noexcept {
  first_.at(learnt_) = period_s;
  if (++learnt_ < kLearn) {
    return;
  }
  std::array<double, kLearn> sorted = first_;
  // The median: a few missed cycles among the first must not shift the nominal period.
  std::nth_element(sorted.begin(), sorted.begin() + kLearn / 2, sorted.end());
  report_.nominal_period_s = sorted[kLearn / 2];
  for (const double period : first_) {
    take(period);
  }
}

void CycleMonitor::take(double period_s) noexcept {
  const double ratio = period_s / report_.nominal_period_s;
  if (ratio <= kMissRatio) {
    count(period_s);
    return;
  }
  has_previous_ = false;
  if (ratio > config_.gap_cycles) {
    ++report_.gaps;
    report_.longest_gap_s = std::max(report_.longest_gap_s, period_s);
  } else {
    report_.missed_cycles += static_cast<std::uint64_t>(std::llround(ratio)) - 1;
  }
}

void CycleMonitor::count(double period_s) noexcept {
  const double deviation = period_s - report_.nominal_period_s;
  ++report_.periods;
  const double step = deviation - mean_;
  // Welford, on deviations: squares of whole periods would lose the jitter's digits.
  mean_ += step / static_cast<double>(report_.periods);
  squares_ += step * (deviation - mean_);
  if (has_previous_) {
    products_ += previous_ * deviation;
    sum_first_ += previous_;
    sum_second_ += deviation;
    ++pairs_;
  }
  previous_ = deviation;
  has_previous_ = true;
  const bool only = report_.periods == 1;
  report_.shortest_s = only ? period_s : std::min(report_.shortest_s, period_s);
  report_.longest_s = only ? period_s : std::max(report_.longest_s, period_s);
  ++histogram_.at(bin_of(std::abs(deviation)));
}

std::size_t CycleMonitor::bin_of(double deviation_s) noexcept {
  const double units = deviation_s / kBinUnitS;
  if (units < 1.0) {
    return static_cast<std::size_t>(units * kSubBins);
  }
  int exponent = 0;
  const double fraction = std::frexp(units, &exponent);  // units = fraction·2^exponent, ½ … 1
  const auto sub = static_cast<std::size_t>((2.0 * fraction - 1.0) * kSubBins);
  const auto octave = static_cast<std::size_t>(std::min(exponent, kOctaves));
  return octave * std::size_t{kSubBins} + sub;
}

double CycleMonitor::upper_edge_s(std::size_t bin) noexcept {
  const auto octave = static_cast<int>(bin / std::size_t{kSubBins});
  const double share = static_cast<double>(bin % std::size_t{kSubBins} + 1) / kSubBins;
  return kBinUnitS * (octave == 0 ? share : std::ldexp(1.0 + share, octave - 1));
}

double CycleMonitor::quantile_s(double share) const noexcept {
  const auto wanted =
      static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(report_.periods)));
  std::uint64_t below = 0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    below += histogram_.at(bin);
    if (below >= wanted && below > 0) {
      const double most = std::max(report_.longest_s - report_.nominal_period_s,
                                   report_.nominal_period_s - report_.shortest_s);
      return std::min(upper_edge_s(bin), most);
    }
  }
  return 0.0;
}

CycleMonitor::Report CycleMonitor::report() const noexcept {
  Report out = report_;
  if (out.periods == 0) {
    return out;
  }
  const auto n = static_cast<double>(out.periods);
  out.mean_period_s = out.nominal_period_s + mean_;
  out.period_rms_s = std::sqrt(squares_ / n);
  // A period is the difference of two ticks, each with σ_t: σ_p = √2·σ_t if they are independent.
  out.tick_rms_s = out.period_rms_s / std::numbers::sqrt2;
  if (pairs_ > 0 && squares_ > 0.0) {
    const auto pairs = static_cast<double>(pairs_);
    // E(p·p′) − m·E(p) − m·E(p′) + m².
    const double covariance =
        (products_ - mean_ * (sum_first_ + sum_second_)) / pairs + mean_ * mean_;
    out.period_correlation = std::clamp(covariance / (squares_ / n), -1.0, 1.0);
  }
  out.deviation_p999_s = quantile_s(0.999);
  return out;
}

// README, "Jitter": RMS of v̂ − v without its constant lag, ticks independent with σ_t.
double velocity_jitter_error_mm_s(double velocity_mm_s, double acceleration_mm_s2, double period_s,
                                  double tick_rms_s) noexcept {
  return std::numbers::sqrt2 * tick_rms_s * std::abs(velocity_mm_s / period_s - acceleration_mm_s2);
}

// Second difference of the ticks: weights 1, −2, 1, hence √6.
double acceleration_jitter_error_mm_s2(double velocity_mm_s, double period_s,
                                       double tick_rms_s) noexcept {
  return std::sqrt(6.0) * tick_rms_s * std::abs(velocity_mm_s) / (period_s * period_s);
}

}  // namespace steadyrest::motion::online
