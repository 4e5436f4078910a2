// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <expected>
#include <utility>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <steadyrest/apps/cli/program/ahead/feeds_ahead.hpp>
#include <steadyrest/apps/cli/program/ahead/path_ahead.hpp>
#include <steadyrest/apps/cli/program/ahead/predicted_change.hpp>
#include <steadyrest/apps/cli/shared/value_check.hpp>
#include <steadyrest/contour/offline/predict/model_run.hpp>

namespace steadyrest::apps::cli {
namespace {

using contour::offline::Predistorted;
using kernel::outcome::Result;

constexpr double kPercent = 100.0;
constexpr double kUsualShift_mm = 0.5;
constexpr double kLargeError_mm = 0.25;
constexpr double kLargeShift_mm = 2.0;

double all_waits_s(const Predistorted& done) {
  double out = 0.0;
  for (const auto& [line, seconds] : done.waits) {
    out += seconds;
  }
  return out;
}

void put_figures(Answer& answer, const Predistorted& done, const PathOptions& options) {
  put_prediction(answer, done, options.max_error_mm);
  Json& json = answer.json;
  json["uncertain"] = {{"gain_percent", kPercent * done.gain_uncertainty},
                       {"lag_percent", kPercent * done.lag_uncertainty},
                       {"lag_unknown", done.unknown_lags},
                       {"error_max_before_mm", done.worst_before_mm},
                       {"error_max_mm", done.worst_after_mm},
                       {"error_rms_before_mm", done.worst_rms_before_mm},
                       {"error_rms_mm", done.worst_rms_after_mm}};
  json["largest_shift_mm"] = done.largest_shift_mm;
  json["dwells"] = done.waits.size();
  json["dwell_s"] = all_waits_s(done);
  json["too_far"] = done.too_far;
  json["past_travel"] = done.past_travel;
  json["not_better"] = done.worse;
  json["not_proved"] = done.unproved;
  json["slower"] = done.slower ? Json({{"seconds", done.slower->seconds},
                                       {"predicted_error_max_mm", done.slower->max_mm},
                                       {"predicted_error_rms_mm", done.slower->rms_mm}})
                               : Json(nullptr);
}

/// What time would buy; empty where it would not buy much.
std::string slower_text(const Predistorted& done) {
  if (!done.slower) {
    return {};
  }
  const double percent = kPercent * (done.slower->seconds / done.seconds_before - 1.0);
  return fmt::format(
      "about {} RMS, {} at most, could be had in {:.2f} s ({:.1f} % more): --max-time-percent {}\n",
      in_um(done.slower->rms_mm), in_um(done.slower->max_mm), done.slower->seconds, percent,
      std::ceil(percent));
}

/// Which lags the machine file lacks, and what that keeps from being corrected.
std::string unknown_text(const Predistorted& done) {
  if (done.unknown_lags.empty()) {
    return {};
  }
  const std::string names = fmt::format("{}", fmt::join(done.unknown_lags, ", "));
  if (done.lag_uncertainty == 0.0) {
    return fmt::format(
        "the lag of the velocity loop of {} is not known: where it is more than a quarter of "
        "1 / servo gain, the part can come out worse\n",
        names);
  }
  return fmt::format(
      "the lag of the velocity loop of {} is not known: blocks change only where the part gets no "
      "worse with any up to {:g} % of 1 / servo gain. machine from-log fits it, velocity_lag_ms in "
      "the machine file says it; --lag-uncertainty-percent 0 takes the risk\n",
      names, kPercent * done.lag_uncertainty);
}

std::string text_of(const Predistorted& done, const PathOptions& options) {
  std::string off = fmt::format("gains up to {:g} % off", kPercent * done.gain_uncertainty);
  if (done.lag_uncertainty > 0.0) {
    off += fmt::format(", lags up to {:g} % of 1/k", kPercent * done.lag_uncertainty);
  }
  std::string text =
      prediction_table(done, options.max_error_mm)
          .row({"largest, " + off, in_um(done.worst_before_mm), in_um(done.worst_after_mm)})
          .row({"RMS, " + off, in_um(done.worst_rms_before_mm), in_um(done.worst_rms_after_mm)})
          .text();
  text +=
      done.replaced.replaced == 0
          ? options.hold
                ? std::string(
                      "nothing wins enough for the time that it costs; the program is unchanged\n")
                : fmt::format(
                      "nothing can be won in {:g} % more time; the program is "
                      "unchanged\n",
                      options.max_time_percent)
          : fmt::format("{} blocks replaced by {}; the command leaves the path by at most {}\n",
                        done.replaced.replaced, done.replaced.new_lines,
                        in_um(done.largest_shift_mm));
  if (!done.waits.empty()) {
    text += fmt::format("{} dwells let the tool arrive between a rapid and the cut: {:.2f} s\n",
                        done.waits.size(), all_waits_s(done));
  }
  text += unknown_text(done) + (options.hold ? std::string{} : slower_text(done));
  if (!done.past_travel.empty()) {
    text +=
        fmt::format("unchanged, because an axis would leave its travel: {} blocks, line {} first\n",
                    done.past_travel.size(), done.past_travel.front());
  }
  if (!done.too_far.empty()) {
    text += fmt::format("unchanged, because the shift would exceed {:g} mm: {} blocks\n",
                        *options.max_shift_mm, done.too_far.size());
  }
  if (!done.worse.empty()) {
    text +=
        fmt::format("unchanged, because it would not get better: {} blocks\n", done.worse.size());
  }
  if (!done.unproved.empty()) {
    text += fmt::format("unchanged, because {}: {} blocks\n",
                        nc::rewrite::sentence(nc::rewrite::Stays::unproved), done.unproved.size());
  }
  return text;
}

/// What the predicted error may be, so that the true one keeps the limit; 0: feeds stay.
double hold_mm(const PathOptions& options, const kernel::machine::Machine& machine) {
  const FeedReserve reserve = feed_reserve(machine, options.max_error_mm);
  // Half of the backlash is part of the prediction.
  return options.hold ? options.max_error_mm - reserve.margin_mm - reserve.encoder_mm : 0.0;
}

}  // namespace

void add_path_options(Verb& verb, PathOptions& options) {
  verb.add_option("--max-error-mm", options.max_error_mm,
                  "Contour error that counts as too large; what remains above it is named")
      ->check(within(0.0001, 10.0));
  verb.add_option("--max-shift-mm", options.max_shift_mm,
                  "How far the command may leave the programmed path; a block that would need more "
                  "stays. Default: 0.5, or 2 where the program's predicted error exceeds 0.25 mm")
      ->check(within(0.001, 5.0));
  verb.add_option(
          "--gain-uncertainty-percent", options.gain_uncertainty_percent,
          "How far each servo gain may be off the machine file; blocks are changed only where the "
          "worst such machine does not get worse")
      ->check(within(0.0, 30.0));
  verb.add_option("--lag-uncertainty-percent", options.lag_uncertainty_percent,
                  "The same for the lag of each axis' velocity loop, in percent of 1 / servo gain; "
                  "default: 50 where the machine file has no velocity_lag_ms, 0 where it has")
      ->check(within(0.0, 50.0));
  verb.add_option("--max-time-percent", options.max_time_percent,
                  "How much longer the program may take at the feeds that it has; sharp corners "
                  "need more than the default 2 %, and what that would win is said. Does not bound "
                  "--hold-limit")
      ->check(within(0.0, 100.0));
  verb.add_flag(
      "--hold-limit", options.hold,
      "Lower the feed where the path alone does not keep --max-error-mm, and wait (G4) where a "
      "rapid carries its lag into the cut; the program takes that much longer");
  add_learning_options(verb, options.learning);
}

Result<void> settle_shift(PathOptions& options, const SourceProgram& program) {
  if (options.max_shift_mm) {
    return {};
  }
  double largest_mm = 0.0;
  const auto& path = program.path;
  const auto map = contour::offline::same_path(path);
  const auto model = contour::offline::servo_models(program.machine.axes);
  const auto seconds = contour::offline::run_model(
      {.machine = program.machine,
       .path = path,
       .original = path,
       .map = map,
       .model = model,
       .others = {},
       .backlash_mm = contour::offline::backlash_mm(program.machine.axes)},
      [&](const contour::offline::ModelSample& sample) {
        largest_mm = sample.cuts ? std::max(largest_mm, std::abs(sample.error_mm)) : largest_mm;
      });
  options.max_shift_mm = largest_mm > kLargeError_mm ? kLargeShift_mm : kUsualShift_mm;
  return seconds ? Result<void>{} : std::unexpected(seconds.error());
}

std::string changes_of(const PathOptions& options) {
  return options.hold ? "predistort,feeds,dwells" : "predistort";
}

std::vector<nc::rewrite::Told> told_of(const PathOptions& options) {
  std::vector<nc::rewrite::Told> told = {
      {"max-error-mm", fmt::format("{:g}", options.max_error_mm)},
      {"tube-mm", fmt::format("{:g}", *options.max_shift_mm)},
      {"gain-uncertainty-percent", fmt::format("{:g}", options.gain_uncertainty_percent)}};
  if (options.lag_uncertainty_percent) {
    told.push_back(
        {"lag-uncertainty-percent", fmt::format("{:g}", *options.lag_uncertainty_percent)});
  }
  return told;
}

Result<Predistorted> path_ahead(const PathOptions& options, const SourceProgram& program,
                                const std::string& file, std::vector<nc::rewrite::Told> told,
                                Progress& progress) {
  auto parts = read_parts(options.learning, file);
  if (!parts) {
    return std::unexpected(parts.error());
  }
  return contour::offline::predistort(
      file, program.config, program.machine,
      {.limit_mm = options.max_error_mm,
       .max_shift_mm = *options.max_shift_mm,
       .gain_uncertainty = options.gain_uncertainty_percent / kPercent,
       .lag_uncertainty = options.lag_uncertainty_percent.transform(
           [](double percent) { return percent / kPercent; }),
       .most_time = 1.0 + options.max_time_percent / kPercent,
       .hold_mm = hold_mm(options, program.machine),
       .parts = std::move(*parts),
       .told = std::move(told),
       .progress = [&](double share, std::string_view what) { progress.update(share, what); }});
}

std::string put_path(Answer& answer, const Predistorted& done, const PathOptions& options) {
  put_figures(answer, done, options);
  return put_learnt(answer, options.learning, done) + text_of(done, options);
}

}  // namespace steadyrest::apps::cli
