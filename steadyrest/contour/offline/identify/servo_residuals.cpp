// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include <steadyrest/contour/offline/identify/servo_fit.hpp>
#include <steadyrest/contour/offline/identify/servo_likelihood.hpp>

namespace steadyrest::contour::offline {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMostColour = 8;
constexpr double kStateRidge = 1e-12;
constexpr long kLeastUsed = 20;

}  // namespace

ServoProblem problem_of(const ServoLog& log, const std::vector<ServoRun>& runs,
                        const std::vector<ServoRun>& moving, double period_s, double floor) {
  ServoProblem out;
  out.period_s = period_s;
  out.floor = floor;
  const auto margin = static_cast<std::size_t>(std::ceil(kMostDelay_s / period_s)) + 1;
  for (const ServoRun& run : runs) {
    std::vector<char> used(run.last - run.first + 1, 0);
    for (const ServoRun& part : moving) {
      for (std::size_t n = std::max(part.first, run.first + margin);
           n <= part.last && n + 2 <= run.last; ++n) {
        used[n - run.first] = 1;
      }
    }
    if (std::ranges::count(used, char{1}) < kLeastUsed) {
      continue;
    }
    const auto at = [](const std::vector<double>& from, std::size_t n) {
      return from.begin() + static_cast<std::ptrdiff_t>(n);
    };
    out.command.emplace_back(at(log.command, run.first), at(log.command, run.last + 1));
    out.actual.emplace_back(Eigen::Map<const VectorXd>(
        log.actual.data() + run.first, static_cast<long>(run.last - run.first + 1)));
    out.used.push_back(std::move(used));
  }
  return out;
}

ServoProblem first_of(const ServoProblem& problem, std::size_t most) {
  ServoProblem out = problem;
  std::size_t seen = 0;
  for (std::size_t run = 0; run < problem.used.size(); ++run) {
    for (std::size_t n = 0; n < problem.used[run].size(); ++n) {
      seen += problem.used[run][n] != 0 ? 1 : 0;
      if (seen == most) {
        out.command.resize(run + 1);
        out.actual.resize(run + 1);
        out.used.resize(run + 1);
        out.command[run].resize(n + 1);
        out.actual[run].conservativeResize(static_cast<long>(n) + 1);
        out.used[run].resize(n + 1);
        return out;
      }
    }
  }
  return out;
}

double behind_s(const ServoProblem& problem) {
  double product = 0.0;
  double square = 1e-300;
  for (std::size_t run = 0; run < problem.command.size(); ++run) {
    for (std::size_t n = 1; n < problem.command[run].size(); ++n) {
      if (problem.used[run][n] != 0) {
        const double speed =
            (problem.command[run][n] - problem.command[run][n - 1]) / problem.period_s;
        product += speed * (problem.command[run][n] - problem.actual[run][static_cast<long>(n)]);
        square += speed * speed;
      }
    }
  }
  return product / square;
}

std::vector<VectorXd> residuals(const ServoProblem& problem, const ServoLaw& law) {
  std::vector<VectorXd> out;
  for (std::size_t run = 0; run < problem.command.size(); ++run) {
    const auto& command = problem.command[run];
    VectorXd off = problem.actual[run] - simulated(law, command, problem.period_s);
    const MatrixXd basis = free_responses(law, problem.period_s, command.size());
    MatrixXd square = basis.transpose() * basis;
    square.diagonal().array() += kStateRidge;
    off.head(basis.rows()) -=
        basis * square.ldlt().solve(basis.transpose() * off.head(basis.rows()));
    out.push_back(std::move(off));
  }
  return out;
}

std::vector<double> colour_of(const ServoProblem& problem, const ServoLaw& law) {
  constexpr long kSize = kMostColour + 1;
  MatrixXd sums = MatrixXd::Zero(kSize, kSize);  // of r[n], r[n − 1], …
  double count = 0.0;
  const auto all = residuals(problem, law);
  for (std::size_t run = 0; run < all.size(); ++run) {
    for (long n = kMostColour; n < all[run].size(); ++n) {
      if (problem.used[run][static_cast<std::size_t>(n)] != 0) {
        const VectorXd row = all[run].segment(n - kMostColour, kSize).reverse();
        sums += row * row.transpose();
        count += 1.0;
      }
    }
  }
  sums.diagonal().array() += count * problem.floor * problem.floor;
  std::vector<double> out;
  double best = count * std::log(sums(0, 0) / count);
  for (long order = 1; order <= kMostColour; ++order) {
    const VectorXd a = sums.block(1, 1, order, order).ldlt().solve(sums.col(0).segment(1, order));
    const double left = sums(0, 0) - a.dot(sums.col(0).segment(1, order));
    const double badness = count * std::log(std::max(left, 1e-300) / count) +
                           static_cast<double>(order) * std::log(count);
    if (badness < best) {
      best = badness;
      out.assign(a.data(), a.data() + order);
    }
  }
  return out;
}

}  // namespace steadyrest::contour::offline
