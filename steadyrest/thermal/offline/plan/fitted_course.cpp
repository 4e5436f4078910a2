// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>
#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/thermal/offline/log/log_inputs.hpp>
#include <steadyrest/thermal/offline/plan/fitted_course.hpp>
#include <steadyrest/thermal/offline/plan/forecast.hpp>

// For the page of `thermal fit`: the model runs over the log once from cold, together with the
// decay of a unit state of each mode. The states of each stretch are then linear unknowns, fitted
// to the readings of the window.
namespace steadyrest::thermal::offline {
namespace {

using kernel::machine::ThermalAxis;
using kernel::outcome::refuse;
using kernel::outcome::Result;

constexpr double kUsualState_mm = 0.03;
constexpr double kLeastNoise_mm = 1e-5;

/// Runs the log's inputs through the model from zero, with the decay of each initial state.
class Walk {
 public:
  Walk(online::ThermalModel model, const Log& log, std::vector<const LogChannel*> sensor)
      : model_(std::move(model)), log_(log), sensor_(std::move(sensor)), uncertainty_(model_) {}

  /// Rows from … on; the columns of `fading` are the modes of the first stretch, then of the next.
  /// One walk fills three things per row: the model from cold, the variance from its parameters,
  /// and how much is left of a state of 1 that each mode had at the beginning of the row's stretch.
  void run(std::size_t from) {
    const std::size_t modes = model_.config().mode.size();
    const auto gap_at = [&](std::size_t row) { return std::ranges::binary_search(log_.gap, row); };
    std::size_t stretches = 1;
    for (std::size_t row = from + 1; row < log_.rows(); ++row) {
      stretches += gap_at(row) ? 1 : 0;
    }
    const auto rows = static_cast<Eigen::Index>(log_.rows() - from);
    modelled_mm = Eigen::VectorXd::Zero(rows);
    parameters_mm2 = Eigen::VectorXd::Zero(rows);
    fading = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(stretches * modes));
    Eigen::Index first = 0;
    Eigen::VectorXd left;
    for (std::size_t row = from; row < log_.rows(); ++row) {
      if (row == from || gap_at(row)) {
        first += row == from ? 0 : static_cast<Eigen::Index>(modes);
        left = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(modes));
        begin(row);
      } else {
        const double elapsed_s = log_.time_s[row] - log_.time_s[row - 1];
        const online::Drive drive = drive_at(log_, sensor_, row - 1);
        for (std::size_t i = 0; i < modes; ++i) {
          left(static_cast<Eigen::Index>(i)) *= model_.decay(i, elapsed_s, drive);
        }
        uncertainty_.step(elapsed_s, drive, model_.state());
        model_.update(elapsed_s, drive);
      }
      const auto to = static_cast<Eigen::Index>(row - from);
      modelled_mm(to) = model_.config().zero_mm + model_.displacement_mm();
      parameters_mm2(to) = uncertainty_.parameter_variance_mm2(since_);
      fading.row(to).segment(first, left.size()) = left;
    }
  }

  Eigen::VectorXd modelled_mm;
  Eigen::VectorXd parameters_mm2;
  Eigen::MatrixXd fading;

 private:
  // Only changes since then make parameters uncertain: the state itself is fitted again.
  void begin(std::size_t row) {
    model_.reset();
    model_.update(0.0, drive_at(log_, sensor_,
                                row));  // the sensors' lagged temperatures begin with the first
    uncertainty_ = Uncertainty(model_);
    since_ = uncertainty_.answer();
  }

  online::ThermalModel model_;
  const Log& log_;
  std::vector<const LogChannel*> sensor_;
  Uncertainty uncertainty_;
  Uncertainty::Answer since_;
};

/// States by least squares; those of stretches without readings stay zero.
Eigen::VectorXd states_mm(const Walk& walk, const std::vector<FittedPoint>& points,
                          double noise_mm) {
  const Eigen::Index n = walk.fading.cols();
  // A ridge of (noise/30 µm)²: a mode that died away before the window leaves no column to fit.
  Eigen::MatrixXd normal =
      Eigen::MatrixXd::Identity(n, n) * std::pow(noise_mm / kUsualState_mm, 2.0);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].fitted && std::isfinite(points[i].measured_mm)) {
      const auto row = walk.fading.row(static_cast<Eigen::Index>(i));
      normal.selfadjointView<Eigen::Lower>().rankUpdate(row.transpose());
      right += row.transpose() * (points[i].measured_mm - points[i].modelled_mm);
    }
  }
  return normal.selfadjointView<Eigen::Lower>().ldlt().solve(right);
}

}  // namespace

Result<std::vector<FittedPoint>> fitted_course(const ThermalAxis& axis, const Log& log,
                                               std::size_t channel, double from_s, double to_s) {
  auto on_log = model_on(axis, log);
  if (!on_log) {
    return std::unexpected(on_log.error());
  }
  const auto from =
      static_cast<std::size_t>(std::ranges::lower_bound(log.time_s, from_s) - log.time_s.begin());
  if (from >= log.rows()) {
    return refuse(log.file, "the window begins after the log's end", "choose an earlier window");
  }
  Walk walk(std::move(on_log->model), log, std::move(on_log->sensor));
  walk.run(from);
  std::vector<FittedPoint> out;
  out.reserve(log.rows() - from);
  // Drift at its full spread: here no reading narrows it.
  const double unknown_mm2 = axis.drift_mm * axis.drift_mm + axis.noise_mm * axis.noise_mm;
  for (std::size_t row = from; row < log.rows(); ++row) {
    const auto i = static_cast<Eigen::Index>(row - from);
    out.push_back({.time_s = log.time_s[row],
                   .measured_mm = log.displacement[channel].value[row],
                   .modelled_mm = walk.modelled_mm(i),
                   .sd_mm = std::sqrt(unknown_mm2 + walk.parameters_mm2(i)),
                   .fitted = log.time_s[row] <= to_s});
  }
  if (std::ranges::none_of(
          out, [](const FittedPoint& p) { return p.fitted && std::isfinite(p.measured_mm); })) {
    return refuse(log.file,
                  fmt::format("{} has no reading in the window", log.displacement[channel].name),
                  "choose a wider window");
  }
  const Eigen::VectorXd began =
      walk.fading * states_mm(walk, out, std::max(axis.noise_mm, kLeastNoise_mm));
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].modelled_mm += began(static_cast<Eigen::Index>(i));
  }
  return out;
}

}  // namespace steadyrest::thermal::offline
