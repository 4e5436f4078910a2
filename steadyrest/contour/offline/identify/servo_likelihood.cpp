// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>

#include <Eigen/Dense>

#include <steadyrest/contour/offline/identify/servo_likelihood.hpp>

namespace steadyrest::contour::offline {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kRidge = 1e-12;
constexpr double kHopeless = 1e30;
constexpr double kPenalty = 6.0;
constexpr double kLeastLag_s = 2e-5;
constexpr double kSettledShare = 1e-3;  // of the noise's square
constexpr double kBatchLags = 5.0;
/// What is known beforehand; it only bounds the variances of what a record does not show.
constexpr double kPriorLag_s = 0.02;

double& number(ServoLaw& law, Free one) {
  switch (one) {
    case Free::gain:
      return law.gain_1_s;
    case Free::forward:
      return law.feed_forward;
    case Free::lag:
      return law.lag_s;
    case Free::second:
      return law.second;
    case Free::delay:
      return law.delay_s;
    case Free::mode:
      return law.mode_rad_s;
    case Free::damping:
      return law.mode_damping;
    case Free::weight:
      return law.mode_weight;
    case Free::lost:
      break;
  }
  return law.lost;
}

/// Least and most of a number, its finite difference (`relative`: to itself, as its steps are).
struct Range {
  double least;
  double most;
  double step;
  bool relative;
};

Range range_of(Free one, const ServoProblem& problem) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const double h = problem.period_s;
  switch (one) {
    case Free::gain:
      return {0.3, 3000.0, 1e-5, true};
    case Free::forward:
      return {0.0, 1.6, 1e-5, false};
    case Free::lag:
      return {kLeastLag_s, 0.3, 1e-6, false};
    case Free::second:
      return {0.02, 2.0, 1e-4, false};
    case Free::delay:
      return {-h, kMostDelay_s, 1e-6, false};
    case Free::mode:
      return {kTurn * 8.0, 0.8 * std::numbers::pi / h, 1e-5, true};
    case Free::damping:
      return {0.003, 0.3, 1e-4, true};
    case Free::weight:
      return {-3.0, 3.0, 1e-5, false};
    case Free::lost:
      break;
  }
  return {0.0, 1e3, 1e-5, false};
}

std::vector<Free> free_of(const ServoForm& form) {
  std::vector<Free> out;
  for (std::size_t i = 0; i < kFree; ++i) {
    if (form.free[i]) {
      out.push_back(static_cast<Free>(i));
    }
  }
  return out;
}

/// Each row less its filtered past.
void whiten(const std::vector<double>& colour, MatrixXd& columns) {
  const long rows = columns.rows();
  for (long c = 0; c < columns.cols() && !colour.empty(); ++c) {
    const VectorXd from = columns.col(c);
    for (long i = 1; i <= std::min(rows, static_cast<long>(colour.size())); ++i) {
      columns.col(c).tail(rows - i) -=
          colour[static_cast<std::size_t>(i - 1)] * from.head(rows - i);
    }
  }
}

/// Rows that are not in use become 0; nor are those whose filter lacks its past.
void mask(const std::vector<char>& used, std::size_t past, MatrixXd& columns) {
  for (long c = 0; c < columns.cols(); ++c) {
    for (long n = 0; n < columns.rows(); ++n) {
      const auto at = static_cast<std::size_t>(n);
      columns(n, c) = used[at] != 0 && at >= past ? columns(n, c) : 0.0;
    }
  }
}

/// Takes the initial states out of the columns.
void project(const MatrixXd& states, MatrixXd& columns) {
  MatrixXd basis = states;
  for (long i = 0; i < basis.cols(); ++i) {
    const double size = basis.col(i).norm();
    basis.col(i) *= size > 1e-9 ? 1.0 / size : 0.0;
  }
  MatrixXd square = basis.transpose() * basis;
  square.diagonal().array() += kRidge;
  const Eigen::LDLT<MatrixXd> solver(square);
  // Twice, so that little is left of what the first leaves by its rounding.
  for (int i = 0; i < 2; ++i) {
    auto seen = columns.topRows(basis.rows());
    seen -= (basis * solver.solve(basis.transpose() * seen)).eval();
  }
}

/// What the numbers do to one run, −1 for the error at rest, and the residual; through the filter,
/// the initial states projected out, 0 where not in use.
MatrixXd columns_of(const ServoProblem& problem, std::size_t run, const ServoLaw& law,
                    const std::vector<Free>& numbers, const std::vector<double>& colour) {
  const auto& command = problem.command[run];
  const VectorXd y = simulated(law, command, problem.period_s);
  const long count = static_cast<long>(numbers.size());
  MatrixXd out(y.size(), count + 2);
  for (long i = 0; i < count; ++i) {
    ServoLaw moved = law;
    const Free one = numbers[static_cast<std::size_t>(i)];
    const Range range = range_of(one, problem);
    double& value = number(moved, one);
    const double step = range.step * (range.relative ? value : 1.0);
    value += step;
    out.col(i) = (simulated(moved, command, problem.period_s) - y) / step;
  }
  out.col(count).setConstant(-1.0);
  out.col(count + 1) = problem.actual[run] - y;
  MatrixXd states = free_responses(law, problem.period_s, command.size());
  whiten(colour, out);
  whiten(colour, states);
  mask(problem.used[run], colour.size(), out);
  mask(problem.used[run], colour.size(), states);
  project(states, out);
  return out;
}

