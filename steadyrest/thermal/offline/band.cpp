// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>
#include <utility>
#include <vector>

#include <steadyrest/thermal/offline/band.hpp>
#include <steadyrest/thermal/offline/forecast.hpp>

namespace steadyrest::thermal::offline {
namespace {

constexpr double kWanted = 0.97;  // a few blocks say less than they seem to: 95 % of others
constexpr double kLeastTau_min = 20.0;
constexpr double kMostTau_min = 2e4;

/// One reading of a left-out block.
struct Sample {
  std::size_t block = 0;
  double since_s = 0.0;  ///< of the probe's last reading
  double error_um = 0.0;
  double known_um2 = 0.0;  ///< variance by parameters and noise
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

/// The least x of [low, high] with `enough(x)`, which only grows true.
double least(double low, double high, const std::function<bool(double)>& enough) {
  for (int i = 0; i < 40; ++i) {
    const double middle = std::sqrt(low * high);
    (enough(middle) ? high : low) = middle;
  }
  return high;
}

/// What is known by n blocks is for one more: 1/n of their variance comes on top.
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
           }) >= kWanted;
  });
  const double drift = std::max(free_drift, probed_drift);
  const double rate = least(1.0 / kMostTau_min, 1.0 / kLeastTau_min, [&](double r) {
    return covered(probed, which, [&](const Sample& s) { return drift_um2(s, drift, 60.0 / r); }) >=
           kWanted;
  });
  // What it does within an hour is seen many times in each block, what it comes to only once.
  const double more = another(blocks);
  return {more * drift, more * more * 60.0 / rate};
}

}  // namespace

Band calibrate(const FitData& data, const LeftOut& left_out, const Eigen::MatrixXd& columns,
               const Eigen::MatrixXd& covariance) {
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
      free.push_back({b, 0.0, residual(k), noise + whole.dot(whole * covariance)});
      probe.push_back(
          {b, data.time_s[i] - zero_s, zeroed(k), 2.0 * noise + since.dot(since * covariance)});
    }
  }
  Band out;
  std::tie(out.drift_um, out.tau_s) =
      made_from(free, probe, reach.size(), [](const Sample&) { return true; });
  const auto rows = static_cast<double>(free.size());
  for (const std::size_t b : reach) {
    const auto [drift, tau_s] =
        made_from(free, probe, reach.size() - 1, [b](const Sample& s) { return s.block != b; });
    const auto here = [b](const Sample& s) { return s.block == b; };
    const double share = static_cast<double>(data.block[b].end - data.block[b].begin) / rows;
    out.free_coverage += share * covered(free, here, [&](const Sample&) { return drift * drift; });
    out.probed_coverage +=
        share * covered(probe, here, [&](const Sample& s) { return drift_um2(s, drift, tau_s); });
  }
  return out;
}

}  // namespace steadyrest::thermal::offline
