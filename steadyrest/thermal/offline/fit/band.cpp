// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <tuple>
#include <utility>
#include <vector>

#include <steadyrest/thermal/offline/fit/band.hpp>
#include <steadyrest/thermal/offline/plan/forecast.hpp>

// What the model does not know is one first-order process with RMS d and time constant τ_d. d comes
// from the free-running errors, τ_d from those after a probe, which show how fast the unknown
// returns: variance d²·(1 − e^(−2t/τ_d)). Both are set so that the band keeps its promise on hours
// that were not in the fit.
namespace steadyrest::thermal::offline {
namespace {

constexpr double kWanted = 0.95;
constexpr double kWantedHourly = 0.97;  // a few blocks prove less than they seem to: 95 % of others
constexpr double kMostWider = 10.0;
constexpr double kLeastTau_min = 20.0;
constexpr double kMostTau_min = 2e4;

/// One reading of a left-out block.
struct Sample {
  std::size_t block = 0;
  double since_s = 0.0;  ///< since the probe's last reading
  double error_um = 0.0;
  double known_um2 = 0.0;  ///< variance from parameters and noise
};

double drift_um2(const Sample& s, double drift_um, double tau_s) {
  return drift_um * drift_um * (1.0 - std::exp(-2.0 * s.since_s / tau_s));
}

double covered(const std::vector<Sample>& samples, const std::function<bool(const Sample&)>& which,
               const std::function<double(const Sample&)>& variance_um2) {
  double in = 0.0;
  double all = 0.0;
  for (const Sample& s : samples) {
    if (which(s)) {
      all += 1.0;
      in += s.error_um * s.error_um <= kBand * kBand * (s.known_um2 + variance_um2(s)) ? 1.0 : 0.0;
    }
  }
  return all > 0.0 ? in / all : 1.0;
}

/// The least x of [low, high] with `enough(x)`, a monotone condition. Bisection on the logarithmic
/// scale; 40 steps leave 1e-11.
double least(double low, double high, const std::function<bool(double)>& enough) {
  for (int i = 0; i < 40; ++i) {
    const double middle = std::sqrt(low * high);
    (enough(middle) ? high : low) = middle;
  }
  return high;
}

/// Knowledge from n blocks applied to one more: 1/n of their variance comes on top.
double another(std::size_t blocks) {
  return std::sqrt(1.0 + 1.0 / static_cast<double>(std::max<std::size_t>(blocks, 1)));
}

std::pair<double, double> made_from(const std::vector<Sample>& free,
                                    const std::vector<Sample>& probed, std::size_t blocks,
                                    const std::function<bool(const Sample&)>& which) {
  const double free_drift = least(1e-3, 1e3, [&](double d) {
    return covered(free, which, [&](const Sample&) { return d * d; }) >= kWanted;
  });
  const double probed_drift = least(1e-3, 1e3, [&](double d) {
    return covered(probed, which, [&](const Sample& s) {
             return drift_um2(s, d, 60.0 * kLeastTau_min);
           }) >= kWantedHourly;
  });
  const double drift = std::max(free_drift, probed_drift);
  const double rate = least(1.0 / kMostTau_min, 1.0 / kLeastTau_min, [&](double r) {
    return covered(probed, which, [&](const Sample& s) { return drift_um2(s, drift, 60.0 / r); }) >=
           kWantedHourly;
  });
  // Each block shows the growth within an hour many times, the final spread only once.
  const double more = student(blocks) * another(blocks);
  return {more * drift, 60.0 * std::min(more * more / rate, kMostTau_min)};
}

/// Tests each block with the band from the others.
class Others {
 public:
  // A block that helped to set the band proves nothing about it.
  Others(const std::vector<Sample>& free, const std::vector<Sample>& probed,
         const std::vector<std::size_t>& blocks)
      : free_(free), probed_(probed), blocks_(blocks) {
    for (const std::size_t b : blocks) {
      made_.push_back(made_from(free, probed, blocks.size() - 1,
                                [b](const Sample& s) { return s.block != b; }));
    }
  }

  /// Shares of the readings, running free and probed, inside bands wider by this factor.
  [[nodiscard]] std::pair<double, double> coverage(double wider) const {
    std::pair<double, double> out;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      const double drift = wider * made_[i].first;
      const double tau_s = made_[i].second;
      const auto here = [b = blocks_[i]](const Sample& s) { return s.block == b; };
      const double share = static_cast<double>(std::ranges::count_if(free_, here)) /
                           static_cast<double>(free_.size());
      out.first += share * covered(free_, here, [&](const Sample&) { return drift * drift; });
      out.second += share * covered(probed_, here,
                                    [&](const Sample& s) { return drift_um2(s, drift, tau_s); });
    }
    return out;
  }

 private:
  const std::vector<Sample>& free_;
  const std::vector<Sample>& probed_;
  const std::vector<std::size_t>& blocks_;
  std::vector<std::pair<double, double>> made_;  ///< drift, its time constant
};

}  // namespace

double student(std::size_t blocks) {
  constexpr std::array kT = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262};
  const std::size_t freedom = std::max<std::size_t>(blocks, 2) - 1;
  const double t =
      freedom <= kT.size() ? kT[freedom - 1] : kBand + 2.5 / static_cast<double>(freedom);
  return t / kBand;
}

// Each reading of a left-out block becomes a sample twice: running free, and since the last hourly
// probe. Parameters and noise explain the known part; the drift has to cover the rest.
Band calibrate(const FitData& data, const LeftOut& left_out, const Eigen::MatrixXd& columns,
               const Eigen::MatrixXd& covariance) {
  // Parameters tilt the forecast about the log's mean, since its constant is fitted.
  const Eigen::RowVectorXd middle = columns.colwise().mean();
  const double noise = data.noise_um * data.noise_um;
  std::vector<Sample> free;
  std::vector<Sample> probe;
  const std::vector<std::size_t> reach = data.within_reach();
  for (const std::size_t b : reach) {
    const FitData::Block& block = data.block[b];
    const Eigen::VectorXd residual = left_out.residual_um.segment(
        static_cast<Eigen::Index>(block.begin), static_cast<Eigen::Index>(block.end - block.begin));
    const Eigen::VectorXd zeroed = probed(data, block, residual);
    double zero_s = 0.0;
    Eigen::RowVectorXd zero = columns.row(0);
    for (std::size_t i = block.begin; i < block.end; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const auto k = static_cast<Eigen::Index>(i - block.begin);
      if (k == 0 || data.time_s[i] >= zero_s + kProbeEvery_s) {
        zero_s = data.time_s[i];
        zero = columns.row(row);
      }
      const Eigen::RowVectorXd whole = columns.row(row) - middle;
      const Eigen::RowVectorXd since = columns.row(row) - zero;
      // After a probe two noises count, the probe's and the reading's.
      free.push_back({b, 0.0, residual(k), noise + whole.dot(whole * covariance)});
      probe.push_back(
          {b, data.time_s[i] - zero_s, zeroed(k), 2.0 * noise + since.dot(since * covariance)});
    }
  }
  Band out;
  std::tie(out.drift_um, out.tau_s) =
      made_from(free, probe, reach.size(), [](const Sample&) { return true; });
  const Others others(free, probe, reach);
  std::tie(out.free_coverage, out.probed_coverage) = others.coverage(1.0);
  const auto holds = [&](double wider) {
    const auto [whole, hourly] = others.coverage(wider);
    return whole >= kWanted && hourly >= kWanted;
  };
  if (!holds(1.0)) {
    out.drift_um *= least(1.0, kMostWider, holds);
  }
  return out;
}

}  // namespace steadyrest::thermal::offline
