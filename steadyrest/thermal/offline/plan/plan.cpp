// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/thermal/offline/plan/plan.hpp>

// The system R of Marusich 2012 for one axis: follow the residual δ − corrections through each
// transition, correct where it reaches a border of its band, record intervals and corrections.
// Instants are roots, found by exponentials.cpp, so no time step decides what is seen.
// band_is_held() then checks the finished plan once more with its rounded instants.
namespace steadyrest::thermal::offline {
namespace {

using kernel::outcome::Result;

/// A residual this close to its border has reached it. The law says "reaches ±Δ_k", and roots are
/// found only to rounding: without this a correction at the border would be missed or made twice.
/// Far below any increment of a control.
constexpr double kReached_mm = 1e-9;
/// Instants this close together are one: their corrections are added and made together. At the end
/// of a transition they belong to the start of the next. No interval of the system R is therefore
/// shorter.
constexpr double kInstant_s = 1e-3;

Exponentials slope_of(const Exponentials& f) {
  Exponentials out;
  for (const Exponential& term : f) {
    // d/dt of A·e^(−r·t).
    out.push_back({-term.amplitude * term.rate_1_s, term.rate_1_s});
  }
  return out;
}

double steepest_mm_s(const Exponentials& f, double seconds) {
  const Exponentials slope = slope_of(f);
  double most = std::max(std::abs(value(slope, 0.0)), std::abs(value(slope, seconds)));
  for (const double t : extremes_of(slope, seconds)) {
    most = std::max(most, std::abs(value(slope, t)));
  }
  return most;
}

class Planner {
 public:
  Planner(const Curve& curve, const Cyclogram& cyclogram, const PlanRequest& request)
      : curve_(curve), cyclogram_(cyclogram), request_(request) {}

  Result<AxisCorrections> run(const std::string& name) {
    out_.name = name;
    out_.largest_mm = std::abs(curve_.largest().displacement_mm);
    for (std::size_t i = 0; i < curve_.piece.size(); ++i) {
      if (auto done = transition(i); !done) {
        return std::unexpected(done.error());
      }
    }
    if (auto held = band_is_held(); !held) {
      return std::unexpected(held.error());
    }
    return std::move(out_);
  }

 private:
  Result<void> refuse(std::string what, std::string to_do) const {
    return kernel::outcome::refuse(cyclogram_.file, std::move(what), std::move(to_do));
  }

  [[nodiscard]] std::string place(std::size_t i, double at_s) const {
    const std::string& name = cyclogram_.transition[i].name;
    return fmt::format("{} in transition {}{}{} (minute {:.2f})", out_.name, i + 1,
                       name.empty() ? "" : " ", name, (curve_.piece[i].start_s + at_s) / 60.0);
  }

  Result<void> transition(std::size_t i) {
    const Curve::Piece& piece = curve_.piece[i];
    const double own = cyclogram_.transition[i].tolerance_mm;
    const double tolerance_mm = own > 0.0 ? own : request_.tolerance_mm;
    const double band = request_.share * tolerance_mm;
    if (!(band > 0.0)) {
      return refuse(fmt::format("transition {} has no tolerance", i + 1),
                    "give the plan or the transition a tolerance");
    }
    PlannedTransition row;
    row.name = cyclogram_.transition[i].name;
    row.tolerance_mm = tolerance_mm;
    // The residual of the previous transition, or the excess over a stricter band, is corrected at
    // the start.
    row.delta_mm.push_back(at_border(piece, band));
    Result<void> done = correct(i, 0.0, row.delta_mm.back());
    double from_s = 0.0;
    double after_s = 0.0;
    while (done) {
      const auto [crossing_s, sign] = next(piece, band, after_s);
      const double at_s = rounded(piece, crossing_s);
      if (sign == 0 || at_s > piece.seconds - kInstant_s) {
        break;  // any excess at the end is corrected at the next transition's start
      }
      // From the later of the two: a rounded instant may precede its crossing, which would be found
      // again.
      after_s = std::max(crossing_s, at_s);
      // early: the transition's first δ takes it, instead of an interval of its own.
      const bool early = belongs_to_start(piece, from_s, at_s, sign);
      // Twice the band takes the residual from one border to the other; at the start it may not be
      // at the border yet.
      const double delta_mm = sign * (request_.whole_band && !early ? 2.0 : 1.0) * band;
      if (early || at_s - from_s < kInstant_s) {
        row.delta_mm.back() += delta_mm;
        done = correct(i, from_s, delta_mm);
        continue;
      }
      if (piece.start_s + at_s - corrected_s_ < request_.min_interval_s) {
        return refuse(fmt::format("corrections of {} would come within {:.3g} s of each other",
                                  place(i, at_s), piece.start_s + at_s - corrected_s_),
                      "give a wider tolerance or a lower level");
      }
      row.interval_s.push_back(at_s - from_s);
      row.delta_mm.push_back(delta_mm);
      from_s = at_s;
      done = correct(i, at_s, delta_mm);
    }
    row.interval_s.push_back(piece.seconds - from_s);
    for (const double delta_mm : row.delta_mm) {
      out_.corrections += delta_mm != 0.0 ? 1U : 0U;
    }
    out_.transition.push_back(std::move(row));
    return done;
  }

  /// Too soon after the correction at a transition's start, which may as well include it: the
  /// residual is already on that side of the band.
  [[nodiscard]] bool belongs_to_start(const Curve::Piece& piece, double from_s, double at_s,
                                      int sign) const {
    return from_s == 0.0 && corrected_s_ == piece.start_s && at_s < request_.min_interval_s &&
           sign * (value(piece.displacement_mm, 0.0) - corrected_mm_) >= 0.0;
  }

