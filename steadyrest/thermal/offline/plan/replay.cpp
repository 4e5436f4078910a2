// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/thermal/offline/log/log_inputs.hpp>
#include <steadyrest/thermal/offline/plan/forecast.hpp>
#include <steadyrest/thermal/offline/plan/replay.hpp>

// A passport driven by a log's recorded inputs. Up to `from_s` readings set what the model does not
// know; afterwards they are only compared, except those of a probe. The unknown is one scalar
// process added to the model, plus the variance of parameters and of lost states.
namespace steadyrest::thermal::offline {
namespace {

using kernel::machine::ThermalAxis;
using kernel::outcome::refuse;
using kernel::outcome::Result;
using kernel::units::kNan;

constexpr double kSlack_s = 1.0;

class Replay {
 public:
  Replay(online::ThermalModel model, const Log& log, std::vector<const LogChannel*> sensor,
         const ReplayRequest& request)
      : model_(std::move(model)),
        log_(log),
        sensor_(std::move(sensor)),
        request_(request),
        uncertainty_(model_),
        since_(uncertainty_.answer()),
        variance_mm2_(model_.config().drift_mm * model_.config().drift_mm) {}

  std::vector<ReplayPoint> run() {
    const double end_s = log_.time_s.back();
    // The passport's states belong to one instant; a log from another day cannot start with them.
    const bool known = request_.state_s >= log_.time_s.front() - kFarBefore_s &&
                       request_.state_s < end_s &&
                       request_.from_s.value_or(end_s) >= request_.state_s;
    const double from_s = request_.from_s.value_or(
        known ? std::max(request_.state_s, log_.time_s.front()) : log_.time_s.front());
    std::size_t row = 0;
    double now_s = log_.time_s.front();
    if (known) {
      row = static_cast<std::size_t>(
          std::ranges::upper_bound(log_.time_s, request_.state_s + kSlack_s) - log_.time_s.begin());
      now_s = request_.state_s;
      start_known();
    }
    double next_probe_s = -std::numeric_limits<double>::infinity();
    std::vector<ReplayPoint> out;
    for (; row < log_.rows(); ++row) {
      const double t = log_.time_s[row];
      std::ranges::binary_search(log_.gap, row) ? stand(t - now_s, row) : advance(t - now_s, row);
      now_s = t;
      ReplayPoint point{t, displacement(), 0.0, measured(row), t > from_s};
      const bool probe = request_.rezero_s > 0.0 && t > from_s && t >= next_probe_s;
      if (std::isfinite(point.measured_mm) && (t <= from_s || probe)) {
        take(point.measured_mm);
        next_probe_s = t + request_.rezero_s;
        point.displacement_mm = displacement();
        point.forecast = false;
      }
      point.sd_mm = std::sqrt(variance_mm2());
      out.push_back(point);
    }
    return out;
  }

 private:
  static constexpr double kFarBefore_s = 24.0 * 3600.0;

  void start_known() {
    const ThermalAxis& axis = model_.config();
    online::ThermalModel::State state = model_.state();
    for (std::size_t i = 0; i < axis.mode.size(); ++i) {
      state.mode_mm[i] = axis.mode[i].state_mm;
    }
    for (std::size_t j = 0; j < axis.ambient.size(); ++j) {
      state.ambient_c[j] = axis.ambient[j].state_c;
    }
    model_.restore(state);
    uncertainty_ = Uncertainty(model_);
    since_ = uncertainty_.answer();
    drift_mm_ = axis.drift_state_mm;
    variance_mm2_ = axis.noise_mm * axis.noise_mm;
  }

  [[nodiscard]] double displacement() const {
    return model_.config().zero_mm + model_.displacement_mm() + drift_mm_;
  }
  [[nodiscard]] double measured(std::size_t row) const {
    return request_.channel ? log_.displacement[*request_.channel].value[row] : kNan;
  }

  /// A row's inputs apply until the next row; those of the first row also before it.
  void advance(double elapsed_s, std::size_t row) {
    step(elapsed_s, drive_at(log_, sensor_, row == 0 ? 0 : row - 1));
  }

