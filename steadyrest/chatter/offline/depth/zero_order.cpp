// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <steadyrest/chatter/offline/depth/zero_order.hpp>
#include <steadyrest/kernel/units/constants.hpp>

// Two uses of one eigenvalue: zero_order_lobes() goes along the chatter frequency and gives depth
// and speeds of every lobe in closed form; zero_order_limit_mm() treats one speed, where the closed
// form does not apply, and searches for the frequencies at which the depth is real.
namespace steadyrest::chatter::offline {
namespace {

using kernel::units::kTurn;

using Complex = std::complex<double>;
using Pair = std::array<Complex, 2>;

constexpr double kScanHz = 0.25;  ///< step over the half-width of the sharpest mode
constexpr double kMostOver = 4.0;
constexpr double kReach = 1e6;  ///< a border beyond this, mm, is a pole

/// α at the angle φ, to be taken between entry and exit.
std::array<double, 4> primitive(double phi, double kr) noexcept {
  const double c = std::cos(2.0 * phi);
  const double s = std::sin(2.0 * phi);
  // Altintas and Budak (1995): directional coefficients, x along the feed, kr = Kr/Kt.
  return {0.5 * (c - 2.0 * kr * phi + kr * s), 0.5 * (-s - 2.0 * phi + kr * c),
          0.5 * (-s + 2.0 * phi + kr * c), 0.5 * (-c - 2.0 * kr * phi - kr * s)};
}

/// The two Λ at ω; with only one direction, the other is infinite.
Pair eigenvalues(const Process& process, const std::array<double, 4>& alpha, double w) {
  Complex xx;
  Complex xy;
  Complex yy;
  for (const Mode& mode : process.modes) {
    const double wn = kTurn * mode.frequency_hz;
    const Complex g =
        1000.0 / mode.mass_kg / Complex(wn * wn - w * w, 2.0 * mode.damping_ratio * wn * w);
    xx += mode.shape[0] * mode.shape[0] * g;
    xy += mode.shape[0] * mode.shape[1] * g;
    yy += mode.shape[1] * mode.shape[1] * g;
  }
  // a₀·Λ² + a₁·Λ + 1 = 0.
  const Complex a0 = (alpha[0] * alpha[3] - alpha[1] * alpha[2]) * (xx * yy - xy * xy);
  const Complex a1 = alpha[0] * xx + (alpha[1] + alpha[2]) * xy + alpha[3] * yy;
  // 1/Λ = (−a₁ ± √(a₁² − 4a₀))/2 has no pole where a₀ = 0.
  const Complex root = std::sqrt(a1 * a1 - 4.0 * a0);
  return {0.5 * (-a1 + root), 0.5 * (-a1 - root)};
}

/// The second pair in the order that continues the first.
Pair continued(const Pair& before, const Pair& now) {
  const double straight = std::abs(now[0] - before[0]) + std::abs(now[1] - before[1]);
  const double crossed = std::abs(now[1] - before[0]) + std::abs(now[0] - before[1]);
  // The square root jumps between its branches along ω; a sign change across such a jump is not a
  // border.
  return crossed < straight ? Pair{now[1], now[0]} : now;
}

double sharpest_hz(const Process& process) {
  double out = process.modes[0].damping_ratio * process.modes[0].frequency_hz;
  for (const Mode& mode : process.modes) {
    out = std::min(out, mode.damping_ratio * mode.frequency_hz);
  }
  return out;
}

}  // namespace

std::array<double, 4> zero_order_alpha(const Process& process) noexcept {
  const double kr = process.cut.radial_n_mm2 / process.cut.tangential_n_mm2;
  const auto from = primitive(process.entry_rad(), kr);
  auto to = primitive(process.exit_rad(), kr);
  for (std::size_t i = 0; i < to.size(); ++i) {
    to[i] -= from[i];
  }
  return to;
}

std::vector<ZeroOrderPoint> zero_order_lobes(const Process& process, double from_hz, double to_hz,
                                             std::size_t points, std::size_t lobes) {
  const auto alpha = zero_order_alpha(process);
  const auto teeth = static_cast<double>(process.tool.teeth);
  std::vector<ZeroOrderPoint> out;
  for (std::size_t i = 0; i < points; ++i) {
    const double hz = from_hz + (to_hz - from_hz) * static_cast<double>(i) /
                                    static_cast<double>(std::max<std::size_t>(points - 1, 1));
    for (const Complex& inverse : eigenvalues(process, alpha, kTurn * hz)) {
      const Complex lambda = 1.0 / inverse;
      const double depth =
          -kTurn * std::norm(lambda) / (teeth * process.cut.tangential_n_mm2 * lambda.real());
      if (!(depth > 0.0) || !std::isfinite(depth)) {
        continue;
      }
      ZeroOrderPoint point{hz, depth, {}};
      // ε = π − 2·atan κ is the phase between inner and outer wave; k whole waves more give the
      // next lobe.
      const double phase = std::numbers::pi - 2.0 * std::atan(lambda.imag() / lambda.real());
      for (std::size_t k = 0; k < lobes; ++k) {
        point.speed_rev_s.push_back(kTurn * hz /
                                    (teeth * (phase + kTurn * static_cast<double>(k))));
      }
      out.push_back(std::move(point));
    }
  }
  return out;
}

std::optional<double> zero_order_limit_mm(const Process& process, double speed_rev_s) {
  const auto alpha = zero_order_alpha(process);
  const auto teeth = static_cast<double>(process.tool.teeth);
  const double pass_s = 1.0 / (teeth * speed_rev_s);
  double most_hz = 0.0;
  for (const Mode& mode : process.modes) {
    most_hz = std::max(most_hz, kMostOver * mode.frequency_hz);
  }
  // Λ = −(N/4π)·a·Kt·(1 − e^{−iωT}): on the border that a is real.
  const double factor = 4.0 * std::numbers::pi / (teeth * process.cut.tangential_n_mm2);
  const auto depth = [&](const Complex& inverse, double w) {
    return -factor / (inverse * (1.0 - std::polar(1.0, -w * pass_s)));
  };
  // Fine enough for the sharpest resonance and for the lobes, which repeat every 1/T in frequency.
  const double step_hz = std::min(kScanHz * sharpest_hz(process), 0.02 / pass_s);
  const auto steps = static_cast<std::size_t>(std::ceil(most_hz / step_hz));
  std::optional<double> least;
  double low = kTurn * 0.5 * step_hz;
  Pair at_low = eigenvalues(process, alpha, low);
  for (std::size_t i = 1; i < steps; ++i) {
    const double high = kTurn * step_hz * (static_cast<double>(i) + 0.5);
    const Pair at_high = continued(at_low, eigenvalues(process, alpha, high));
    for (std::size_t branch = 0; branch < 2; ++branch) {
      // 1/Λ = 0: only one direction vibrates, and the second eigenvalue is at infinity.
      if (std::abs(at_low[branch]) == 0.0 || std::abs(at_high[branch]) == 0.0) {
        continue;
      }
      double a = low;
      double b = high;
      const double start = depth(at_low[branch], a).imag();
      if (start * depth(at_high[branch], b).imag() > 0.0) {
        continue;
      }
      Pair pair = at_low;
      Complex found;
      // Bisection, not Newton: `continued` must compare neighbours to stay on its branch.
      for (int k = 0; k < 50; ++k) {
        const double middle = 0.5 * (a + b);
        const Pair next = continued(pair, eigenvalues(process, alpha, middle));
        found = depth(next[branch], middle);
        if (found.imag() * start > 0.0) {
          a = middle;
          pair = next;
        } else {
          b = middle;
        }
      }
      // Im a also changes sign through infinity: that is a pole of the depth, not a border.
      const bool pole = std::abs(found) > kReach || std::abs(found.imag()) > 1e-6 * found.real();
      if (!pole && found.real() > 0.0 && (!least || found.real() < *least)) {
        least = found.real();
      }
    }
    low = high;
    at_low = at_high;
  }
  return least;
}

}  // namespace steadyrest::chatter::offline
