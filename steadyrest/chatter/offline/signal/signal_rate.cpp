// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include <steadyrest/chatter/offline/signal/signal_rate.hpp>

namespace steadyrest::chatter::offline {
namespace {

constexpr double kBeta = 7.857;  // 80 dB
constexpr std::size_t kHalfTaps = 13;

/// Half of the even filter, from its middle; its sum over both sides is 1.
std::vector<double> low_pass(std::size_t divisor) {
  // 80 dB over 0.2 of the new rate need 25 taps for each old sample in a new one.
  const std::size_t half = kHalfTaps * divisor;
  std::vector<double> out;
  double sum = 0.0;
  for (std::size_t j = 0; j <= half; ++j) {
    const double place = static_cast<double>(j) / static_cast<double>(half);
    const double x = std::numbers::pi * static_cast<double>(j) / static_cast<double>(divisor);
    const double window = std::cyl_bessel_i(0.0, kBeta * std::sqrt(1.0 - place * place));
    out.push_back(window * (j == 0 ? 1.0 : std::sin(x) / x));
    sum += j == 0 ? out.back() : 2.0 * out.back();
  }
  for (double& tap : out) {
    tap /= sum;
  }
  return out;
}

}  // namespace

void reduce_rate(RecordedSignal& signal) {
  signal.recorded_hz = signal.rate_hz;
  constexpr double kRounded = 1.0 - 1e-6;  // stamps are
  const auto divisor =
      static_cast<std::size_t>(std::ceil(kRounded * signal.rate_hz / kDetectorRate_hz));
  if (divisor <= 1) {
    signal.rate_hz = std::min(signal.rate_hz, kDetectorRate_hz);
    return;
  }
  const std::vector<double> half = low_pass(divisor);
  const std::vector<double>& from = signal.value;
  const auto [least, most] = finite_range(from);
  std::vector<double> value;
  for (std::size_t at = 0; at < from.size(); at += divisor) {
    double sum = half[0] * from[at];
    for (std::size_t j = 1; j < half.size(); ++j) {
      sum += half[j] * (from[at - std::min(j, at)] + from[std::min(at + j, from.size() - 1)]);
    }
    // A dead sensor stays one. A gap widens by the filter's length.
    value.push_back(least == most && std::isfinite(sum) ? least : sum);
    if (!signal.speed_rev_s.empty()) {
      signal.speed_rev_s[at / divisor] = signal.speed_rev_s[at];
    }
  }
  if (!signal.speed_rev_s.empty()) {
    signal.speed_rev_s.resize(value.size());
  }
  signal.value = std::move(value);
  signal.rate_hz = std::min(signal.rate_hz / static_cast<double>(divisor), kDetectorRate_hz);
}

}  // namespace steadyrest::chatter::offline
