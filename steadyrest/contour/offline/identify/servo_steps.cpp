// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include <steadyrest/contour/offline/identify/servo_fit.hpp>
#include <steadyrest/contour/offline/identify/servo_steps.hpp>

namespace steadyrest::contour::offline {
namespace {

using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;

constexpr double kSameStep = 0.1;      // of the period
constexpr double kMovesShare = 1e-3;   // of the largest step: less is rest
constexpr double kTail_s = 0.1;        // after motion: the lag runs out
constexpr std::size_t kLeastRun = 20;  // samples of a stretch
constexpr int kMostRounds = 50;
constexpr double kSettled = 1e-10;   // change of p
constexpr double kSingular = 1e-13;  // determinant, columns scaled
constexpr double kBatchLags = 5.0;   // time constants in a batch
constexpr std::size_t kLeastBatches = 6;

/// Calls with e, d and the next e of each step, and whether the stretch begins with it.
template <class Visit>
void each_step(const ServoLog& log, std::span<const ServoRun> runs, int shift, Visit&& visit) {
  const auto s = static_cast<std::size_t>(shift);
  for (const ServoRun& run : runs) {
    for (std::size_t n = run.first; n < run.last; ++n) {
      visit(log.command[n - s] - log.actual[n], log.command[n + 1 - s] - log.command[n - s],
            log.command[n + 1 - s] - log.actual[n + 1], n == run.first);
    }
  }
}

/// Columns of very different size (mm, mm per cycle, 1) must not look singular.
std::optional<Vector> solved(const Matrix& m, const Vector& y, const Vector& scale) {
  const Matrix balanced = scale.asDiagonal() * m * scale.asDiagonal();
  // Its diagonal is about 1.
  if (!(std::abs(balanced.determinant()) > kSingular)) {
    return std::nullopt;
  }
  return scale.asDiagonal() * (balanced.inverse() * (scale.asDiagonal() * y));
}

Vector scale_of(const Matrix& m) {
  Vector out;
  for (int i = 0; i < 3; ++i) {
    out[i] = m(i, i) > 0.0 ? 1.0 / std::sqrt(m(i, i)) : 0.0;
  }
  return out;
}

std::optional<Vector> least_squares(const ServoLog& log, std::span<const ServoRun> runs,
                                    int shift) {
  Matrix m = Matrix::Zero();
  Vector y = Vector::Zero();
  each_step(log, runs, shift, [&](double e, double d, double next, bool /*first*/) {
    const Vector x{e, d, 1.0};
    m += x * x.transpose();
    y += x * next;
  });
  return solved(m, y, scale_of(m));
}

/// The filtered columns at one step: regressors, instruments, and what they are to explain.
struct Filtered {
  Vector x = Vector::Zero();
  Vector z = Vector::Zero();
  double y = 0.0;
  double simulated = 0.0;

  void step(const Vector& theta, double e, double d, double next, bool first) {
    if (first) {
      *this = Filtered{};
      simulated = e;
    }
    const double p = theta[0];
    x = p * x + Vector{e, d, 1.0};
    z = p * z + Vector{simulated, d, 1.0};
    y = p * y + next;
    simulated = p * simulated + theta[1] * d + theta[2];
  }
};

/// One round: the moments of the filtered columns, and the solution.
struct Round {
  Matrix zx = Matrix::Zero();
  Vector scale = Vector::Zero();
  std::optional<Vector> theta;
};

Round round_of(const ServoLog& log, std::span<const ServoRun> runs, int shift,
               const Vector& theta) {
  Round out;
  Matrix zz = Matrix::Zero();
  Vector zy = Vector::Zero();
  Filtered f;
  each_step(log, runs, shift, [&](double e, double d, double next, bool first) {
    f.step(theta, e, d, next, first);
    out.zx += f.z * f.x.transpose();
    zz += f.z * f.z.transpose();
    zy += f.z * f.y;
  });
  out.scale = scale_of(zz);
  out.theta = solved(out.zx, zy, out.scale);
  return out;
}

/// Variance by batches: S = Σ (Σ z·u)(Σ z·u)ᵀ, (ZᵀX)⁻¹·S·(XᵀZ)⁻¹.
bool add_variance(const ServoLog& log, std::span<const ServoRun> runs, int shift,
                  const Round& round, StepFit& fit) {
  const Vector theta{fit.step.p, fit.step.q, fit.step.r};
  const auto longest = static_cast<std::size_t>(std::ceil(-kBatchLags / std::log(fit.step.p)));
  const std::size_t batch = std::max<std::size_t>(longest, 10);
  Matrix s = Matrix::Zero();
  Vector sum = Vector::Zero();
  std::size_t batches = 0;
  std::size_t in_batch = 0;
  const auto close = [&] {
    if (in_batch > 0) {
      s += sum * sum.transpose();
      sum.setZero();
      in_batch = 0;
      ++batches;
    }
  };
  Filtered f;
  fit.left = 0.0;
  fit.samples = 0;
  each_step(log, runs, shift, [&](double e, double d, double next, bool first) {
    f.step(theta, e, d, next, first);
    const double u = f.y - f.x.dot(theta);
    sum += f.z * u;
    fit.left += u * u;
    ++fit.samples;
    if (++in_batch == batch) {
      close();
    }
  });
  close();
  if (batches < kLeastBatches) {
    return false;
  }
  const Matrix balance = round.scale.asDiagonal();
  const Matrix inverse = balance * (balance * round.zx * balance).inverse() * balance;
  // Three parameters are fitted to so many batches.
  const double few = static_cast<double>(batches) / static_cast<double>(batches - 3);
  const Matrix variance = few * inverse * s * inverse.transpose();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      fit.variance[i][j] = variance(i, j);
    }
  }
  return variance.allFinite();
}

}  // namespace

