// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <expected>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/program/ahead/learnt_parts.hpp>
#include <steadyrest/apps/cli/program/ahead/predicted_change.hpp>
#include <steadyrest/contour/offline/learn/in_force.hpp>

namespace steadyrest::apps::cli {
namespace {

using contour::offline::CutPart;
using contour::offline::FittedAxis;
using contour::offline::LearningFigures;
using contour::offline::LeftOut;
using contour::online::AxisModel;
using kernel::outcome::Result;

Json json_of(const LearningFigures& figures) {
  Json left_out = Json::array();
  for (const LeftOut& one : figures.left_out) {
    left_out.push_back({{"reason", contour::offline::reason_of(one.why)},
                        {"from_s", one.from_s},
                        {"to_s", one.to_s},
                        {"first_line", one.first_line},
                        {"last_line", one.last_line}});
  }
  return {{"cut_s", figures.cut_s},
          {"learns_s", figures.learns_s},
          {"measured_rms_mm", figures.measured_rms_mm},
          {"unknown_rms_mm", figures.unknown_rms_mm},
          {"cut_off_hz", figures.cut_off_hz},
          {"convergence", figures.convergence},
          {"left_out", std::move(left_out)}};
}

Json json_of(const AxisModel& axis) {
  return {{"servo_gain_1_s", axis.gain_1_s},
          {"feed_forward", axis.feed_forward},
          {"velocity_lag_ms", 1000.0 * axis.velocity_lag_s}};
}

std::string words_of(const AxisModel& axis) {
  return fmt::format("gain {:.4g} 1/s, feed-forward {:.3g}, lag {:.3g} ms", axis.gain_1_s,
                     axis.feed_forward, 1000.0 * axis.velocity_lag_s);
}

/// What the records say of the axes, where the machine file says something else.
std::string put_fitted(Answer& answer, const std::vector<FittedAxis>& fitted) {
  answer.json["fitted"] = Json::array();
  std::string text;
  for (const FittedAxis& one : fitted) {
    answer.json["fitted"].push_back({{"axis", one.name},
                                     {"record", json_of(one.is)},
                                     {"machine_file", json_of(one.was)},
                                     {"lag_was_known", one.lag_was_known}});
    text +=
        fmt::format("axis {}: {} by the record, {}{} by the machine file\n", one.name,
                    words_of(one.is), words_of(one.was), one.lag_was_known ? "" : " (not known)");
  }
  return text.empty() ? text
                      : text +
                            "the text is made for the axes of the record; machine from-log puts "
                            "them into the machine file\n";
}

std::string put_kept_part(Answer& answer, const LearningOptions& options,
                          const std::optional<std::size_t>& part) {
  answer.json["kept_part"] = part ? Json(options.records[*part]) : Json();
  return part ? fmt::format("no text is surely better than that of the part of {}: it stays\n",
                            options.records[*part])
              : std::string{};
}

}  // namespace

void add_learning_options(Verb& verb, LearningOptions& options) {
  CLI::Option* const records =
      verb.reads("--from-record", options.records,
                 "Learn from a part that was cut before: a CSV of its commanded and measured "
                 "positions (`cut --record`), packed with gzip or not; may be given again for "
                 "further parts");
  verb.reads("--cut-program", options.programs,
             "The program that the part of each --from-record was cut with, in the same order; "
             "default: FILE itself")
      ->needs(records);
}

Result<std::vector<CutPart>> read_parts(const LearningOptions& options,
                                        const std::string& program) {
  if (!options.programs.empty() && options.programs.size() != options.records.size()) {
    return std::unexpected(
        bad_input(fmt::format("--cut-program is given {} times and --from-record {} times",
                              options.programs.size(), options.records.size()),
                  "give one program for each record, in the same order"));
  }
  std::vector<CutPart> parts;
  for (std::size_t i = 0; i < options.records.size(); ++i) {
    auto record = contour::offline::read_part_record(options.records[i]);
    if (!record) {
      return std::unexpected(record.error());
    }
    parts.push_back({.record = std::move(*record),
                     .program = options.programs.empty() ? program : options.programs[i]});
  }
  return parts;
}

std::string put_learnt(Answer& answer, const LearningOptions& options,
                       const contour::offline::Predistorted& done) {
  const std::vector<LearningFigures>& learnt = done.learnt;
  // What the next part has is said of a new program alone.
  const bool changed = done.replaced.replaced > 0 && !done.kept_part;
  std::string text;
  answer.json["learnt"] = Json::array();
  for (std::size_t i = 0; i < learnt.size(); ++i) {
    const LearningFigures& figures = learnt[i];
    Json one = json_of(figures);
    one["record"] = options.records[i];
    answer.json["learnt"].push_back(std::move(one));
    text += fmt::format(
        "learnt from {}: {:.1f} s of the {:.1f} s that it cuts; {} RMS measured, {} RMS of it "
        "unknown to the model{}\n",
        options.records[i], figures.learns_s, figures.cut_s, in_um(figures.measured_rms_mm),
        in_um(figures.unknown_rms_mm),
        changed ? fmt::format("; the next part has at most {:.2f} of that", figures.convergence)
                : "");
    text += first_of(figures.left_out.size(), [&](std::size_t at) {
      const LeftOut& left = figures.left_out[at];
      return fmt::format("  left out: {:.2f} to {:.2f} s, lines {} to {}: {}\n", left.from_s,
                         left.to_s, left.first_line, left.last_line,
                         contour::offline::reason_of(left.why));
    });
  }
  return text + put_fitted(answer, done.fitted) + put_kept_part(answer, options, done.kept_part);
}

}  // namespace steadyrest::apps::cli
