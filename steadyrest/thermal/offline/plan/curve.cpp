// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/thermal/offline/plan/curve.hpp>

namespace steadyrest::thermal::offline {
namespace {

// Within a transition the inputs are constant: x = G + (x₀ − G)·e^(−t/τ), a constant and one term
// per mode. A lagged temperature adds one more term, one without a lag none.
Exponentials terms_of(const online::ThermalModel& model, const online::Drive& drive) {
  const auto& config = model.config();
  const auto& state = model.state();
  Exponentials terms{{0.0, 0.0}};
  for (std::size_t i = 0; i < config.mode.size(); ++i) {
    const double level = model.level_mm(i, drive);
    terms.front().amplitude += level;
    terms.push_back({state.mode_mm[i] - level, 1.0 / model.tau_s(i, drive)});
  }
  for (std::size_t j = 0; j < config.ambient.size(); ++j) {
    const auto& ambient = config.ambient[j];
    const double lagged = state.ambient_c[j];
    const double now = drive.ambient_c[j];
    if (std::isfinite(now)) {  // the next step takes an unseen one as lagged
      const double from = std::isfinite(lagged) && ambient.tau_s > 0.0 ? lagged : now;
      terms.front().amplitude += ambient.gain_mm_k * (now - ambient.reference_c);
      if (from != now) {
        terms.push_back({ambient.gain_mm_k * (from - now), 1.0 / ambient.tau_s});
      }
    } else if (std::isfinite(lagged)) {
      terms.front().amplitude += ambient.gain_mm_k * (lagged - ambient.reference_c);
    }
  }
  return terms;
}

}  // namespace

// At a joint the later piece applies; both give the same value.
double Curve::at(double time_s) const noexcept {
  if (piece.empty()) {
    return 0.0;
  }
  const auto behind = std::ranges::upper_bound(piece, time_s, {}, &Piece::start_s);
  const Piece& in = behind == piece.begin() ? piece.front() : *std::prev(behind);
  return value(in.displacement_mm, std::clamp(time_s - in.start_s, 0.0, in.seconds));
}

double Curve::total_s() const noexcept {
  return piece.empty() ? 0.0 : piece.back().start_s + piece.back().seconds;
}

Curve::Extreme Curve::largest() const {
  Extreme most;
  const auto look = [&most](const Piece& p, double t) {
    const double here = value(p.displacement_mm, t);
    if (std::abs(here) > std::abs(most.displacement_mm)) {
      most = {here, p.start_s + t};
    }
  };
  for (const Piece& p : piece) {
    // A sum of exponentials is largest at an end or where it turns; no sampling needed.
    look(p, 0.0);
    for (const double t : extremes_of(p.displacement_mm, p.seconds)) {
      look(p, t);
    }
    look(p, p.seconds);
  }
  return most;
}

Curve curve_of(online::ThermalModel model, const Cyclogram& cyclogram,
               const std::vector<double>& ambient_c) {
  Curve curve;
  curve.piece.reserve(cyclogram.transition.size());
  double start_s = 0.0;
  for (const Transition& transition : cyclogram.transition) {
    online::Drive drive = drive_of(transition);
    std::copy_n(ambient_c.begin(), std::min(ambient_c.size(), drive.ambient_c.size()),
                drive.ambient_c.begin());
    // Each piece begins with the state left by the previous ones, so the curve has no seams.
    curve.piece.push_back({start_s, transition.seconds, terms_of(model, drive)});
    model.update(transition.seconds, drive);
    start_s += transition.seconds;
  }
  return curve;
}

}  // namespace steadyrest::thermal::offline
