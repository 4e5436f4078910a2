// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include <unsupported/Eigen/FFT>

#include <steadyrest/trial/vibration/vibration_summary.hpp>

// Splits the second half of a cut: what repeats with the tooth or the turn is forced vibration; the
// strongest spectral line of the rest is the chatter.
namespace steadyrest::trial::vibration {
namespace {

constexpr double kUm = 1000.0;
constexpr double kNothing_um = 0.01;

/// Returns half the swing of what repeats; `signal` keeps the rest. The repeating part is averaged
/// over all whole periods, then subtracted.
double take_repeating(std::vector<double>& signal, std::size_t repeat) {
  std::vector<double> mean(repeat, 0.0);
  const std::size_t whole = signal.size() / repeat;
  for (std::size_t i = 0; i < whole * repeat; ++i) {
    mean[i % repeat] += signal[i] / static_cast<double>(whole);
  }
  for (std::size_t i = 0; i < signal.size(); ++i) {
    signal[i] -= mean[i % repeat];
  }
  const auto [low, high] = std::ranges::minmax(mean);
  return 0.5 * (high - low);
}

double rms(const std::vector<double>& signal) {
  double square = 0.0;
  for (const double x : signal) {
    square += x * x;
  }
  return std::sqrt(square / static_cast<double>(signal.size()));
}

}  // namespace

// Hann window against leakage; skips the first two lines, which hold the mean.
std::optional<double> strongest_line_hz(std::vector<double> signal, double step_s) {
  const std::size_t n = signal.size();
  if (n < 16) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < n; ++i) {
    const double phase = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n);
    signal[i] *= 0.5 - 0.5 * std::cos(phase);
  }
  std::vector<std::complex<double>> spectrum;
  Eigen::FFT<double> fft;
  fft.fwd(spectrum, signal);
  std::size_t best = 2;
  for (std::size_t k = 2; k + 1 < n / 2; ++k) {
    best = std::abs(spectrum[k]) > std::abs(spectrum[best]) ? k : best;
  }
  // With a Hann window the logarithms of three neighbours nearly form a parabola.
  const double left = std::log(std::abs(spectrum[best - 1]) + 1e-300);
  const double middle = std::log(std::abs(spectrum[best]) + 1e-300);
  const double right = std::log(std::abs(spectrum[best + 1]) + 1e-300);
  const double bend = left - 2.0 * middle + right;
  const double off = bend < 0.0 ? std::clamp(0.5 * (left - right) / bend, -0.5, 0.5) : 0.0;
  return (static_cast<double>(best) + off) / (static_cast<double>(n) * step_s);
}

void VibrationSummary::add(const Moment& now) {
  const auto& x = now.cut.displacement_mm;
  const auto& f = now.cut.force_n;
  seen_.peak_um = std::max(seen_.peak_um, kUm * std::hypot(x[0], x[1]));
  seen_.force_peak_n = std::max(seen_.force_peak_n, std::hypot(f[0], f[1]));
  seen_.power_peak_w = std::max(seen_.power_peak_w, now.cut.power_w);
  // The first half is for the entry to die away.
  if (now.t_s < half_s_) {
    return;
  }
  step_s_ = now.cut.period_s;
  if (repeat_ > 0) {
    displacement_mm_.push_back(x);
  }
  if (now.cut.wall) {
    const double wall = now.cut.wall_mm;
    wall_low_mm_ = walls_ == 0 ? wall : std::min(wall_low_mm_, wall);
    wall_high_mm_ = walls_ == 0 ? wall : std::max(wall_high_mm_, wall);
    wall_sum_mm_ += wall;
    ++walls_;
  }
}

Summary VibrationSummary::summary() const {
  Summary out = seen_;
  if (walls_ > 0) {
    out.wall_error_um = kUm * wall_sum_mm_ / static_cast<double>(walls_);
    out.wall_range_um = kUm * (wall_high_mm_ - wall_low_mm_);
  }
  if (repeat_ == 0 || displacement_mm_.size() < 4 * repeat_) {
    return out;
  }
  double most = -1.0;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    std::vector<double> signal;
    signal.reserve(displacement_mm_.size());
    for (const auto& x : displacement_mm_) {
      signal.push_back(kUm * x[axis]);
    }
    const double forced = take_repeating(signal, repeat_);
    // The axis that vibrates more represents the cut.
    const double rest = rms(signal);
    if (std::hypot(forced, rest) > most) {
      most = std::hypot(forced, rest);
      out.forced_um = forced;
      out.rest_rms_um = rest;
      out.frequency_hz =
          rest > kNothing_um ? strongest_line_hz(std::move(signal), step_s_) : std::nullopt;
    }
  }
  return out;
}

}  // namespace steadyrest::trial::vibration
