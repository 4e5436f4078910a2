// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/thermal/offline/fit/structure.hpp>
#include <steadyrest/thermal/offline/log/lagged.hpp>

namespace steadyrest::thermal::offline {

// What the log determines counts: linear parameters, and each time constant that is not fixed.
std::size_t Structure::parameters() const noexcept {
  std::size_t count = linear() + mode.size();
  for (const Mode& m : mode) {
    count += m.rest_tau_s > 0.0 ? 1 : 0;
  }
  for (const Ambient& a : ambient) {
    count += a.tau_s > 0.0 ? 1 : 0;
  }
  return count;
}

Eigen::MatrixXd columns_of(const Structure& structure, const Log& log,
                           std::span<const std::size_t> rows) {
  const auto starts = stretches(log);
  const auto n =
      static_cast<Eigen::Index>(structure.linear() + 1 + structure.mode.size() * starts.size());
  Eigen::MatrixXd out(static_cast<Eigen::Index>(rows.size()), n);
  Eigen::Index at = 0;
  for (const Structure::Mode& m : structure.mode) {
    for (std::size_t k = 0; k < structure.table_rev_s.size(); ++k) {
      out.col(at++) = lagged_share(log, rows, structure.table_rev_s, k, m.tau_s, m.rest_tau_s);
    }
    for (std::size_t p = 0; p < structure.power.size() && structure.table_rev_s.empty(); ++p) {
      out.col(at++) = lagged_power(log, rows, structure.power[p], m.tau_s, m.rest_tau_s);
    }
  }
  for (const Structure::Ambient& a : structure.ambient) {
    out.col(at++) = lagged_temperature(log, rows, log.temperature[a.sensor], a.tau_s);
  }
  // The order of the columns is a contract: levels mode by mode, gains, the constant, then the
  // states. fitted_axis.cpp and wide_prior() depend on it.
  out.col(at++).setOnes();
  // One column for each mode and stretch: after a gap a mode's state is unknown.
  for (const Structure::Mode& m : structure.mode) {
    for (const std::size_t start : starts) {
      out.col(at++) = fading(log, rows, start, m.tau_s, m.rest_tau_s);
    }
  }
  return out;
}

}  // namespace steadyrest::thermal::offline