  /// The correction that brings the residual inside a new band.
  [[nodiscard]] double at_border(const Curve::Piece& piece, double band) const {
    const double residual = value(piece.displacement_mm, 0.0) - corrected_mm_;
    const double beyond = std::abs(residual) - band;
    if (beyond <= kReached_mm) {
      return 0.0;
    }
    // Whole bands, as few as needed: corrections stay multiples of Δ_k, as in the paper.
    return std::copysign(std::ceil((beyond - kReached_mm) / band) * band, residual);
  }

  [[nodiscard]] double rounded(const Curve::Piece& piece, double at_s) const {
    if (!(request_.resolution_s > 0.0) || at_s < kInstant_s) {
      return at_s;
    }
    // Rounded on the cyclogram's clock, not the transition's: errors must not accumulate.
    const double whole = std::round((piece.start_s + at_s) / request_.resolution_s);
    return std::max(0.0, whole * request_.resolution_s - piece.start_s);
  }

  struct Event {
    double at_s = 0.0;
    int sign = 0;  ///< 0: none until the end
  };

  /// The next instant from `from_s` on at which the residual leaves the band: `from_s` itself if it
  /// is on the border, or beyond, and moving outward.
  [[nodiscard]] Event next(const Curve::Piece& piece, double band, double from_s) const {
    const double residual = value(piece.displacement_mm, from_s) - corrected_mm_;
    if (std::abs(residual) >= band - kReached_mm &&
        residual * value(slope_of(piece.displacement_mm), from_s) > 0.0) {
      return {from_s, residual > 0.0 ? 1 : -1};
    }
    Event first;
    // At the upper border the constant −corrected − band is added; the roots are the crossings.
    for (const int sign : {1, -1}) {
      Exponentials beyond = piece.displacement_mm;
      beyond.push_back({-corrected_mm_ - sign * band, 0.0});
      for (const double t : sign_changes(std::move(beyond), piece.seconds)) {
        // The root of the last correction must not be found again, and a curve that touches the
        // border and turns back needs no correction.
        const bool later = t > from_s + 1e-6;
        const bool leaves =
            sign * (value(piece.displacement_mm, std::min(t + 1e-3, piece.seconds)) -
                    value(piece.displacement_mm, std::max(t - 1e-3, 0.0))) >
            0.0;
        if (later && leaves && t < piece.seconds && (first.sign == 0 || t < first.at_s)) {
          first = {t, sign};
        }
      }
    }
    return first;
  }

  Result<void> correct(std::size_t i, double at_s, double delta_mm) {
    corrected_mm_ += delta_mm;
    if (delta_mm != 0.0) {
      corrected_s_ = curve_.piece[i].start_s + at_s;
    }
    out_.largest_offset_mm = std::max(out_.largest_offset_mm, std::abs(corrected_mm_));
    if (std::abs(corrected_mm_) > request_.max_offset_mm + kReached_mm) {
      return refuse(
          fmt::format(
              "{} would be corrected by {:.1f} µm, more than the {:.1f} µm the machine allows",
              place(i, at_s), std::abs(corrected_mm_) * 1e3, request_.max_offset_mm * 1e3),
          "let the machine cool down or warm up first, or raise [thermal] max_offset_um");
    }
    return {};
  }

  /// The law of a valid plan: in every interval of the finished plan, with its rounded instants, |δ
  /// − corrections| ≤ Δ_k + early_s·(steepest slope). A correction is early or late by at most half
  /// of `resolution_s`, or by kInstant_s where instants were merged, and the displacement continues
  /// meanwhile.
  Result<void> band_is_held() {
    double corrected = 0.0;
    for (std::size_t i = 0; i < out_.transition.size(); ++i) {
      const Exponentials& f = curve_.piece[i].displacement_mm;
      const PlannedTransition& row = out_.transition[i];
      const std::vector<double> extremes = extremes_of(f, curve_.piece[i].seconds);
      double most = 0.0;
      double from_s = 0.0;
      for (std::size_t j = 0; j < row.interval_s.size(); ++j) {
        corrected += row.delta_mm[j];
        const double to_s = from_s + row.interval_s[j];
        const auto look = [&](double t) {
          most = std::max(most, std::abs(value(f, t) - corrected));
        };
        look(from_s);
        look(to_s);
        for (const double t : extremes) {
          if (t > from_s && t < to_s) {
            look(t);
          }
        }
        from_s = to_s;
      }
      const double early_s = std::max(kInstant_s, 0.5 * request_.resolution_s);
      // Rounding an instant costs at most the displacement's change in half a step of the
      // resolution.
      const double band = request_.share * row.tolerance_mm + 2.0 * kReached_mm;
      const double over = early_s * steepest_mm_s(f, curve_.piece[i].seconds);
      const double allowed = band + over;
      if (most > allowed) {
        return refuse(fmt::format("{} would be left {:.3g} µm off, more than the {:.3g} µm allowed",
                                  place(i, 0.0), most * 1e3, allowed * 1e3),
                      "give a wider tolerance, a lower level or a finer resolution");
      }
      out_.largest_residual_mm = std::max(out_.largest_residual_mm, most);
      if (most - band > out_.over_band_mm) {
        out_.over_band_mm = most - band;
        out_.allowed_over_mm = over;
      }
    }
    return {};
  }

  const Curve& curve_;
  const Cyclogram& cyclogram_;
  const PlanRequest& request_;
  AxisCorrections out_;
  double corrected_mm_ = 0.0;
  double corrected_s_ = -std::numeric_limits<double>::infinity();  ///< the last non-zero one
};

}  // namespace

Result<AxisCorrections> plan_corrections(const std::string& name, const Curve& curve,
                                         const Cyclogram& cyclogram, const PlanRequest& request) {
  return Planner(curve, cyclogram, request).run(name);
}

}  // namespace steadyrest::thermal::offline
