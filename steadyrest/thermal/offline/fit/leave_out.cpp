// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <steadyrest/thermal/offline/fit/leave_out.hpp>
#include <steadyrest/thermal/offline/log/lagged.hpp>

// Successive rows are nearly copies of each other, so single left-out rows would be forecast from
// their neighbours. Whole runs are left out instead, each with its warm-up and cooling.
namespace steadyrest::thermal::offline {
namespace {

constexpr double kWorth = 0.03;  ///< 3 % of the error justifies no parameter
constexpr double kMostWorse = 0.1;

double mean_square(const Eigen::VectorXd& v) {
  return v.size() == 0 ? 0.0 : v.squaredNorm() / static_cast<double>(v.size());
}

/// If a stretch of the log begins inside a left-out block, its initial state is unknown: the
/// forecast starts cold.
Eigen::MatrixXd cold(Eigen::MatrixXd columns, const Structure& structure, const FitData& data,
                     const FitData::Block& block) {
  const std::vector<std::size_t> starts = stretches(*data.log);
  const Eigen::Index first =
      columns.cols() - static_cast<Eigen::Index>(structure.mode.size() * starts.size());
  for (std::size_t s = 0; s < starts.size(); ++s) {
    const std::size_t begin = block.begin == 0 ? 0 : data.row[block.begin];
    if (starts[s] >= begin && starts[s] <= data.row[block.end - 1]) {
      for (std::size_t m = 0; m < structure.mode.size(); ++m) {
        columns.col(first + static_cast<Eigen::Index>(m * starts.size() + s)).setZero();
      }
    }
  }
  return columns;
}

}  // namespace

// ln of the geometric mean of both RMS errors: a difference of 0.03 is 3 % of the error. Below
// kGoodEnough_um a smaller error is worthless, and the logarithm must not run away.
double block_loss(double free_ms_um2, double probed_ms_um2) {
  constexpr double kGood = kGoodEnough_um * kGoodEnough_um;
  return 0.25 * (std::log(free_ms_um2 + kGood) + std::log(probed_ms_um2 + kGood));
}

Eigen::VectorXd probed(const FitData& data, const FitData::Block& block,
                       const Eigen::VectorXd& residual_um) {
  Eigen::VectorXd out(residual_um.size());
  double zero = 0.0;
  double next_s = -std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    const double t = data.time_s[block.begin + static_cast<std::size_t>(i)];
    // A probe resets the zero to its reading; it cannot see how the error grows until the next one.
    if (t >= next_s) {
      zero = residual_um(i);
      next_s = t + kProbeEvery_s;
    }
    out(i) = residual_um(i) - zero;
  }
  return out;
}

LeftOut leave_out(const Structure& structure, const FitData& data, const ErrorModel& error,
                  const LinearPrior& prior) {
  LeftOut out;
  const Eigen::MatrixXd whole = columns_of(structure, *data.log, data.row);
  out.residual_um = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(data.rows()),
                                              std::numeric_limits<double>::quiet_NaN());
  double free_sum = 0.0;
  double probed_sum = 0.0;
  double rows = 0.0;
  const std::vector<std::size_t> reach = data.within_reach();
  for (std::size_t b = 0; b < data.block.size(); ++b) {
    const FitData::Block& block = data.block[b];
    const Eigen::MatrixXd columns = cold(whole, structure, data, block);
    const LinearFit fit = fit_linear(columns, data, error, prior, RowRange{block.begin, block.end});
    const auto begin = static_cast<Eigen::Index>(block.begin);
    const auto count = static_cast<Eigen::Index>(block.end - block.begin);
    Eigen::VectorXd residual =
        data.reading_um.segment(begin, count) - columns.middleRows(begin, count) * fit.amplitude;
    if (b == 0) {  // nobody can forecast the log's zero
      residual.array() -= residual(0);
    }
    out.residual_um.segment(begin, count) = residual;
    const double free_ms = mean_square(residual);
    const double probed_ms = mean_square(probed(data, block, residual));
    out.free_um.push_back(std::sqrt(free_ms));
    out.probed_um.push_back(std::sqrt(probed_ms));
    out.loss.push_back(block_loss(free_ms, probed_ms));
    out.mean_loss += out.loss.back() / static_cast<double>(data.block.size());
    // The RMS reported to the user excludes speeds for which no forecast is made; the loss, which
    // only compares structures, includes all blocks.
    if (std::ranges::binary_search(reach, b)) {
      free_sum += free_ms * static_cast<double>(count);
      probed_sum += probed_ms * static_cast<double>(count);
      rows += static_cast<double>(count);
    }
  }
  out.free_rms_um = std::sqrt(free_sum / std::max(rows, 1.0));
  out.probed_rms_um = std::sqrt(probed_sum / std::max(rows, 1.0));
  return out;
}

// Paired by blocks: a hard block is hard for both, and the difference shows which copes better. The
// standard error of the mean difference is the yardstick.
bool as_good(const LeftOut& a, const LeftOut& b) {
  const auto n = static_cast<double>(a.loss.size());
  double mean = 0.0;
  for (std::size_t i = 0; i < a.loss.size(); ++i) {
    mean += (a.loss[i] - b.loss[i]) / n;
  }
  double square = 0.0;
  for (std::size_t i = 0; i < a.loss.size(); ++i) {
    const double d = a.loss[i] - b.loss[i] - mean;
    square += d * d;
  }
  return mean <= std::max(std::min(std::sqrt(square / (n - 1.0) / n), kMostWorse), kWorth);
}

}  // namespace steadyrest::thermal::offline
