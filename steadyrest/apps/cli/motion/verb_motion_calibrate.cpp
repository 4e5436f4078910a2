// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <memory>
#include <optional>

#include <fmt/core.h>

#include <steadyrest/apps/cli/motion/verb_motion_calibrate.hpp>
#include <steadyrest/apps/cli/shared/log_options.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/motion/offline/log/edge_log.hpp>
#include <steadyrest/motion/offline/log/log_record.hpp>
#include <steadyrest/motion/offline/scene/line_calibration.hpp>
#include <steadyrest/motion/online/line/stored_lines.hpp>
#include <steadyrest/passport/edit/calibration_text.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/passport/text/text_file.hpp>

// Lines of a scale or disc are not where they should be. On smooth motion a line's neighbours tell
// when it should have passed; what repeats at the same line on every pass is its own error.
namespace steadyrest::apps::cli {
namespace motion_calibrate {
namespace {

namespace offline = motion::offline;
using kernel::machine::Encoder;

struct Options {
  std::string log;
  std::string output;
  std::string range;
  std::string machine;
  std::string axis;
  std::optional<double> count_mm;  ///< of a rotary axis in rad
  std::optional<double> count_deg;
  offline::LineCalibrationConfig config{};
  LogOptions format;
};

/// A:B as whole line numbers, both included; they may be negative.
std::optional<offline::LineRange> range_of(const std::string& text) {
  offline::LineRange out;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, out.first);
  if (first.ec != std::errc{} || first.ptr == end || *first.ptr != ':') {
    return std::nullopt;
  }
  const auto last = std::from_chars(first.ptr + 1, end, out.last);
  return last.ec == std::errc{} && last.ptr == end ? std::optional(out) : std::nullopt;
}

/// What is written, and whether its lengths are angles. With a machine file: the whole file with
/// the keys put in; without: the keys alone.
struct Text {
  std::string text;
  bool rotary = false;
};

/// Keys in degrees for an axis counted in degrees, in micrometres otherwise; in a machine file the
/// axis decides.
Result<Text> text_for(const Options& options, const Encoder& encoder) {
  // The unit in which the count was given is the one in which the keys are written.
  const bool in_deg = options.count_deg.has_value();
  if (options.machine.empty()) {
    const std::string count = in_deg ? fmt::format("{:.10g}°", *options.count_deg)
                                     : fmt::format("{:.10g} mm", encoder.count_au);
    return Text{
        fmt::format("# Calibration of an encoder, count {}: keys of [axis.encoder]\n", count) +
            passport::calibration_text(encoder, in_deg),
        in_deg};
  }
  const auto text = passport::read_text(options.machine);
  if (!text) {
    return std::unexpected(text.error());
  }
  const auto machine = passport::parse(*text, options.machine);
  if (!machine) {
    return std::unexpected(machine.error());
  }
  const bool rotary = std::ranges::any_of(
      machine->axes, [&](const auto& axis) { return axis.rotary && axis.name == options.axis; });
  // The count on the command line and the axis of the file must be of one kind.
  if (in_deg && !rotary) {
    return refuse(options.machine, fmt::format("has no rotary axis {}", options.axis),
                  "give --count-mm for a linear axis");
  }
  auto with = passport::with_calibration(*text, options.machine, options.axis, encoder);
  if (!with) {
    return std::unexpected(std::move(with.error()));
  }
  return Text{std::move(*with), rotary};
}

/// The residual is the RMS distance of a line from the cubic through its neighbours. If the table
/// does not shrink it, applying it would only add noise, and `worth_applying` says so. Figures in
/// the unit of the axis; the keys' names carry it.
Answer answer_of(const offline::LineCalibration& calibration, const Encoder& encoder,
                 const offline::EdgeLog& log, bool rotary) {
  const auto shown = [rotary](double error_mm) {
    return rotary ? kernel::units::deg_from_rad(error_mm) : kernel::units::um_from_mm(error_mm);
  };
  const std::string suffix = rotary ? "_deg" : "_um";
  const std::string unit = rotary ? "°" : " µm";
  const double before = shown(calibration.residual_before_mm);
  const double after = shown(calibration.residual_after_mm);
  Json phase = Json::array();
  for (const double error_mm : encoder.phase_error_au) {
    phase.push_back(shown(error_mm));
  }
  Answer answer;
  answer.json = {{"edges", calibration.edges},
                 {"lines_learnt", calibration.lines_learnt},
                 {"residual_before" + suffix, before},
                 {"residual_after" + suffix, after},
                 {"phase_error" + suffix, phase},
                 {"worth_applying", calibration.table.in_use()},
                 {"complete", !log.stopped}};
  Table table;
  table.row({"edges", fmt::format("{}", calibration.edges)})
      .row({"lines learnt", fmt::format("{}", calibration.lines_learnt)})
      .row({"residual before", fmt::format("{:.4g}{}", before, unit)})
      .row({"residual after", fmt::format("{:.4g}{}", after, unit)});
  answer.text = table.text();
  answer.refusals = log.findings;
  // Only part of the log was read. The calibration from that part is written, but the exit code
  // tells.
  if (log.stopped) {
    answer.exit_code = kRefused;
  }
  return answer;
}

/// Options, log, learning, text, file. The log is read edge by edge, so ticks are not needed here.
Outcome run(Options options, Progress& progress) {
  if (!options.count_mm && !options.count_deg) {
    return refused(bad_input("the length of a count is missing",
                             "give --count-mm, or --count-deg for a rotary axis"));
  }
  if (!options.range.empty()) {
    options.config.range = range_of(options.range);
  }
  if (!options.range.empty() && !options.config.range) {
    return refused(bad_input(fmt::format("--range {} is not a pair of line numbers", options.range),
                             "write the first and the last line as A:B"));
  }
  if (options.machine.empty() != options.axis.empty()) {
    return refused(
        bad_input("--machine and --axis go together", "give both, or neither for the keys alone"));
  }
  const auto log =
      offline::read_edge_log(options.log, {.format = format_of(options.format)},
                             [&](double share) { progress.update(share, "reading the log"); });
  if (!log) {
    return refused(log.error());
  }
  offline::LogRecordConfig how;
  // A rotary count is kept in rad, as all inner lengths of rotary axes.
  how.count_mm = options.count_deg ? kernel::units::rad_from_deg(*options.count_deg)
                                   : options.count_mm.value_or(0.0);
  how.cycle_hz = 1.0;  // ticks are not needed
  const auto record = offline::record_of(*log, how);
  if (!record) {
    return refused(record.error());
  }
  const auto calibration = offline::calibrate_lines(*record, options.config);
  if (!calibration) {
    return refused(calibration.error());
  }
  Encoder encoder;
  motion::online::store_lines(calibration->table, encoder);
  // text_for() refuses a count that does not fit the axis, before anything is written.
  const auto text = text_for(options, encoder);
  if (!text) {
    return refused(text.error());
  }
  if (const auto written = kernel::file::write_file(options.output, text->text); !written) {
    return refused(written.error());
  }
  return answer_of(*calibration, encoder, *log, text->rotary);
}

}  // namespace
}  // namespace motion_calibrate

