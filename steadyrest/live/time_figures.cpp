// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/live/time_figures.hpp>

namespace steadyrest::live {
namespace {

constexpr double kShortestBin_s = 1e-7;
constexpr double kPerOctave = 16.0;

}  // namespace

void TimeFigures::add(double time_s) noexcept {
  std::size_t bin = kBins - 1;
  if (time_s <= kShortestBin_s) {
    bin = 0;
  } else if (const double at = std::floor(kPerOctave * std::log2(time_s / kShortestBin_s));
             at < static_cast<double>(kBins - 1)) {
    bin = static_cast<std::size_t>(at);
  }
  ++bins_[bin];
  ++count_;
  largest_s_ = std::max(largest_s_, time_s);
}

double TimeFigures::quantile_s(double share) const noexcept {
  const double wanted = std::clamp(share, 0.0, 1.0) * static_cast<double>(count_);
  std::uint64_t passed = 0;
  for (std::size_t i = 0; i < kBins; ++i) {
    passed += bins_[i];
    if (passed > 0 && static_cast<double>(passed) >= wanted) {
      return std::min(largest_s_,
                      kShortestBin_s * std::exp2(static_cast<double>(i + 1) / kPerOctave));
    }
  }
  return 0.0;
}

}  // namespace steadyrest::live
