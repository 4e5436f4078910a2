// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numeric>

#include <unsupported/Eigen/FFT>

#include <steadyrest/chatter/offline/signal/order_check.hpp>
#include <steadyrest/kernel/units/constants.hpp>

namespace steadyrest::chatter::offline {
namespace {

constexpr double kWindow_s = 2.0;
constexpr std::size_t kMostWindows = 40;
constexpr std::size_t kOrders = 40;
constexpr double kNoise = 3.0;     // medians
constexpr double kReach = 0.0005;  // of an order's frequency, to either side
constexpr double kTold = 0.02;
constexpr double kSearched = 0.25;
constexpr double kStep = 0.0004;
constexpr double kOtherShare = 0.5;
constexpr double kOtherMore = 0.25;
constexpr double kTeethShare = 0.8;
constexpr double kNotTeeth = 0.5;
constexpr std::size_t kMostTeeth = 16;

/// Amplitude above the noise in each bin of the mean spectrum.
struct Lines {
  std::vector<double> size;  ///< √ of the power: one line of chatter is not to outweigh all orders
  double bin_hz = 0.0;
  double all = 0.0;
};

Lines lines_of(const std::vector<double>& value, double rate_hz) {
  const std::size_t n = std::bit_floor(static_cast<std::size_t>(kWindow_s * rate_hz));
  const std::size_t hop = std::max(n / 2, (value.size() - n) / kMostWindows + 1);
  Eigen::FFT<double> fft;
  std::vector<std::vector<double>> spectra;
  std::vector<double> loudness;
  std::vector<double> window(n);
  std::vector<std::complex<double>> bins;
  for (std::size_t begin = 0; begin + n <= value.size(); begin += hop) {
    double mean = 0.0;
    std::size_t good = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double v = value[begin + i];
      mean += std::isfinite(v) ? v : 0.0;
      good += std::isfinite(v) ? 1 : 0;
    }
    mean /= static_cast<double>(std::max<std::size_t>(1, good));
    for (std::size_t i = 0; i < n; ++i) {
      const double v = value[begin + i];
      const double phase =
          kernel::units::kTurn * (static_cast<double>(i) + 0.5) / static_cast<double>(n);
      window[i] = (std::isfinite(v) ? v - mean : 0.0) * (1.0 - std::cos(phase));
    }
    fft.fwd(bins, window);
    std::vector<double> power(n / 2);
    for (std::size_t k = 0; k < power.size(); ++k) {
      power[k] = std::norm(bins[k]);
    }
    loudness.push_back(std::accumulate(power.begin(), power.end(), 0.0));
    spectra.push_back(std::move(power));
  }
  std::vector<double> sorted = loudness;
  std::ranges::nth_element(sorted, sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2));
  const double loud = sorted[sorted.size() / 2];
  Lines out{.size = std::vector<double>(n / 2), .bin_hz = rate_hz / static_cast<double>(n)};
  for (std::size_t i = 0; i < spectra.size(); ++i) {
    for (std::size_t k = 0; loudness[i] >= loud && k < out.size.size(); ++k) {
      out.size[k] += spectra[i][k];
    }
  }
  sorted = out.size;
  std::ranges::nth_element(sorted, sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2));
  const double noise = kNoise * sorted[sorted.size() / 2];
  for (double& p : out.size) {
    p = std::sqrt(std::max(0.0, p - noise));
    out.all += p;
  }
  return out;
}

/// The bins at a frequency.
template <class Look>
void at(const Lines& lines, double hz, const Look& look) {
  const double reach_hz = lines.bin_hz + kReach * hz;
  const auto first =
      static_cast<std::size_t>(std::max(0.0, std::ceil((hz - reach_hz) / lines.bin_hz)));
  const auto last = static_cast<std::size_t>((hz + reach_hz) / lines.bin_hz);
  for (std::size_t k = first; k <= last && k < lines.size.size(); ++k) {
    look(lines.size[k]);
  }
}

double share_of(const Lines& lines, double speed_rev_s) {
  double bins = 0.0;
  double sum = 0.0;
  for (std::size_t k = 1; k <= kOrders; ++k) {
    at(lines, static_cast<double>(k) * speed_rev_s, [&](double size) {
      sum += size;
      bins += 1.0;
    });
  }
  return sum / lines.all - bins / static_cast<double>(lines.size.size());
}

std::size_t teeth_by(const Lines& lines, double speed_rev_s, std::size_t told) {
  std::vector<double> energy(kOrders + 1);
  double all = 0.0;
  for (std::size_t k = 1; k <= kOrders; ++k) {
    at(lines, static_cast<double>(k) * speed_rev_s, [&](double size) { energy[k] += size * size; });
    all += energy[k];
  }
  const auto share = [&](std::size_t teeth) {
    double sum = 0.0;
    for (std::size_t k = teeth; k <= kOrders; k += teeth) {
      sum += energy[k];
    }
    return sum / all;
  };
  if (!(all > 0.0) || told > kOrders || share(told) >= kNotTeeth) {
    return 0;
  }
  for (std::size_t teeth = kMostTeeth; teeth >= 2; --teeth) {
    if (teeth != told && share(teeth) >= kTeethShare) {
      return teeth;
    }
  }
  return 0;
}

}  // namespace

OrderFindings check_orders(const std::vector<double>& value, double rate_hz, double told_rev_s,
                           std::size_t teeth) {
  OrderFindings out;
  if (static_cast<double>(value.size()) < kWindow_s * rate_hz) {
    return out;
  }
  const Lines lines = lines_of(value, rate_hz);
  if (!(lines.all > 0.0)) {
    return out;
  }
  double told_speed = told_rev_s;
  for (double ratio = 1.0 - kSearched; ratio <= 1.0 + kSearched; ratio += kStep) {
    const double share = share_of(lines, ratio * told_rev_s);
    const bool told = std::abs(ratio - 1.0) <= kTold;
    if (told && share > out.told_share) {
      out.told_share = share;
      told_speed = ratio * told_rev_s;
    }
    if (share > out.found_share) {
      out.found_share = share;
      out.speed_rev_s = ratio * told_rev_s;
    }
  }
  out.known = out.found_share >= kOtherShare;
  out.other_speed = out.known && out.found_share > out.told_share + kOtherMore;
  if (!out.other_speed) {
    out.speed_rev_s = told_speed;
  }
  out.other_teeth = out.known ? teeth_by(lines, out.speed_rev_s, teeth) : 0;
  return out;
}

}  // namespace steadyrest::chatter::offline
