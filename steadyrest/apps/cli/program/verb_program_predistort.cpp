// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>

#include <fmt/core.h>

#include <steadyrest/apps/cli/program/changed_program.hpp>
#include <steadyrest/apps/cli/program/verb_program_predistort.hpp>
#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/apps/cli/shared/value_check.hpp>
#include <steadyrest/contour/offline/predistort/predistort.hpp>
#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/kernel/units/convert.hpp>

// What can be known beforehand belongs in the program: the path that the axes must be commanded so
// that the tool runs on the programmed one.
namespace steadyrest::apps::cli {
namespace program_predistort {
namespace {

using contour::offline::Predistorted;
using kernel::units::um_from_mm;

struct Options {
  ProgramOptions program;
  std::string machine;
  double max_error_mm = 0.01;
  double max_shift_mm = 0.5;
  double gain_uncertainty_percent = 5.0;
  std::string output;
  const CLI::App* verb = nullptr;
};

constexpr double kPercent = 100.0;

void put_figures(Answer& answer, const Predistorted& done, const Options& options) {
  const auto& before = done.before.nominal();
  const auto& after = done.after.nominal();
  Json& json = answer.json;
  json["seconds_before"] = done.seconds_before;
  json["seconds_after"] = done.seconds_after;
  json["predicted_error_max_mm"] = after.max_mm;
  json["predicted_error_rms_mm"] = after.rms_mm();
  json["predicted_error_max_before_mm"] = before.max_mm;
  json["predicted_error_rms_before_mm"] = before.rms_mm();
  json["share_over_limit_before"] = done.before.share_over();
  json["share_over_limit"] = done.after.share_over();
  json["max_error_mm"] = options.max_error_mm;
  json["uncertain"] = {{"gain_percent", options.gain_uncertainty_percent},
                       {"error_max_before_mm", done.worst_before_mm},
                       {"error_max_mm", done.worst_after_mm},
                       {"error_rms_before_mm", done.worst_rms_before_mm},
                       {"error_rms_mm", done.worst_rms_after_mm}};
  json["largest_shift_mm"] = done.largest_shift_mm;
  json["unchanged"] = done.replaced.replaced == 0;
  json["replaced_lines"] = done.replaced.replaced;
  json["new_lines"] = done.replaced.new_lines;
  json["remaining"] = Json::array();
  for (const auto& one : done.remaining) {
    json["remaining"].push_back({{"line", one.line},
                                 {"predicted_error_before_mm", one.before_mm},
                                 {"predicted_error_mm", one.after_mm}});
  }
  json["too_far"] = done.too_far;
  json["not_better"] = done.worse;
}

std::string text_of(const Predistorted& done, const Options& options) {
  const auto um = [](double mm) { return fmt::format("{:.1f} µm", um_from_mm(mm)); };
  const auto& before = done.before.nominal();
  const auto& after = done.after.nominal();
  std::string text =
      Table({"predicted", "before", "after"})
          .row({"cycle time", fmt::format("{:.2f} s", done.seconds_before),
                fmt::format("{:.2f} s", done.seconds_after)})
          .row({"contour error, largest", um(before.max_mm), um(after.max_mm)})
          .row({"contour error, RMS", um(before.rms_mm()), um(after.rms_mm())})
          .row({fmt::format("over {} of the cut", um(options.max_error_mm)),
                fmt::format("{:.2f} %", kPercent * done.before.share_over()),
                fmt::format("{:.2f} %", kPercent * done.after.share_over())})
          .row({fmt::format("largest, gains up to {:g} % off", options.gain_uncertainty_percent),
                um(done.worst_before_mm), um(done.worst_after_mm)})
          .row({fmt::format("RMS, gains up to {:g} % off", options.gain_uncertainty_percent),
                um(done.worst_rms_before_mm), um(done.worst_rms_after_mm)})
          .text();
  text +=
      done.replaced.replaced == 0
          ? "nothing can be won on this machine; the program is unchanged\n"
          : fmt::format("{} blocks replaced by {}; the command leaves the path by at most {}\n",
                        done.replaced.replaced, done.replaced.new_lines, um(done.largest_shift_mm));
  constexpr std::size_t kShown = 8;
  for (std::size_t i = 0; i < std::min(kShown, done.remaining.size()); ++i) {
    const auto& one = done.remaining[i];
    text +=
        fmt::format("line {}: {} remain of {}\n", one.line, um(one.after_mm), um(one.before_mm));
  }
  if (done.remaining.size() > kShown) {
    text += fmt::format("… {} more lines over the limit (--json has them)\n",
                        done.remaining.size() - kShown);
  }
  if (!done.too_far.empty()) {
    text += fmt::format("unchanged, because the shift would exceed {:g} mm: {} blocks\n",
                        options.max_shift_mm, done.too_far.size());
  }
  if (!done.worse.empty()) {
    text +=
        fmt::format("unchanged, because it would not get better: {} blocks\n", done.worse.size());
  }
  return text;
}

Outcome run(const Options& options, Progress& progress) {
  const auto program = read_source_program(options.program, options.machine);
  if (!program) {
    return std::unexpected(program.error());
  }
  auto told = told_of_change(
      "predistort", *options.verb, *program,
      {{"max-error-mm", fmt::format("{:g}", options.max_error_mm)},
       {"tube-mm", fmt::format("{:g}", options.max_shift_mm)},
       {"gain-uncertainty-percent", fmt::format("{:g}", options.gain_uncertainty_percent)}});
  if (!told) {
    return std::unexpected(told.error());
  }
  const auto done = contour::offline::predistort(
      options.program.file, program->config, program->machine,
      {.limit_mm = options.max_error_mm,
       .max_shift_mm = options.max_shift_mm,
       .gain_uncertainty = options.gain_uncertainty_percent / kPercent,
       .told = std::move(*told),
       .progress = [&](double share, std::string_view what) { progress.update(share, what); }});
  if (!done) {
    return refused(done.error());
  }
  if (auto written = kernel::file::write_file(options.output, done->replaced.text); !written) {
    return refused(written.error());
  }
  Answer answer;
  put_figures(answer, *done, options);
  answer.text = text_of(*done, options) + put_kept(answer, program->blocks);
  return answer;
}

}  // namespace
}  // namespace program_predistort

void add_verb_program_predistort(Session& session, Verb& verb) {
  auto options = std::make_shared<program_predistort::Options>();
  options->verb = &verb;
  add_machine_program_options(verb, options->program);
  add_machine_option(verb, options->machine);
  verb.add_option("--max-error-mm", options->max_error_mm,
                  "Contour error that counts as too large; what remains above it is named")
      ->check(within(0.0001, 10.0));
  verb.add_option("--max-shift-mm", options->max_shift_mm,
                  "How far the command may leave the programmed path; a block that would need more "
                  "stays")
      ->check(within(0.001, 5.0));
  verb.add_option(
          "--gain-uncertainty-percent", options->gain_uncertainty_percent,
          "How far each servo gain may be off the machine file; blocks are changed only where the "
          "worst such machine does not get worse")
      ->check(within(0.0, 30.0));
  verb.writes("-o,--output", options->output,
              "The changed program; with --force it may replace the program itself",
              program_content())
      ->required();
  session.on(verb,
             [options](Progress& progress) { return program_predistort::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
