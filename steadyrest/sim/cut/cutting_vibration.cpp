// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <steadyrest/sim/base/range.hpp>
#include <steadyrest/sim/cut/cutting_vibration.hpp>

// Bridges two clocks: the process steps evenly in angle, the machine's cycles and the sensor's
// samples in time. The remainder is carried over, so no time is lost or counted twice.
namespace steadyrest::sim {
namespace {

constexpr double kLongestCycle_s = 1.0;

/// Steps after which forced vibration repeats: with each tooth where all teeth are alike, else with
/// each turn.
std::size_t repeat_of(const Cutting& cut, std::size_t steps) {
  const auto differ = [](const std::vector<double>& values) {
    return !values.empty() && std::ranges::minmax(values).min < std::ranges::minmax(values).max;
  };
  return differ(cut.pitch_rad) || differ(cut.runout_mm) ? steps : steps / cut.teeth;
}

}  // namespace

kernel::outcome::Result<CuttingVibration> CuttingVibration::make(const Config& config) {
  if (auto ok = in_range("cut", {{"sensor_rate_hz", config.sensor_rate_hz, 100.0, 1e6}}); !ok) {
    return std::unexpected(ok.error());
  }
  auto process = CuttingProcess::make({.cut = config.cut,
                                       .slowest_rev_s = config.slowest_rev_s,
                                       .steps_per_period = config.steps_per_period});
  if (!process) {
    return std::unexpected(process.error());
  }
  return CuttingVibration(config, *std::move(process));
}

CuttingVibration::CuttingVibration(const Config& config, CuttingProcess process)
    : process_(std::move(process)),
      slowest_rev_s_(config.slowest_rev_s),
      per_tooth_(1.0 / static_cast<double>(config.cut.teeth)),
      rate_hz_(config.sensor_rate_hz),
      pass_mm_(repeat_of(config.cut, process_.steps())) {
  samples_.reserve(static_cast<std::size_t>(std::ceil(kLongestCycle_s * rate_hz_)));
}

void CuttingVibration::begin_cycle() noexcept {
  samples_.clear();
  cycle_ = {};
}

/// A new cut has no earlier tooth for comparison.
void CuttingVibration::forget() noexcept {
  kept_ = 0;
}

void CuttingVibration::take(const CuttingProcess::Output& now) noexcept {
  const double dt = now.period_s;
  const std::array<double, 2>& x = now.displacement_mm;
  std::array<double, 2>& before = pass_mm_[at_];
  for (std::size_t i = 0; i < 2; ++i) {
    cycle_.sum_mm_s[i] += x[i] * dt;
    cycle_.square_mm2_s[i] += x[i] * x[i] * dt;
    if (kept_ == pass_mm_.size()) {
      const double change = x[i] - before[i];
      // (x(θ) − x(θ − pitch))/√2: forced vibration repeats and drops out, regenerative does not.
      // The half preserves the RMS of what does not repeat.
      cycle_.unforced_mm2_s += 0.5 * change * change * dt;
    }
  }
  before = x;
  at_ = at_ + 1 == pass_mm_.size() ? 0 : at_ + 1;
  kept_ = std::min(kept_ + 1, pass_mm_.size());
  cycle_.cutting_s += dt;
  const auto size = [](const std::array<double, 2>& v) {
    return std::sqrt(v[0] * v[0] + v[1] * v[1]);
  };
  cycle_.peak_mm = std::max(cycle_.peak_mm, size(x));
  cycle_.force_peak_n = std::max(cycle_.force_peak_n, size(now.force_n));
  cycle_.power_peak_w = std::max(cycle_.power_peak_w, now.power_w);
  cycle_.chip_peak_mm = std::max(cycle_.chip_peak_mm, now.chip_mm);
  if (now.wall) {
    const bool first = cycle_.walls == 0;
    cycle_.wall_low_mm = first ? now.wall_mm : std::min(cycle_.wall_low_mm, now.wall_mm);
    cycle_.wall_high_mm = first ? now.wall_mm : std::max(cycle_.wall_high_mm, now.wall_mm);
    cycle_.wall_sum_mm += now.wall_mm;
    ++cycle_.walls;
  }
}

// The sensor sits on the machine: it hears X and Y together, whatever the direction of feed.
// Velocity, as from a geophone or an integrated accelerometer.
void CuttingVibration::sense(const CuttingProcess::Output& now,
                             const std::array<double, 2>& direction) noexcept {
  const auto& v = now.velocity_mm_s;
  // From the feed's frame to the machine's X and Y.
  const double along_x = direction[0] * v[0] - direction[1] * v[1];
  const double along_y = direction[1] * v[0] + direction[0] * v[1];
  const double reading = along_x + along_y;
  const double dt = now.period_s;
  while (next_sample_s_ < dt && samples_.size() < samples_.capacity()) {
    // Steps are even in angle, samples in time.
    samples_.push_back(last_mm_s_ + (reading - last_mm_s_) * next_sample_s_ / dt);
    next_sample_s_ += 1.0 / rate_hz_;
  }
  next_sample_s_ = std::max(next_sample_s_ - dt, 0.0);
  last_mm_s_ = reading;
}

void CuttingVibration::advance(const Input& input) noexcept {
  const double turning_rev_s = std::abs(input.speed_rev_s);
  // Below half of the slowest speed the process has too few steps for the modes: it rings down in
  // air at that speed instead, while the clock runs on.
  const bool in_cut =
      input.in_cut && turning_rev_s > 0.5 * slowest_rev_s_ && input.path_speed_mm_s > 0.0;
  const double speed = std::max(turning_rev_s, 0.5 * slowest_rev_s_);
  if (!in_cut) {
    forget();
  }
  due_s_ += input.period_s;
  const CuttingProcess::Input step{
      .speed_rev_s = speed,
      .feed_per_tooth_mm = in_cut ? input.path_speed_mm_s / speed * per_tooth_ : 0.0,
      .in_cut = in_cut,
      .feed_direction = input.feed_direction};
  const double step_s = 1.0 / (speed * static_cast<double>(process_.steps()));
  while (due_s_ >= step_s) {
    const CuttingProcess::Output now = process_.step(step);
    due_s_ -= now.period_s;
    sense(now, input.feed_direction);
    if (in_cut) {
      take(now);
    }
  }
}

}  // namespace steadyrest::sim
