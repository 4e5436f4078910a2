// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/motion/online/line/line_fit.hpp>

namespace steadyrest::motion::online {
namespace {

/// Where the speed changes much, the middle line is far from the middle of the time and the fit is
/// poor. README, "What the constants do".
constexpr double kMostSkew = 0.25;
constexpr std::size_t kTerms = 4;

/// Least squares of a cubic: normal matrix and right side, eliminated in place (Gauss without
/// pivoting: the matrix is symmetric and positive definite). False when it is not.
bool solve(std::array<std::array<double, kTerms + 1>, kTerms>& m) noexcept {
  for (std::size_t i = 0; i < kTerms; ++i) {
    if (!(m[i][i] > 1e-9)) {
      return false;
    }
    for (std::size_t j = i + 1; j < kTerms; ++j) {
      const double f = m[j][i] / m[i][i];
      for (std::size_t k = i; k <= kTerms; ++k) {
        m[j][k] -= f * m[i][k];
      }
    }
  }
  for (std::size_t i = kTerms; i-- > 0;) {
    for (std::size_t j = i + 1; j < kTerms; ++j) {
      m[i][kTerms] -= m[i][j] * m[j][kTerms];
    }
    m[i][kTerms] /= m[i][i];
  }
  return true;
}

}  // namespace

void LineFit::put(double t_s, double position_mm) noexcept {
  // Twice, so that any window is contiguous in one of the halves.
  t_s_[next_] = t_s_[next_ + kWindow] = t_s;
  position_mm_[next_] = position_mm_[next_ + kWindow] = position_mm;
  next_ = (next_ + 1) % kWindow;
  count_ = count_ < kWindow ? count_ + 1 : kWindow;
}

bool LineFit::breaks(double t_s, std::int64_t line, std::int8_t direction,
                     bool lost) const noexcept {
  return count_ > 0 && (lost || direction != direction_ || line != line_ + direction_ ||
                        !(t_s > t_s_[next_ + kWindow - 1]));
}

LineFit::Residual LineFit::push(double t_s, double position_mm, std::int64_t line,
                                std::int8_t direction) noexcept {
  direction_ = direction;
  line_ = line;
  put(t_s, position_mm);
  // Only an odd number of passages has a middle one.
  return count_ % 2 == 1 ? tail((count_ - 1) / 2) : Residual{};
}

LineFit::Residual LineFit::tail(std::size_t half) const noexcept {
  if (half < kLeast || half > kHalf || count_ < 2 * half + 1) {
    return {};
  }
  const std::size_t edges = 2 * half + 1;
  const double* const t = &t_s_[next_ + kWindow - edges];
  const double* const x = &position_mm_[next_ + kWindow - edges];
  const double span = t[edges - 1] - t[0];
  const double early = t[half] - 0.5 * (t[0] + t[edges - 1]);
  if (!(span > 0.0) || span > max_span_s_ || std::abs(early) > kMostSkew * span) {
    return {};
  }
  // u = (t − t_middle)/span, y = x − x_middle.
  const double per_span = 1.0 / span;
  std::array<double, 2 * kTerms - 1> power{};
  std::array<double, kTerms> moment{};
  double squares = 0.0;
  for (std::size_t i = 0; i < edges; ++i) {
    const double u = (t[i] - t[half]) * per_span;
    const double y = x[i] - x[half];
    const double u2 = u * u;
    const double u3 = u2 * u;
    power[1] += u;
    power[2] += u2;
    power[3] += u3;
    power[4] += u2 * u2;
    power[5] += u2 * u3;
    power[6] += u3 * u3;
    moment[0] += y;
    moment[1] += u * y;
    moment[2] += u2 * y;
    moment[3] += u3 * y;
    squares += y * y;
  }
  power[0] = static_cast<double>(edges);
  std::array<std::array<double, kTerms + 1>, kTerms> m{};
  for (std::size_t i = 0; i < kTerms; ++i) {
    for (std::size_t j = 0; j < kTerms; ++j) {
      m[i][j] = power[i + j];
    }
    m[i][kTerms] = moment[i];
  }
  if (!solve(m)) {
    return {};
  }
  for (std::size_t i = 0; i < kTerms; ++i) {
    squares -= m[i][kTerms] * moment[i];  // Σ(y − fit)² = Σy² − Σ coefficient·moment
  }
  const std::int64_t middle = line_ - direction_ * static_cast<std::int64_t>(half);
  return {middle, m[0][kTerms], std::sqrt(std::max(0.0, squares) / static_cast<double>(edges)),
          true};
}

}  // namespace steadyrest::motion::online