void add_verb_motion_calibrate(Session& session, Verb& verb) {
  auto options = std::make_shared<motion_calibrate::Options>();
  verb.reads("log", options->log, "Log of edges with columns t_s and count; - is stdin")
      ->required();
  auto* const count_mm =
      verb.add_option("--count-mm", options->count_mm,
                      "One count in mm (rad on a rotary axis of the machine file)");
  verb.add_option("--count-deg", options->count_deg, "One count of a rotary axis in degrees")
      ->excludes(count_mm);
  verb.add_option("--counts-per-rev", options->config.counts_per_rev,
                  "Rotary encoder: the table is one revolution and repeats");
  verb.add_option("--range", options->range,
                  "First and last line of the table, A:B; default: all lines in the log");
  add_log_options(verb, options->format, "t_s,count");
  verb.add_option("--passes", options->config.passes, "Number of passes through the log")
      ->capture_default_str();
  verb.reads("--machine", options->machine,
             "Machine file to copy with the calibration of --axis inserted");
  verb.add_option("--axis", options->axis, "Axis of the machine file");
  verb.writes("-o,--output", options->output, "File to write (TOML)",
              either(toml_content("the calibration of an encoder (TOML)",
                                  {"phase_error_um", "phase_error_deg", "line_table_first",
                                   "line_table_periodic", "line_table_um", "line_table_deg"}),
                     machine_content()))
      ->required();
  session.on(verb,
             [options](Progress& progress) { return motion_calibrate::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
