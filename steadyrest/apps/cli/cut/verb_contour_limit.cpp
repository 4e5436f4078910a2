// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <memory>
#include <optional>

#include <fmt/core.h>

#include <steadyrest/apps/cli/cut/verb_contour_limit.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/apps/cli/shared/value_check.hpp>
#include <steadyrest/contour/offline/closed_form.hpp>
#include <steadyrest/kernel/units/convert.hpp>

// Steady state on an arc: the axes with gain k lag by v/k, which pulls the tool inside the circle
// by ε ≈ v²/(2Rk²). The law is in contour/offline/closed_form.hpp.
namespace steadyrest::apps::cli {
namespace contour_limit {
namespace {

using contour::offline::CircleErrors;
using contour::offline::CircleLimit;
using contour::offline::Servo;

struct Options {
  double radius_mm = 0.0;
  double gain_1_s = 0.0;
  std::optional<double> max_error_mm;
  std::optional<double> feed_mm_min;
  double feed_forward = 0.0;
  double velocity_lag_ms = 0.0;

  [[nodiscard]] Servo servo() const {
    return {gain_1_s, feed_forward, kernel::units::s_from_ms(velocity_lag_ms)};
  }
};

/// A number, or null: with full feed-forward and no lag no speed reaches the limit, and the feed
/// has no bound.
Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

std::string feed_text(double feed_mm_min) {
  return std::isfinite(feed_mm_min) ? fmt::format("{:.1f} mm/min", feed_mm_min) : "no limit";
}

/// Contour and tracking error side by side: the following errors are many times larger than what
/// they cost on the contour, and people mix them up.
void put(Answer& answer, double feed_mm_min, const CircleErrors& errors) {
  answer.json["feed_mm_min"] = number_or_null(feed_mm_min);
  answer.json["contour_error_mm"] = errors.contour_error_mm;
  answer.json["tracking_error_mm"] = errors.tracking_error_mm;
  answer.text = Table()
                    .row({"feed", feed_text(feed_mm_min)})
                    .row({"contour error", fmt::format("{:.4f} mm", errors.contour_error_mm)})
                    .row({"tracking error", fmt::format("{:.4f} mm", errors.tracking_error_mm)})
                    .text();
}

/// The feed for an error: the largest v for which |ε| stays within the limit at that and every
/// lower speed.
Outcome limit(const Options& options) {
  const Result<CircleLimit> found = contour::offline::circle_limit(
      options.servo(), options.radius_mm, options.max_error_mm.value_or(0.0));
  if (!found) {
    return refused(found.error());
  }
  Answer answer;
  put(answer, kernel::units::mm_min_from_mm_s(found->speed_mm_s), found->errors);
  return answer;
}

/// The error at a feed. With a limit as well: whether the feed holds it, and the feed that would.
Outcome errors_at(const Options& options, double feed_mm_min) {
  const Result<CircleErrors> errors = contour::offline::circle_errors(
      options.servo(), options.radius_mm, kernel::units::mm_s_from_mm_min(feed_mm_min));
  if (!errors) {
    return refused(errors.error());
  }
  Answer answer;
  put(answer, feed_mm_min, *errors);
  if (options.max_error_mm) {
    const Result<CircleLimit> found =
        contour::offline::circle_limit(options.servo(), options.radius_mm, *options.max_error_mm);
    if (!found) {
      return refused(found.error());
    }
    // ε has a sign: a velocity loop with lag (kτ > 0.5) makes the circle too large. The limit holds
    // for both directions.
    const double limit_mm_min = kernel::units::mm_min_from_mm_s(found->speed_mm_s);
    answer.json["limit_feed_mm_min"] = number_or_null(limit_mm_min);
    answer.json["within_limit"] = std::abs(errors->contour_error_mm) <= *options.max_error_mm;
    answer.text += fmt::format("{} {:.4f} mm, which allows {}\n",
                               answer.json["within_limit"] ? "within" : "over",
                               *options.max_error_mm, feed_text(limit_mm_min));
  }
  return answer;
}

/// A given feed wins: it is then judged by the limit.
Outcome run(const Options& options) {
  if (options.feed_mm_min) {
    return errors_at(options, *options.feed_mm_min);
  }
  if (options.max_error_mm) {
    return limit(options);
  }
  return refused(bad_input("neither --max-error-mm nor --feed-mm-min is given",
                           "give the error to get the feed, or the feed to get the error"));
}

}  // namespace
}  // namespace contour_limit

void add_verb_contour_limit(Session& session, Verb& verb) {
  auto options = std::make_shared<contour_limit::Options>();
  verb.add_option("--radius-mm", options->radius_mm, "Radius of the arc")
      ->required()
      ->check(within(1e-6, 1e9));
  verb.add_option("--kv-1-s", options->gain_1_s, "Servo gain in 1/s; 1 (m/min)/mm = 16.667 1/s")
      ->required()
      ->check(within(1e-3, 1e6));
  verb.add_option("--max-error-mm", options->max_error_mm,
                  "Largest contour error; gives the largest feed")
      ->check(within(1e-9, 1e9));
  verb.add_option("--feed-mm-min", options->feed_mm_min, "Path feed; gives the errors")
      ->check(within(0.0, 1e9));
  verb.add_option("--feed-forward", options->feed_forward,
                  "Weight of the velocity feed-forward, 0 none, 1 full")
      ->check(within(0.0, 1.5));
  verb.add_option("--velocity-lag-ms", options->velocity_lag_ms,
                  "First-order lag of the velocity loop in ms")
      ->check(within(0.0, 1e4));
  session.on(verb, [options](Progress& /*progress*/) { return contour_limit::run(*options); });
}

}  // namespace steadyrest::apps::cli
