// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/thermal/offline/fit/fit_refusal.hpp>
#include <steadyrest/thermal/offline/log/level_table.hpp>
#include <steadyrest/thermal/offline/log/log_inputs.hpp>

// A fit always gives numbers. It refuses what the log cannot determine: two exponentials fitted to
// 20 min forecast 240 min to ±170 µm, and fitted to 60 min still to ±7 µm.
namespace steadyrest::thermal::offline {
namespace {

using kernel::outcome::bad_input;
using kernel::outcome::Refusal;

constexpr double kHorizonPerRun = 2.0;
constexpr double kMostHorizonSd = 0.25;  ///< of the range
constexpr double kRunPerTau = 1.5;       ///< a run shows a time constant if it is this much longer

Refusal refuse(const Log& log, std::string what, std::string to_do) {
  return bad_input(log.file, std::move(what), std::move(to_do));
}
// With fewer than three speeds a table is a straight line; a polynomial says as much with less.
std::optional<Refusal> unfit_speeds(const Log& log, const std::vector<double>& table_rev_s) {
  const std::size_t speeds = table_rev_s.size();
  if (speeds >= kLeastSpeeds && speeds <= kMostSpeeds) {
    return std::nullopt;
  }
  std::string held;
  for (std::size_t k = 0; k < speeds && k < kMostSpeeds; ++k) {
    held += fmt::format("{}{:.0f}", k == 0 ? ": " : ", ",
                        kernel::units::rpm_from_rev_s(table_rev_s[k]));
  }
  return refuse(
      log,
      fmt::format(
          "a table of levels needs {} … {} speeds held for {:.0f} min each; the log has {}{}{}",
          kLeastSpeeds, kMostSpeeds, kHeld_s / 60.0, speeds, held, held.empty() ? "" : " rpm"),
      "run the test at more speeds, or fit a polynomial: --levels polynomial");
}
}  // namespace

std::optional<Refusal> unfit(const FitData& data, const FitRequest& request,
                             const std::vector<double>& table_rev_s) {
  const Log& log = *data.log;
  const std::string& name = log.displacement[data.channel].name;
  if (data.rows() < kLeastRows) {
    return refuse(log,
                  fmt::format("{} has {} readings in the window; {} are needed", name, data.rows(),
                              kLeastRows),
                  "widen the window");
  }
  if (request.known != nullptr) {
    if (const auto inputs = inputs_of(*request.known, log); !inputs) {
      return inputs.error();
    }
  }
  const double run_s = longest_run_s(log, request.from_s, request.to_s);
  if (run_s == 0.0 && request.known == nullptr) {
    return refuse(log, "the spindle never runs",
                  "log a test with the spindle running: docs/thermal-test.md");
  }
  // With time constants from a longer test this log only has to give the level; an hour is enough
  // for that.
  if (request.known == nullptr && request.horizon_s > kHorizonPerRun * run_s) {
    return refuse(
        log,
        fmt::format("the longest run at one speed is {:.0f} min, too short to fit a forecast over "
                    "{:.0f} min",
                    run_s / 60.0, request.horizon_s / 60.0),
        fmt::format("run at one speed for {:.0f} min at least, ask for a shorter --horizon-min, or "
                    "take time constants from a longer test with --tau-from",
                    request.horizon_s / kHorizonPerRun / 60.0));
  }
  return request.table && request.known == nullptr ? unfit_speeds(log, table_rev_s) : std::nullopt;
}

// Judged after the fit: its covariance shows whether the log was long enough.
std::optional<Refusal> too_uncertain(const AxisFit& fit, const FitData& data,
                                     const FitRequest& request) {
  const Log& log = *data.log;
  const double range_um = data.reading_um.maxCoeff() - data.reading_um.minCoeff();
  double slowest_s = 0.0;
  for (const auto& mode : fit.axis.mode) {
    slowest_s = std::max(slowest_s, mode.tau_s);
  }
  const double run_s = longest_run_s(log, request.from_s, request.to_s);
  // After 1.5·τ a mode has reached 78 % of its level and bends visibly; before that, slope and
  // level cannot be separated.
  const double need_s = kRunPerTau * slowest_s;
  // With three blocks the left-out hours themselves reveal a wrong time constant.
  const bool hidden = data.block.size() < kLeastBlocks && run_s < need_s;
  if (request.known != nullptr || (fit.horizon_sd_um <= kMostHorizonSd * range_um && !hidden)) {
    return std::nullopt;
  }
  // Either reason alone refuses; both are reported, since the same longer run cures both.
  std::string why;
  if (fit.horizon_sd_um > kMostHorizonSd * range_um) {
    why = fmt::format("a forecast over {:.0f} min would be uncertain by {:.1f} µm of {:.1f} µm",
                      request.horizon_s / 60.0, fit.horizon_sd_um, range_um);
  }
  if (run_s < need_s) {
    why +=
        fmt::format("{}the slowest time constant, {:.0f} min, does not show in a run of {:.0f} min",
                    why.empty() ? "" : ", and ", slowest_s / 60.0, run_s / 60.0);
  }
  return refuse(
      log,
      fmt::format("{}: this log does not determine {} {}: {}", fit.channel, fit.axis.mode.size(),
                  fit.axis.mode.size() == 1 ? "mode" : "modes", why),
      fmt::format("run at one speed for {:.0f} min at least, then let it cool as long; or take "
                  "time constants from a longer test with --tau-from",
                  std::max(need_s, 1.5 * run_s) / 60.0));
}

}  // namespace steadyrest::thermal::offline
