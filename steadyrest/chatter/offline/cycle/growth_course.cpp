// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <tbb/parallel_for.h>

#include <steadyrest/chatter/offline/cycle/growth_course.hpp>
#include <steadyrest/chatter/offline/cycle/multipliers.hpp>

// ‖Φ‖_∞ is the largest row sum of moduli: the growth of the vibration, bounded by 1 everywhere at
// the start, that drives this row hardest. Constant speed needs the rows of powers of one map and
// gets them from the adjoint; a modulated period needs a product of different maps and carries all
// columns.
namespace steadyrest::chatter::offline {
namespace {

using Eigen::Index;

// The worst starting pass is not known in advance. With hundreds of passes in a period,
// neighbouring starts differ by one pass in hundreds.
constexpr std::size_t kMostStarts = 16;
constexpr Index kMostRows = 200;          ///< followed one by one
constexpr std::size_t kLeastWindow = 20;  ///< passes
constexpr double kDied = 1e-4;            ///< of its peak; then following ends

/// Whether the vibration has died, which ends the course.
bool died(const std::vector<double>& log_growth, double peak) {
  const double now = log_growth.back();
  // Both conditions: a vibration that fell from a high peak may still be larger than at its start.
  return now < peak + std::log(kDied) && now < 0.0;
}

/// For passes with the same map P: row i of P^k is e_iᵀ·P^k, so each row can be followed
/// separately, and the sum of its moduli is its growth. A low speed has thousands of rows, which
/// change little from one to the next: some are followed, then the neighbours of the worst.
class EvenPasses {
 public:
  EvenPasses(DelayCycle& cycle, std::size_t window)
      : cycle_(cycle),
        rows_(cycle.state_size()),
        log_growth_(window + 1, -std::numeric_limits<double>::infinity()),
        worst_row_(window + 1, 0) {
    log_growth_[0] = 0.0;
  }

  GrowthCourse course(Index modal_rows) {
    const Index apart = (rows_ + kMostRows - 1) / kMostRows;
    std::set<Index> wanted;
    // q and v/ω of the modes are few and unlike each other, so all are followed; neighbouring nodes
    // are nearly alike.
    for (Index i = 0; i < rows_; i += i < modal_rows ? 1 : apart) {
      wanted.insert(i);
    }
    for (const Index i : wanted) {
      follow(i);
    }
    std::set<Index> near;
    for (const Index worst : worst_row_) {
      for (Index i = std::max<Index>(0, worst - apart + 1); i < std::min(rows_, worst + apart);
           ++i) {
        near.insert(i);
      }
    }
    for (const Index i : near) {
      if (!wanted.contains(i)) {
        follow(i);
      }
    }
    GrowthCourse out{.start_pass = 0, .log_growth = {0.0}};
    double peak = 0.0;
    for (std::size_t k = 1; k < log_growth_.size() && std::isfinite(log_growth_[k]); ++k) {
      out.log_growth.push_back(log_growth_[k]);
      if (died(out.log_growth, peak)) {
        break;
      }
      peak = std::max(peak, log_growth_[k]);
    }
    return out;
  }

 private:
  void follow(Index i) {
    Eigen::VectorXd row = Eigen::VectorXd::Unit(rows_, i);
    double log_size = 0.0;
    for (std::size_t k = 1; k < log_growth_.size(); ++k) {
      // eᵢᵀ·P^k by the adjoint: one row at a time, without the whole matrix, which at low speed has
      // thousands of rows.
      cycle_.retreat(0, row);
      const double sum = row.cwiseAbs().sum();
      if (!std::isfinite(sum)) {  // beyond a double's range within one pass
        log_growth_[k] = kBeyondLog;
      }
      if (!(sum > 0.0) || !std::isfinite(sum)) {
        return;
      }
      // Growth of 10¹² and more is common at low speed: kept as a logarithm.
      row /= sum;
      log_size += std::log(sum);
      if (log_size > log_growth_[k]) {
        log_growth_[k] = log_size;
        worst_row_[k] = i;
      }
    }
  }

  DelayCycle& cycle_;
  Index rows_;
  std::vector<double> log_growth_;
  std::vector<Index> worst_row_;
};

/// The map from the pass `begin` on, with all columns: advance() is so cheap that leaving columns
/// out would cost more.
GrowthCourse course_from(DelayCycle& cycle, std::size_t begin, std::size_t window) {
  Eigen::MatrixXd map = Eigen::MatrixXd::Identity(cycle.state_size(), cycle.state_size());
  double log_scale = 0.0;
  double peak = 0.0;
  GrowthCourse out{.start_pass = begin, .log_growth = {0.0}};
  for (std::size_t k = 0; k < window; ++k) {
    for (Index i = 0; i < map.cols(); ++i) {
      cycle.advance((begin + k) % cycle.passes(), map.col(i));
    }
    // Scaled after each pass, so that a growth of 1e300 does not end the course.
    const double norm = map.cwiseAbs().rowwise().sum().maxCoeff();
    if (!(norm > 0.0) || !std::isfinite(norm)) {
      break;
    }
    map /= norm;
    log_scale += std::log(norm);
    out.log_growth.push_back(log_scale);
    if (died(out.log_growth, peak)) {
      break;
    }
    peak = std::max(peak, log_scale);
  }
  return out;
}

}  // namespace

double GrowthCourse::log_peak() const noexcept {
  return *std::ranges::max_element(log_growth);
}

double GrowthCourse::peak() const noexcept {
  // e^710 overflows.
  return std::exp(std::min(kBeyondLog, log_peak()));
}

std::size_t growth_window(const DelayCycle& cycle) noexcept {
  return std::max(2 * cycle.passes(), kLeastWindow);
}

std::vector<GrowthCourse> growth_courses(DelayCycle& cycle) {
  const std::size_t passes = cycle.passes();
  if (passes == 1) {
    return {EvenPasses(cycle, growth_window(cycle)).course(cycle.modal_size())};
  }
  const std::size_t starts = std::min(passes, kMostStarts);
  std::vector<GrowthCourse> out;
  out.resize(starts);
  tbb::parallel_for(std::size_t{0}, starts, [&](std::size_t k) {
    // Starts are independent: one copy each, no locks.
    DelayCycle own = cycle;  // advance() leaves the last pass in it
    out[k] = course_from(own, k * passes / starts, growth_window(own));
  });
  return out;
}

const GrowthCourse& worst(const std::vector<GrowthCourse>& courses) {
  return *std::ranges::max_element(courses, {}, &GrowthCourse::log_peak);
}

}  // namespace steadyrest::chatter::offline
