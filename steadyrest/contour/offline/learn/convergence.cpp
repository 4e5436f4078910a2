// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include <steadyrest/contour/offline/learn/convergence.hpp>

namespace steadyrest::contour::offline {
namespace {

using Complex = std::complex<double>;
using online::AxisModel;

constexpr double kHalfPower = 0.832554611157698;  ///< √(ln 2): exp(−x²/2) = 1/√2
constexpr double kLagShare = 0.2;                 ///< of 1/k
constexpr double kLowest = 0.01;                  ///< of k
constexpr double kStep = 1.05;                    ///< between two frequencies
constexpr double kLeastQ = 1e-3;

Complex response(const AxisModel& axis, double omega_1_s) noexcept {
  const Complex s(0.0, omega_1_s);
  return (axis.gain_1_s + axis.feed_forward * s) /
         (axis.velocity_lag_s * s * s + s + axis.gain_1_s);
}

}  // namespace

double width_s(double cut_off_hz) noexcept {
  return kHalfPower / (2.0 * std::numbers::pi * cut_off_hz);
}

double convergence(const ServoModels& model, const Uncertainty& uncertainty,
                   double cut_off_hz) noexcept {
  const double sigma = width_s(cut_off_hz);
  double most = 0.0;
  for (const AxisModel& axis : model) {
    const double k = axis.gain_1_s;
    const double lag =
        uncertainty.velocity_lag_s > 0.0 ? uncertainty.velocity_lag_s : kLagShare / k;
    const double end = std::sqrt(-2.0 * std::log(kLeastQ)) / sigma;
    for (double omega = kLowest * k; omega < end; omega *= kStep) {
      const Complex law = std::exp(-0.5 * omega * omega * sigma * sigma) *
                          Complex(1.0, omega * (1.0 - axis.feed_forward) / k);
      for (const double gain : {-1.0, 0.0, 1.0}) {
        for (const double later : {0.0, 0.5, 1.0}) {
          for (const double ahead : {-1.0, 0.0, 1.0}) {
            const AxisModel other = {
                .gain_1_s = k * (1.0 + gain * uncertainty.gain_share),
                .feed_forward = axis.feed_forward + ahead * uncertainty.feed_forward,
                .velocity_lag_s = axis.velocity_lag_s + later * lag};
            most = std::max(most, std::abs(law * (response(axis, omega) - response(other, omega))));
          }
        }
      }
    }
  }
  return most;
}

}  // namespace steadyrest::contour::offline
