// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/QR>
#include <fmt/core.h>

#include <steadyrest/chatter/offline/response/fit_check.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::chatter::offline {

using kernel::outcome::bad_input;
using kernel::outcome::Refusal;

std::optional<Refusal> given_twice(std::span<const Frf> responses) {
  for (std::size_t i = 0; i < responses.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (responses[i].compliance_mm_n == responses[j].compliance_mm_n &&
          responses[i].frequency_hz == responses[j].frequency_hz) {
        return bad_input(responses[i].file,
                         responses[i].file == responses[j].file
                             ? std::string("the same response twice")
                             : "the same response as in " + responses[j].file,
                         "give each measurement once");
      }
    }
  }
  return std::nullopt;
}

std::optional<Refusal> other_point(std::span<const Frf> responses) {
  const Frf* first = nullptr;
  for (const Frf& response : responses) {
    if (response.point.empty()) {
      continue;
    }
    first = first == nullptr ? &response : first;
    if (response.point != first->point) {
      return bad_input(
          response.file,
          fmt::format("was measured at {}, {} at {}", response.point, first->file, first->point),
          "give responses of one point in one direction");
    }
  }
  return std::nullopt;
}

std::optional<Refusal> no_more_than_noise(const Eigen::ArrayXd& w, const Eigen::ArrayXcd& h,
                                          std::size_t modes, double residual) {
  // c and d are real: real parts only. Scaled, so that both columns are of the same order.
  Eigen::MatrixXd columns(w.size(), 2);
  columns << Eigen::VectorXd::Ones(w.size()), (w.minCoeff() / w).square().matrix();
  const Eigen::VectorXd real = h.real().matrix();
  const Eigen::VectorXd background = columns * columns.colPivHouseholderQr().solve(real);
  const Eigen::ArrayXd left = (real - background).array().square() + h.imag().square();
  const double points = left.sum() * left.sum() / std::max(left.square().sum(), 1e-300);
  const double charge = 3.0 * static_cast<double>(modes) * std::log(2.0 * points) + 20.0;
  const double most =
      std::sqrt(left.sum() / h.abs2().sum()) * std::exp(-charge / (4.0 * std::max(points, 1.0)));
  if (residual < most) {
    return std::nullopt;
  }
  return bad_input(
      fmt::format("{} would explain as much of noise: {:.4g} % of the response is left (RMS) at {} "
                  "points; modes leave less than {:.3g} %",
                  modes == 1 ? "the mode found" : fmt::format("the {} modes found", modes),
                  100.0 * residual, w.size(), 100.0 * most),
      "repeat the tap test and check its coherence, or fit a narrower band: --from-hz, --to-hz");
}

}  // namespace steadyrest::chatter::offline
