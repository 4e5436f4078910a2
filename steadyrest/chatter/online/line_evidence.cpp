// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <steadyrest/chatter/online/line_evidence.hpp>

namespace steadyrest::chatter::online {
namespace {

constexpr double kSpeedShown = 0.001;  // relative standard deviation
constexpr double kLeastSd_hz = 1e-9;

}  // namespace

void LineConfidence::add(const Detector::Output& heard) noexcept {
  const double sds = std::abs(heard.line.off_hz) / std::max(heard.line.sd_hz, kLeastSd_hz);
  const double off = heard.line.order > 0.0 ? std::erf(sds / std::numbers::sqrt2) : 1.0;
  sure_ += heard.kind == Detector::Kind::flip ? heard.energy_ratio : off;
  spectra_ += 1.0;
}

double LineConfidence::value() const noexcept {
  return spectra_ > 0.0 ? sure_ / spectra_ * (1.0 - std::exp2(-spectra_)) : 0.0;
}

bool shows_speed(const Detector::Output& heard) noexcept {
  return heard.speed_sd > 0.0 && heard.speed_sd < kSpeedShown;
}

double nearest_mode_hz(std::span<const double> modes_hz, double line_hz) noexcept {
  const auto nearest =
      std::ranges::min_element(modes_hz, {}, [&](double hz) { return std::abs(hz - line_hz); });
  return nearest == modes_hz.end() ? 0.0 : *nearest;
}

}  // namespace steadyrest::chatter::online