double servo_period_s(const std::vector<double>& time_s) {
  if (time_s.size() < 2) {
    return 0.0;
  }
  std::vector<double> step(time_s.size() - 1);
  for (std::size_t i = 0; i < step.size(); ++i) {
    step[i] = time_s[i + 1] - time_s[i];
  }
  const auto middle = step.begin() + static_cast<std::ptrdiff_t>(step.size() / 2);
  std::ranges::nth_element(step, middle);
  return *middle;
}

std::vector<ServoRun> unbroken(const ServoLog& log, double period_s, double most_s) {
  std::vector<ServoRun> out;
  for (std::size_t n = 0; n < log.time_s.size(); ++n) {
    const bool joins =
        n > 0 && std::abs(log.time_s[n] - log.time_s[n - 1] - period_s) <= kSameStep * period_s &&
        std::abs(log.command[n] - log.command[n - 1]) <= most_s * period_s;
    if (joins) {
      out.back().last = n;
    } else {
      out.push_back({n, n});
    }
  }
  return out;
}

std::vector<ServoRun> in_motion(const ServoLog& log, std::span<const ServoRun> runs,
                                double period_s, int shift) {
  const auto s = static_cast<std::size_t>(shift);
  double largest = 0.0;
  for (const ServoRun& run : runs) {
    for (std::size_t n = run.first; n < run.last; ++n) {
      largest = std::max(largest, std::abs(log.command[n + 1] - log.command[n]));
    }
  }
  const auto tail = static_cast<std::size_t>(std::ceil(kTail_s / period_s)) + s;
  std::vector<ServoRun> out;
  const auto keep = [&out](std::size_t first, std::size_t last) {
    if (last >= first + kLeastRun) {
      out.push_back({first, last});
    }
  };
  for (const ServoRun& run : runs) {
    std::optional<ServoRun> moving;
    for (std::size_t n = run.first + s; n < run.last; ++n) {
      if (largest == 0.0 ||
          std::abs(log.command[n + 1] - log.command[n]) <= kMovesShare * largest) {
        continue;
      }
      if (moving && n > moving->last) {
        keep(moving->first, moving->last);
        moving.reset();
      }
      moving = {moving ? moving->first : n, std::min(n + 1 + tail, run.last)};
    }
    if (moving) {
      keep(moving->first, moving->last);
    }
  }
  return out;
}

std::optional<StepFit> fit_step(const ServoLog& log, std::span<const ServoRun> runs, int shift) {
  auto theta = least_squares(log, runs, shift);
  if (!theta) {
    return std::nullopt;
  }
  // Noise pulls the first p down; too high a one would let the filter grow.
  const auto usable = [](double p) { return p > 0.0 && p < 1.0; };
  Round round;
  for (int i = 0; i < kMostRounds && usable((*theta)[0]); ++i) {
    round = round_of(log, runs, shift, *theta);
    if (!round.theta) {
      return std::nullopt;
    }
    const double change = std::abs((*round.theta)[0] - (*theta)[0]);
    theta = round.theta;
    if (change < kSettled) {
      break;
    }
  }
  StepFit out;
  out.step = {(*theta)[0], (*theta)[1], (*theta)[2]};
  // The caller says what a p outside (0, 1) means.
  if (usable(out.step.p) && !add_variance(log, runs, shift, round, out)) {
    return std::nullopt;
  }
  return out;
}

}  // namespace steadyrest::contour::offline