/// JᵀJ with the residual as the last column, over all runs.
struct Moments {
  MatrixXd all;
  std::size_t samples = 0;

  [[nodiscard]] double square() const { return std::max(0.0, all(all.rows() - 1, all.rows() - 1)); }
};

Moments moments_of(const ServoProblem& problem, const ServoLaw& law,
                   const std::vector<Free>& numbers, const std::vector<double>& colour) {
  Moments out;
  const long size = static_cast<long>(numbers.size()) + 2;
  out.all = MatrixXd::Zero(size, size);
  for (std::size_t run = 0; run < problem.command.size(); ++run) {
    const MatrixXd rows = columns_of(problem, run, law, numbers, colour);
    out.all.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose());
    const auto& used = problem.used[run];
    out.samples += static_cast<std::size_t>(
        std::count(used.begin() + static_cast<std::ptrdiff_t>(std::min(colour.size(), used.size())),
                   used.end(), char{1}));
  }
  out.all = MatrixXd(out.all.selfadjointView<Eigen::Lower>());
  return out;
}

double noise_square(const ServoProblem& problem, const Moments& moments) {
  return moments.square() / std::max(1.0, static_cast<double>(moments.samples)) +
         problem.floor * problem.floor;
}

/// The step that Levenberg and Marquardt take, none out of the range of a number that is at its
/// end already.
VectorXd step_of(const ServoProblem& problem, const Moments& moments, ServoLaw law,
                 const std::vector<Free>& numbers, double damping) {
  const long size = moments.all.rows() - 1;
  const MatrixXd& all = moments.all;
  VectorXd scale(size);
  for (long i = 0; i < size; ++i) {
    scale[i] = all(i, i) > 0.0 ? 1.0 / std::sqrt(all(i, i)) : 0.0;
  }
  std::vector<char> held(static_cast<std::size_t>(size), 0);
  VectorXd out = VectorXd::Zero(size);
  for (bool again = true; again;) {
    MatrixXd left = scale.asDiagonal() * all.topLeftCorner(size, size) * scale.asDiagonal();
    VectorXd right = scale.asDiagonal() * all.col(size).head(size);
    left.diagonal().array() += damping;
    for (long i = 0; i < size; ++i) {
      if (held[static_cast<std::size_t>(i)] != 0 || scale[i] == 0.0) {
        left.row(i).setZero();
        left.col(i).setZero();
        left(i, i) = 1.0;
        right[i] = 0.0;
      }
    }
    out = scale.asDiagonal() * left.ldlt().solve(right);
    again = false;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const Range range = range_of(numbers[i], problem);
      const double value = number(law, numbers[i]);
      const double by = out[static_cast<long>(i)];
      if (held[i] == 0 &&
          ((value <= range.least && by < 0.0) || (value >= range.most && by > 0.0))) {
        held[i] = 1;
        again = true;
      }
    }
  }
  return out;
}

ServoLaw moved_by(const ServoProblem& problem, const ServoLaw& law,
                  const std::vector<Free>& numbers, const VectorXd& step) {
  ServoLaw out = law;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const Range range = range_of(numbers[i], problem);
    double& value = number(out, numbers[i]);
    const double by = step[static_cast<long>(i)];
    value = range.relative ? value * std::exp(std::clamp(by / value, -0.7, 0.7)) : value + by;
    value = std::clamp(value, range.least, range.most);
  }
  out.rest_error += step[step.size() - 1];
  return out;
}

}  // namespace

std::size_t ServoForm::count() const {
  return static_cast<std::size_t>(std::count(std::begin(free), std::end(free), true)) + 1;
}

double ServoFitted::sd(Free one) const {
  if (!form.has(one) || variance.rows() == 0) {
    return 0.0;
  }
  const auto numbers = free_of(form);
  const auto at = std::ranges::find(numbers, one) - numbers.begin();
  return std::sqrt(std::max(0.0, variance(at, at)));
}

