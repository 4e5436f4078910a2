// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <span>

#include <steadyrest/apps/live_page/vibration_spectrum.hpp>

namespace steadyrest::apps::live_page {
namespace {

constexpr double kWindow_s = 0.2;
constexpr double kShortest = 64.0;
constexpr double kLongest = 65'536.0;
constexpr double kMemory = 0.25;  ///< share of a new window in the average

}  // namespace

void VibrationSpectrum::begin(double rate_hz) {
  rate_hz_ = rate_hz;
  fresh_ = false;
  waiting_.clear();
  power_.clear();
  loudest_.clear();
  // The power of two that is nearest.
  const double wanted = std::clamp(1.5 * kWindow_s * rate_hz, kShortest, kLongest);
  const std::size_t n = std::bit_floor(static_cast<std::size_t>(wanted));
  window_.resize(n);
  windowed_.resize(n);
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    window_[i] = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(i) /
                                      static_cast<double>(n));
    sum += window_[i];
  }
  for (double& weight : window_) {
    weight *= 2.0 / sum;  // of the two halves of the spectrum one is shown
  }
}

void VibrationSpectrum::add(std::span<const double> readings, double rate_hz) {
  if (rate_hz != rate_hz_) {
    begin(std::isfinite(rate_hz) && rate_hz > 0.0 ? rate_hz : 0.0);
  }
  if (!(rate_hz_ > 0.0)) {
    return;
  }
  for (const double reading : readings) {
    waiting_.push_back(std::isfinite(reading) ? reading : 0.0);
    if (waiting_.size() == window_.size()) {
      transform();
      waiting_.erase(waiting_.begin(),
                     waiting_.begin() + static_cast<std::ptrdiff_t>(window_.size() / 2));
    }
  }
}

void VibrationSpectrum::transform() {
  for (std::size_t i = 0; i < window_.size(); ++i) {
    windowed_[i] = window_[i] * waiting_[i];
  }
  fft_.fwd(lines_, windowed_);
  const bool first = power_.empty();
  power_.resize(window_.size() / 2, 0.0);
  loudest_.resize(power_.size(), 0.0);
  for (std::size_t i = 0; i < power_.size(); ++i) {
    const double power = std::norm(lines_[i]);
    power_[i] += (first ? 1.0 : kMemory) * (power - power_[i]);
    loudest_[i] = std::max(loudest_[i], power);
  }
  fresh_ = true;
}

double VibrationSpectrum::line_hz() const noexcept {
  return rate_hz_ / static_cast<double>(window_.size());
}

VibrationSpectrum::Merged VibrationSpectrum::merged(double most_hz,
                                                    std::size_t most) const noexcept {
  const std::size_t below_half_rate = window_.size() / 2 - 1;
  const double last = std::clamp(most_hz / line_hz(), 1.0, static_cast<double>(below_half_rate));
  const std::size_t lines = static_cast<std::size_t>(last) + 1;
  return {.lines = lines, .together = (lines + most - 1) / most};
}

VibrationSpectrum::Lines VibrationSpectrum::lines(double most_hz, std::size_t most) const {
  Lines out;
  if (power_.empty() || most == 0) {
    return out;
  }
  const Merged of = merged(most_hz, most);
  for (std::size_t i = 0; i < of.lines; i += of.together) {
    const auto from = power_.begin() + static_cast<std::ptrdiff_t>(i);
    const auto to =
        power_.begin() + static_cast<std::ptrdiff_t>(std::min(i + of.together, of.lines));
    const auto peak = std::max_element(from, to);
    out.hz.push_back(line_hz() * static_cast<double>(peak - power_.begin()));
    out.amplitude.push_back(std::sqrt(*peak));
  }
  return out;
}

VibrationSpectrum::Bands VibrationSpectrum::take_bands(double most_hz, std::size_t most) {
  Bands out;
  if (loudest_.empty() || most == 0) {
    return out;
  }
  const Merged of = merged(most_hz, most);
  out.band_hz = line_hz() * static_cast<double>(of.together);
  for (std::size_t i = 0; i < of.lines; i += of.together) {
    const auto band = std::span(loudest_).subspan(i, std::min(of.together, of.lines - i));
    const double db = 10.0 * std::log10(std::ranges::max(band));  // −∞ of silence
    out.level_db.push_back(static_cast<int>(std::lround(std::max<double>(db, kSilence_db))));
  }
  loudest_.clear();
  return out;
}

}  // namespace steadyrest::apps::live_page