  /// Through a gap of the log that ends with `row`: the model assumes standstill, as on line, but
  /// the machine may have done anything. The modes may then be off by as much as they were
  /// displaced before the gap, until they forget it or a reading reveals it. A lag shorter than the
  /// gap restarts with the next temperature.
  void stand(double elapsed_s, std::size_t row) {
    const auto before_mm = model_.state().mode_mm;
    online::Drive drive = drive_at(log_, sensor_, row == 0 ? 0 : row - 1);
    drive.speed_rev_s = 0.0;
    step(elapsed_s, drive);
    const ThermalAxis& axis = model_.config();
    online::ThermalModel::State state = model_.state();
    for (std::size_t j = 0; j < sensor_.size(); ++j) {
      const auto& value = sensor_[j]->value;
      const auto next = std::find_if(value.begin() + static_cast<std::ptrdiff_t>(row), value.end(),
                                     [](double v) { return std::isfinite(v); });
      if (elapsed_s > axis.ambient[j].tau_s && next != value.end()) {
        state.ambient_c[j] = *next;
      }
    }
    model_.restore(state);
    variance_mm2_ = axis.drift_mm * axis.drift_mm;
    unknown_mm_ = before_mm;
  }

  void step(double elapsed_s, const online::Drive& drive) {
    uncertainty_.step(elapsed_s, drive, model_.state());
    for (std::size_t i = 0; i < model_.config().mode.size(); ++i) {
      unknown_mm_[i] *= model_.decay(i, elapsed_s, drive);
    }
    model_.update(elapsed_s, drive);
    const ThermalAxis& axis = model_.config();
    // Exact step of d' = −d/τ_d + noise: variance → e^(−2h/τ)·P + (1 − e^(−2h/τ))·drift².
    const double keep = std::exp(-elapsed_s / axis.drift_tau_s);
    drift_mm_ *= keep;
    variance_mm2_ =
        keep * keep * variance_mm2_ + (1.0 - keep * keep) * axis.drift_mm * axis.drift_mm;
  }

  void take(double reading_mm) {
    const ThermalAxis& axis = model_.config();
    const double unknown = variance_mm2();
    const double noise = axis.noise_mm * axis.noise_mm;
    // Scalar Kalman gain. A reading sees the sum, so any error is booked on the drift.
    const double gain = unknown > 0.0 ? unknown / (unknown + noise) : 1.0;
    drift_mm_ += gain * (reading_mm - displacement());
    variance_mm2_ = (1.0 - gain) * unknown;
    // A reading ends all that a gap had made unknown; parameters count from here on.
    unknown_mm_.fill(0.0);
    since_ = uncertainty_.answer();
  }

  [[nodiscard]] double variance_mm2() const {
    const double modes_mm = std::accumulate(unknown_mm_.begin(), unknown_mm_.end(), 0.0);
    // Summed before squaring: after a gap the modes may all be off together.
    return variance_mm2_ + modes_mm * modes_mm + uncertainty_.parameter_variance_mm2(since_);
  }

  online::ThermalModel model_;
  const Log& log_;
  std::vector<const LogChannel*> sensor_;
  const ReplayRequest& request_;
  Uncertainty uncertainty_;
  Uncertainty::Answer since_;
  double drift_mm_ = 0.0;
  double variance_mm2_;  ///< of the drift
  /// How far the modes may be off since a gap: as far as they were before it, decaying as they do.
  std::array<double, online::kMaxThermalModes> unknown_mm_{};
};

}  // namespace

Result<std::vector<ReplayPoint>> replay(const ThermalAxis& axis, const Log& log,
                                        const ReplayRequest& request) {
  auto on_log = model_on(axis, log);
  if (!on_log) {
    return std::unexpected(on_log.error());
  }
  const double fastest = std::ranges::max(log.speed_rev_s);
  if (axis.max_speed_rev_s > 0.0 && fastest > kBeyondFitted * axis.max_speed_rev_s) {
    return refuse(
        log.file,
        fmt::format("the spindle runs at {:.0f} rpm; the passport of {} covers up to {:.0f} rpm",
                    kernel::units::rpm_from_rev_s(fastest), axis.name,
                    kernel::units::rpm_from_rev_s(axis.max_speed_rev_s)),
        "test the machine at that speed and fit again");
  }
  return Replay(std::move(on_log->model), log, std::move(on_log->sensor), request).run();
}

// Only rows with a forecast and a reading count; a row whose reading was used would flatter the
// score.
ReplayScore score(const std::vector<ReplayPoint>& points, double noise_mm) {
  ReplayScore out;
  double square = 0.0;
  double in = 0.0;
  for (const ReplayPoint& p : points) {
    if (!p.forecast || !std::isfinite(p.measured_mm)) {
      continue;
    }
    const double error = p.measured_mm - p.displacement_mm;
    ++out.points;
    square += error * error;
    // A reading adds its own noise to the band.
    in += error * error <= kBand * kBand * (p.sd_mm * p.sd_mm + noise_mm * noise_mm) ? 1.0 : 0.0;
  }
  if (out.points > 0) {
    const auto n = static_cast<double>(out.points);
    out.rms_mm = std::sqrt(square / n);
    out.coverage = in / n;
  }
  return out;
}

}  // namespace steadyrest::thermal::offline