ServoFitted fit_law(const ServoProblem& problem, const ServoLaw& start, const ServoForm& form,
                    const std::vector<double>& colour, int most_rounds) {
  const auto numbers = free_of(form);
  ServoFitted out{.law = start, .form = form, .colour = colour, .variance = {}};
  if (!form.has(Free::second)) {
    out.law.second = 0.0;
  }
  if (!form.has(Free::weight)) {
    out.law.mode_weight = 0.0;
  }
  if (!form.has(Free::lost)) {
    out.law.lost = 0.0;
  }
  out.law =
      moved_by(problem, out.law, numbers, VectorXd::Zero(static_cast<long>(numbers.size()) + 1));
  Moments moments = moments_of(problem, out.law, numbers, colour);
  double damping = 1e-4;
  bool settled = false;
  for (int round = 0; round < most_rounds && !settled; ++round) {
    bool better = false;
    for (int tried = 0; tried < 6 && !better; ++tried) {
      const VectorXd step = step_of(problem, moments, out.law, numbers, damping);
      const double promised = step.dot(moments.all.col(step.size()).head(step.size()));
      if (promised < kSettledShare * noise_square(problem, moments)) {
        break;
      }
      const ServoLaw next = moved_by(problem, out.law, numbers, step);
      Moments then = moments_of(problem, next, numbers, colour);
      better = std::isfinite(then.square()) && then.square() <= moments.square();
      if (better) {
        settled = moments.square() - then.square() < kSettledShare * noise_square(problem, then);
        out.law = next;
        moments = std::move(then);
        damping = std::max(damping / 6.0, 1e-12);
      } else {
        damping = std::max(damping, 1e-6) * 8.0;
      }
    }
    settled = settled || !better;
  }
  // A start from which the law grows without bound has no likelihood.
  out.square = std::isfinite(moments.all.sum()) ? moments.square() : kHopeless;
  moments.all.bottomRightCorner(1, 1)(0, 0) = out.square;
  out.samples = moments.samples;
  out.badness = static_cast<double>(out.samples) * std::log(noise_square(problem, moments)) /
                    problem.dispersion +
                kPenalty * static_cast<double>(form.count() + colour.size());
  return out;
}

void put_variance(const ServoProblem& problem, ServoFitted& fitted) {
  const auto numbers = free_of(fitted.form);
  const long size = static_cast<long>(numbers.size()) + 1;
  const auto batch =
      std::max(10L, std::lround(kBatchLags / fitted.law.gain_1_s / problem.period_s));
  MatrixXd left = MatrixXd::Zero(size, size);
  MatrixXd by_batch = MatrixXd::Zero(size, size);
  double batches = 0.0;
  for (std::size_t run = 0; run < problem.command.size(); ++run) {
    const MatrixXd rows = columns_of(problem, run, fitted.law, numbers, fitted.colour);
    left += rows.leftCols(size).transpose() * rows.leftCols(size);
    for (long n = 0; n < rows.rows(); n += batch) {
      const auto part = rows.middleRows(n, std::min(batch, rows.rows() - n));
      const VectorXd sum = part.leftCols(size).transpose() * part.col(size);
      by_batch += sum * sum.transpose();
      batches += part.col(size).isZero(0.0) ? 0.0 : 1.0;
    }
  }
  const double noise = fitted.square / std::max(1.0, static_cast<double>(fitted.samples) -
                                                         static_cast<double>(size)) +
                       problem.floor * problem.floor;
  MatrixXd known = left / noise;
  const std::array<double, 5> prior = {fitted.law.gain_1_s, 1.0, kPriorLag_s, 1.0, kPriorLag_s};
  VectorXd scale(size);
  for (long i = 0; i < size; ++i) {
    if (i + 1 < size) {
      const auto at = static_cast<std::size_t>(numbers[static_cast<std::size_t>(i)]);
      known(i, i) += at < prior.size() ? 1.0 / (prior[at] * prior[at]) : 0.0;
    }
    scale[i] = known(i, i) > 0.0 ? 1.0 / std::sqrt(known(i, i)) : 0.0;
  }
  const MatrixXd balanced = scale.asDiagonal() * known * scale.asDiagonal();
  const MatrixXd by_law = scale.asDiagonal() *
                          balanced.completeOrthogonalDecomposition().pseudoInverse() *
                          scale.asDiagonal();
  const double few = batches > static_cast<double>(size) + 1.0
                         ? batches / (batches - static_cast<double>(size))
                         : 1.0;
  const MatrixXd by_sums = by_law * by_batch * by_law * (few / (noise * noise));
  fitted.variance = by_law;
  fitted.dispersion =
      std::max(1.0, (by_sums.diagonal().array() / by_law.diagonal().array().max(1e-300)).mean());
  for (long i = 0; i < size; ++i) {
    const double more = std::sqrt(std::max(1.0, by_sums(i, i) / std::max(by_law(i, i), 1e-300)));
    fitted.variance.row(i) *= more;
    fitted.variance.col(i) *= more;
  }
}

double mode_gain(const ServoProblem& problem, const ServoFitted& fitted, double rad_s) {
  ServoLaw law = fitted.law;
  law.mode_rad_s = rad_s;
  law.mode_damping = 0.05;
  const ServoForm form = fitted.form.with({Free::weight});
  const Moments moments = moments_of(problem, law, free_of(form), fitted.colour);
  const VectorXd step = step_of(problem, moments, law, free_of(form), 1e-8);
  return step.dot(moments.all.col(step.size()).head(step.size())) / noise_square(problem, moments);
}

}  // namespace steadyrest::contour::offline
