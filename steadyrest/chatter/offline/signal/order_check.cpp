// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
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
constexpr double kSlowest = 0.25;
constexpr double kFastest = 4.0;
constexpr double kFewOrders = 3.0;
constexpr double kStep = 0.0004;
constexpr double kOtherShare = 0.5;
constexpr double kOtherMore = 0.25;
constexpr double kTeethShare = 0.8;
constexpr double kNotTeeth = 0.5;
constexpr std::size_t kMostTeeth = 16;
constexpr double kSameSpeed = 0.01;
constexpr double kConstant = 0.005;
constexpr std::size_t kFewWindows = 3;

/// Amplitude above the noise in each bin of the mean spectrum.
struct Lines {
  std::vector<double> size;  ///< √ of the power: one line of chatter is not to outweigh all orders
  double bin_hz = 0.0;
  double all = 0.0;
};

std::size_t window_of(double rate_hz) {
  return std::bit_floor(static_cast<std::size_t>(kWindow_s * rate_hz));
}

Lines lines_of(std::span<const double> value, double rate_hz) {
  const std::size_t n = window_of(rate_hz);
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

struct Comb {
  double share = 0.0;
  double orders = 0.0;  ///< that it rests on: (Σ s)²/Σ s²
};

Comb comb_of(const Lines& lines, double speed_rev_s) {
  double bins = 0.0;
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t k = 1; k <= kOrders; ++k) {
    double here = 0.0;
    at(lines, static_cast<double>(k) * speed_rev_s, [&](double size) {
      here += size;
      bins += 1.0;
    });
    sum += here;
    squares += here * here;
  }
  return {.share = sum / lines.all - bins / static_cast<double>(lines.size.size()),
          .orders = squares > 0.0 ? sum * sum / squares : 0.0};
}

/// Period doubling lies at the orders of half the speed; a multiple of the speed has no runout.
bool is_multiple(double ratio) {
  const double whole = std::round(std::max(ratio, 1.0 / ratio));
  return whole > 1.0 && std::abs(std::max(ratio, 1.0 / ratio) / whole - 1.0) <= kTold;
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

double constant_speed(std::span<const double> told_rev_s) {
  double least = std::numeric_limits<double>::infinity();
  double most = 0.0;
  for (const double speed : told_rev_s) {
    least = std::isfinite(speed) ? std::min(least, speed) : least;
    most = std::isfinite(speed) ? std::max(most, speed) : most;
  }
  return most > 0.0 && most - least <= kConstant * most ? 0.5 * (least + most) : 0.0;
}

OrderFindings check_orders(std::span<const double> value, double rate_hz, double told_rev_s,
                           std::size_t teeth) {
  OrderFindings out;
  if (value.size() < window_of(rate_hz)) {
    return out;
  }
  const Lines lines = lines_of(value, rate_hz);
  if (!(lines.all > 0.0)) {
    return out;
  }
  double told_speed = told_rev_s;
  double orders = 0.0;
  const auto search = [&](double from, double to) {
    for (double ratio = from; ratio <= to; ratio *= 1.0 + kStep) {
      if (is_multiple(ratio)) {
        continue;
      }
      const Comb comb = comb_of(lines, ratio * told_rev_s);
      if (std::abs(ratio - 1.0) <= kTold && comb.share > out.told_share) {
        out.told_share = comb.share;
        told_speed = ratio * told_rev_s;
      }
      if (comb.share > out.found_share) {
        out.found_share = comb.share;
        out.speed_rev_s = ratio * told_rev_s;
        orders = comb.orders;
      }
    }
  };
  search(1.0 - kTold, 1.0 + kTold);
  if (out.told_share < kOtherShare) {
    search(kSlowest, kFastest);
  }
  out.known = out.found_share >= kOtherShare;
  // A line of chatter alone is at some order of many a speed.
  out.other_speed =
      out.known && orders >= kFewOrders && out.found_share > out.told_share + kOtherMore;
  if (!out.other_speed) {
    out.speed_rev_s = told_speed;
  }
  out.other_teeth = out.known ? teeth_by(lines, out.speed_rev_s, teeth) : 0;
  return out;
}

namespace {

bool agrees(const OtherCut& a, const OtherCut& b) {
  return std::abs(a.speed_rev_s - b.speed_rev_s) <= kSameSpeed * a.speed_rev_s &&
         a.other_teeth == b.other_teeth;
}

/// Runs of enough windows, each to the middle of the gap between it and the next; without those
/// that are as stated.
std::vector<OtherCut> parts_of(const std::vector<OtherCut>& runs,
                               const std::vector<std::size_t>& windows, std::size_t samples) {
  std::vector<OtherCut> out;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (windows[i] < kFewWindows) {
      continue;
    }
    if (!out.empty() && agrees(out.back(), runs[i])) {
      out.back().end = runs[i].end;
    } else {
      out.push_back(runs[i]);
    }
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    const bool last = i + 1 == out.size();
    out[i].begin = i == 0 ? 0 : out[i - 1].end;
    out[i].end = last ? samples : std::midpoint(out[i].end, out[i + 1].begin);
  }
  std::erase_if(out,
                [](const OtherCut& cut) { return cut.speed_rev_s == 0.0 && cut.other_teeth == 0; });
  return out;
}

}  // namespace

std::vector<OtherCut> other_cuts(std::span<const double> value, std::span<const double> told_rev_s,
                                 double rate_hz, std::size_t teeth) {
  const std::size_t n = window_of(rate_hz);
  std::vector<OtherCut> runs;  // of windows that agree
  std::vector<std::size_t> windows;
  for (std::size_t begin = 0; begin + n <= value.size(); begin += n / 2) {
    const double told = constant_speed(told_rev_s.subspan(begin, n));
    const auto found =
        told > 0.0 ? check_orders(value.subspan(begin, n), rate_hz, told, teeth) : OrderFindings{};
    // Air and windows that two cuts share say nothing.
    if (!found.known || (!found.other_speed && found.told_share < kOtherShare)) {
      continue;
    }
    const OtherCut window{.begin = begin + n / 4,
                          .end = begin + n / 4 + n / 2,
                          .told_rev_s = told,
                          .speed_rev_s = found.other_speed ? found.speed_rev_s : 0.0,
                          .other_teeth = found.other_teeth};
    if (!runs.empty() && agrees(runs.back(), window)) {
      runs.back().end = window.end;
      ++windows.back();
    } else {
      runs.push_back(window);
      windows.push_back(1);
    }
  }
  return parts_of(runs, windows, value.size());
}

}  // namespace steadyrest::chatter::offline
