// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/motion/offline/bench/estimator_choice.hpp>
#include <steadyrest/motion/online/bounded/motion_estimator.hpp>
#include <steadyrest/motion/online/bounded/ripple_estimator.hpp>
#include <steadyrest/motion/online/estimator/backward_difference.hpp>
#include <steadyrest/motion/online/estimator/event_fit.hpp>
#include <steadyrest/motion/online/estimator/m_over_t.hpp>
#include <steadyrest/motion/online/estimator/pll.hpp>
#include <steadyrest/motion/online/estimator/savitzky_golay.hpp>
#include <steadyrest/motion/online/estimator/worst_case_difference.hpp>

// Names, needs and factory of each estimator: the only place to add one.
namespace steadyrest::motion::offline {
namespace {

using kernel::outcome::bad_input;
using kernel::outcome::Refusal;
using kernel::outcome::refuse;

template <class T>
EstimatorResult made(const typename T::Config& config) {
  auto estimator = T::make(config);
  if (!estimator) {
    return std::unexpected(estimator.error());
  }
  return std::make_unique<T>(std::move(*estimator));
}

// Both of ours have the same settings.
template <class T>
EstimatorResult kalman(const EstimatorSetup& setup) {
  typename T::Config config;
  config.count_mm = setup.count_mm;
  config.cycle_s = 1.0 / setup.cycle_hz;
  config.clock_s = setup.clock_s;
  config.line_error_mm = setup.line_error_mm.value_or(-1.0);
  config.max_speed_mm_s = setup.max_speed_mm_s;
  config.max_acceleration_mm_s2 = setup.max_acceleration_mm_s2;
  config.max_jerk_mm_s3 = setup.max_jerk_mm_s3;
  config.lag_s = setup.lag_s;
  return made<T>(config);
}

/// Those that need only the count and possibly the cycle.
template <class T>
EstimatorResult plain(const EstimatorSetup& setup) {
  typename T::Config config;
  config.count_mm = setup.count_mm;
  if constexpr (requires { config.cycle_s; }) {
    config.cycle_s = 1.0 / setup.cycle_hz;
  }
  return made<T>(config);
}

EstimatorResult worst_case(const EstimatorSetup& setup) {
  online::WorstCaseDifference::Config config;
  config.count_mm = setup.count_mm;
  config.cycle_s = 1.0 / setup.cycle_hz;
  config.max_acceleration_mm_s2 = setup.max_acceleration_mm_s2;
  config.line_error_mm = setup.line_error_mm.value_or(0.0);
  return made<online::WorstCaseDifference>(config);
}

/// One line for each estimator; the first is the default.
struct Choice {
  std::string_view name;
  EstimatorResult (*make)(const EstimatorSetup& setup);
  bool needs_edges = false;
  bool takes_lag = false;
  bool needs_acceleration = false;  ///< the axis's limit
};
constexpr std::array kChoices{
    Choice{"kalman", kalman<online::MotionEstimator>, false, true},
    Choice{"kalman-ripple", kalman<online::RippleEstimator>, true, true},
    Choice{"difference", plain<online::BackwardDifference>},
    Choice{"mt", plain<online::MOverT>, true},
    Choice{"savitzky-golay", plain<online::SavitzkyGolay>},
    Choice{"event-fit", plain<online::EventFit>, true},
    Choice{"pll", plain<online::Pll>},
    Choice{"worst-case", worst_case, false, false, true},
};

/// A limit may be infinite (unknown), but not 0, negative or NaN. Positive includes infinity; the
/// comparison itself fails for NaN.
std::optional<Refusal> unfit_limit(std::string_view what, double value, const char* to_do) {
  if (value > 0.0) {
    return std::nullopt;
  }
  return bad_input(fmt::format("{} = {:.10g}; allowed: a number above 0", what, value), to_do);
}

std::optional<Refusal> unfit_amount(std::string_view what, double value) {
  if (value >= 0.0 && std::isfinite(value)) {
    return std::nullopt;
  }
  return bad_input(fmt::format("{} = {:.10g}; allowed: a finite number from 0", what, value),
                   "give a value in that range");
}

std::optional<Refusal> unfit(const EstimatorSetup& setup) {
  // The first fault only: one thing to correct at a time.
  std::optional<Refusal> out;
  for (const auto& [what, value] :
       {std::pair{"largest speed in mm/s", setup.max_speed_mm_s},
        std::pair{"largest acceleration in mm/s²", setup.max_acceleration_mm_s2},
        std::pair{"largest jerk in mm/s³", setup.max_jerk_mm_s3}}) {
    out = out ? out : unfit_limit(what, value, "give the limit of the axis, or leave it out");
  }
  out = out ? out : unfit_limit("count in mm", setup.count_mm, "give the length of one count");
  out = out ? out
            : unfit_limit("control cycle in Hz", setup.cycle_hz,
                          "give the cycles of the control in a second");
  for (const auto& [what, value] :
       {std::pair{"line error in mm", setup.line_error_mm.value_or(0.0)},
        std::pair{"lag in s", setup.lag_s},
        std::pair{"period of the time stamps in s", setup.clock_s}}) {
    out = out ? out : unfit_amount(what, value);
  }
  return out;
}

}  // namespace

std::vector<std::string_view> estimator_names() {
  std::vector<std::string_view> out;
  out.reserve(kChoices.size());
  for (const Choice& choice : kChoices) {
    out.push_back(choice.name);
  }
  return out;
}

EstimatorResult make_estimator(std::string_view name, const EstimatorSetup& setup) {
  const auto* choice = std::ranges::find(kChoices, name, &Choice::name);
  if (choice == kChoices.end()) {
    return refuse(fmt::format("there is no estimator \"{}\"", name),
                  fmt::format("give one of {}", fmt::join(estimator_names(), ", ")));
  }
  if (auto refusal = unfit(setup)) {
    return std::unexpected(std::move(*refusal));
  }
  // An option without effect misleads, so it is refused rather than ignored.
  if (setup.lag_s > 0.0 && !choice->takes_lag) {
    return refuse(fmt::format("the estimator {} takes no lag", name), "leave out the lag");
  }
  if (!setup.has_edges && choice->needs_edges) {
    return refuse(fmt::format("the estimator {} needs edges", name),
                  "give a log of edges, or choose another estimator");
  }
  if (choice->needs_acceleration && !std::isfinite(setup.max_acceleration_mm_s2)) {
    return refuse(fmt::format("the estimator {} needs the largest acceleration of the axis", name),
                  "give --max-acceleration in mm/s²");
  }
  return choice->make(setup);
}

}  // namespace steadyrest::motion::offline
