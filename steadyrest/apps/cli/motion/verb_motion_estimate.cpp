// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <steadyrest/apps/cli/motion/verb_motion_estimate.hpp>
#include <steadyrest/apps/cli/shared/log_options.hpp>
#include <steadyrest/apps/cli/shared/report_option.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/apps/page/motion/estimate_page.hpp>
#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/motion/offline/bench/estimator_choice.hpp>
#include <steadyrest/motion/offline/log/edge_log.hpp>
#include <steadyrest/motion/offline/log/estimate_table.hpp>
#include <steadyrest/motion/offline/log/log_doubts.hpp>
#include <steadyrest/motion/offline/log/log_record.hpp>
#include <steadyrest/motion/offline/scene/line_calibration.hpp>
#include <steadyrest/motion/online/edges/cycle_monitor.hpp>
#include <steadyrest/motion/online/line/stored_lines.hpp>
#include <steadyrest/passport/edit/calibration_text.hpp>

// A log of counts in, velocity and acceleration with bounds out, row by row in constant memory.
// With time-stamped edges the accuracy is that of the clock; with ticks alone it is that of a count
// per cycle.
namespace steadyrest::apps::cli {
namespace motion_estimate {
namespace {

namespace offline = motion::offline;
namespace online = motion::online;
using kernel::file::OutputFile;
using CycleReport = online::CycleMonitor::Report;
using offline::EdgeLog;
using offline::LogInput;
using offline::Record;

struct Options {
  std::string log;
  std::string input;
  std::string output;
  std::string estimator{offline::estimator_names().front()};
  offline::EstimatorSetup setup;
  std::optional<double> clock_ns;
  double lag_ms = 0.0;
  std::optional<double> line_error_um;
  std::string calibration;
  std::string axis;
  LogOptions format;
  std::string report;

  [[nodiscard]] bool edges() const { return input == "edges"; }
};

offline::EdgeLogConfig log_config(const Options& options) {
  offline::EdgeLogConfig config;
  // In a log of edges each row is one edge; a larger step means lost edges. Ticks may pass any
  // number of counts, but each must have its own time.
  config.max_step = options.edges() ? 1 : 0;
  config.rising_time = !options.edges();
  config.format = format_of(options.format, options.setup.cycle_hz);
  if (options.setup.count_mm > 0.0) {
    // A count may be anywhere in its cell: 1 % more than the axis can do is not yet a jump.
    config.max_speed_counts_s = 1.01 * options.setup.max_speed_mm_s / options.setup.count_mm;
  }
  return config;
}

offline::LogClaims claims_of(const Options& options) {
  return {options.edges() ? LogInput::edges : LogInput::ticks, options.setup.cycle_hz,
          log_config(options).max_speed_counts_s};
}

/// The log as an estimator takes it: edges with lines and directions, or ticks.
Result<Record> record_of(const Options& options, const EdgeLog& log) {
  offline::LogRecordConfig config;
  config.input = options.edges() ? LogInput::edges : LogInput::ticks;
  config.count_mm = options.setup.count_mm;
  config.cycle_hz = options.setup.cycle_hz;
  if (options.clock_ns) {
    config.clock_s = *options.clock_ns * 1e-9;
  }
  return offline::record_of(log, config);
}

/// Runs the estimator and writes each estimate at once: a log may be longer than memory.
Result<void> write_estimates(const Record& record, online::Estimator& estimator, OutputFile& out,
                             page::EstimateCourse& course, Progress& progress) {
  constexpr std::size_t kBetweenUpdates = 4096;
  offline::EstimateTable table(out);
  auto edge = record.edges.begin();
  for (std::size_t i = 0; i < record.ticks.size(); ++i) {
    // An edge at the very time of a tick comes before it, as log_record.hpp defines the order.
    for (; edge != record.edges.end() && edge->t_s <= record.ticks[i].t_s; ++edge) {
      estimator.edge(*edge);
    }
    const online::Estimate estimate = estimator.tick(record.ticks[i]);
    table.put(estimate);
    course.add(estimate);
    if (i % kBetweenUpdates == 0) {
      progress.update(static_cast<double>(i) / static_cast<double>(record.ticks.size()),
                      "estimating");
    }
  }
  table.finish();
  return out.commit();
}

/// Faults that were reported while the log was read, with their lines.
Json findings_json(const EdgeLog& log) {
  Json out = Json::array();
  for (const Refusal& finding : log.findings) {
    out.push_back({{"line", finding.line}, {"what", finding.what}, {"to_do", finding.to_do}});
  }
  return out;
}

/// How evenly the logged cycles came. Ticks of an edge log are made here, so they say nothing about
/// the control.
std::optional<CycleReport> cycle_of(const Options& options, const Record& record) {
  auto monitor = online::CycleMonitor::make({.nominal_period_s = 1.0 / record.how.cycle_hz});
  if (options.edges() || !monitor) {
    return std::nullopt;
  }
  for (const online::Tick& tick : record.ticks) {
    monitor->update(tick.t_s);
  }
  return monitor->report();
}

/// Mean, jitter and the longest deviation; missed cycles and gaps apart, because a gap of seconds
/// is a recorder that stopped and no jitter.
void put_cycle(const CycleReport& cycle, Answer& answer, Table& table) {
  answer.json["cycle"] = {{"mean_s", cycle.mean_period_s},
                          {"jitter_rms_s", cycle.period_rms_s},
                          {"deviation_p999_s", cycle.deviation_p999_s},
                          {"shortest_s", cycle.shortest_s},
                          {"longest_s", cycle.longest_s},
                          {"missed_cycles", cycle.missed_cycles},
                          {"gaps", cycle.gaps},
                          {"longest_gap_s", cycle.longest_gap_s}};
  table.row({"cycle", fmt::format("{:.6g} ms", cycle.mean_period_s * 1e3)})
      .row({"jitter (RMS)", fmt::format("{:.3g} µs", cycle.period_rms_s * 1e6)})
      .row({"missed cycles", fmt::format("{}", cycle.missed_cycles)})
      .row({"gaps", fmt::format("{}", cycle.gaps)});
}

/// Faults in the log go to stderr. A log that was not read to its end gives exit code 2, though the
/// estimates up to there are written: after a row that must be wrong nobody knows which side of it
/// to believe.
void put_findings(const EdgeLog& log, Answer& answer) {
  answer.refusals = log.findings;
  // The reader keeps the text of the first twenty findings and counts the rest.
  const std::size_t unsaid = log.finding_count - log.findings.size();
  if (unsaid > 0) {
    answer.refusals.push_back(
        bad_input(log.file, fmt::format("{} more of these", unsaid), "fix the recorder first"));
  }
  if (log.stopped) {
    answer.exit_code = kRefused;
    answer.refusals.push_back(
        bad_input(log.file, log.findings.back().line,
                  fmt::format("reading stops at this line; {} rows are kept", log.rows.size()),
                  "the estimates end there"));
  }
}

/// What was read and how; `complete` is false if the log had to be given up.
Answer answer_of(const Options& options, const EdgeLog& log, const Record& record) {
  Answer answer;
  answer.json = {{"estimator", options.estimator},
                 {"ticks", record.ticks.size()},
                 {"edges", record.edges.size()},
                 {"rows", log.rows.size()},
                 {"clock_s", record.how.clock_s},
                 {"lag_s", options.setup.lag_s},
                 {"jumps", log.jumps},
                 {"rollovers", log.rollovers},
                 {"counter_bits", log.rollovers > 0 ? Json(log.counter_bits) : Json(nullptr)},
                 {"reports", log.finding_count},
                 {"complete", !log.stopped},
                 {"findings", findings_json(log)},
                 {"cycle", nullptr}};
  Table table;
  table.row({"estimator", options.estimator})
      .row({"ticks", fmt::format("{}", record.ticks.size())})
      .row({"edges", fmt::format("{}", record.edges.size())})
      .row({"clock",
            record.how.clock_s > 0.0 ? fmt::format("{:g} ns", record.how.clock_s * 1e9) : "exact"})
      .row({"reports", fmt::format("{}", log.finding_count)});
  if (const auto cycle = cycle_of(options, record)) {
    put_cycle(*cycle, answer, table);
  }
  answer.text = table.text();
  put_findings(log, answer);
  answer.json["warnings"] = Json::array();
  for (Refusal& doubt : offline::doubts(log, claims_of(options))) {
    answer.json["warnings"].push_back(fmt::format("{}; {}", doubt.what, doubt.to_do));
    doubt.what = "warning: " + doubt.what;
    answer.refusals.push_back(std::move(doubt));
  }
  return answer;
}

/// The calibration of the encoder's lines, if given. It must be for the same count.
Result<std::optional<online::LineTable>> lines_of(const Options& options) {
  if (options.calibration.empty()) {
    return std::nullopt;
  }
  const auto encoder =
      passport::read_calibration(options.calibration, options.axis, options.setup.count_mm);
  if (!encoder) {
    return std::unexpected(encoder.error());
  }
  auto table = online::stored_lines(*encoder);
  if (!table) {
    return std::unexpected(table.error());
  }
  return std::move(*table);
}

/// Everything after the reading. The estimator is made once more, now that the clock of the time
/// stamps is known.
Outcome estimate(const Options& options, const EdgeLog& log,
                 const std::optional<online::LineTable>& lines, bool json, Progress& progress) {
  auto record = record_of(options, log);
  if (!record) {
    return refused(record.error());
  }
  if (const auto refusal = offline::no_cycles(log, claims_of(options))) {
    return refused(*refusal);
  }
  if (record->ticks.empty() && !log.stopped) {
    return refused(bad_input(log.file,
                             fmt::format("no control cycle of {:.6g} ms lies between its first and "
                                         "its last row: nothing can be estimated",
                                         1e3 / options.setup.cycle_hz),
                             "give a longer log, or check --cycle-hz"));
  }
  // Edges are moved to where the lines really are, before any estimator sees them.
  if (lines) {
    offline::apply_lines(*lines, *record);
  }
  offline::EstimatorSetup setup = options.setup;
  // Found from the log's time stamps unless --clock-ns says otherwise.
  setup.clock_s = record->how.clock_s;
  const auto estimator = offline::make_estimator(options.estimator, setup);
  if (!estimator) {
    return refused(estimator.error());
  }
  auto out = table_output(options.output, json);
  if (!out) {
    return refused(out.error());
  }
  page::EstimateCourse course;
  if (const auto written = write_estimates(*record, **estimator, *out, course, progress);
      !written) {
    return refused(written.error());
  }
  Answer answer = answer_of(options, log, *record);
  if (!options.report.empty()) {
    const std::string name = std::filesystem::path(options.log).filename().string();
    put_report(answer, options.report,
               page::estimate_page(answer.json, {.log = name, .count_mm = options.setup.count_mm},
                                   course));
  }
  if (options.output.empty()) {  // the table has stdout: there is no room for a summary
    answer.text.clear();
  }
  return answer;
}

/// Order: options, calibration, log, estimates. What can be refused cheaply is refused first.
Outcome run(Options options, bool json, Progress& progress) {
  options.setup.has_edges = options.edges();
  options.setup.lag_s = kernel::units::s_from_ms(options.lag_ms);
  if (options.line_error_um) {
    options.setup.line_error_mm = kernel::units::mm_from_um(*options.line_error_um);
  }
  // Bad usage is reported before a long log is read.
  if (const auto probe = offline::make_estimator(options.estimator, options.setup); !probe) {
    return refused(probe.error());
  }
  const auto lines = lines_of(options);
  if (!lines) {
    return refused(lines.error());
  }
  const auto log = offline::read_edge_log(
      options.log, log_config(options),
      [&progress](double share) { progress.update(share, "reading the log"); });
  if (!log) {
    return refused(log.error());
  }
  return estimate(options, *log, *lines, json, progress);
}

/// Limits of the axis are worth giving: they make the estimate finer and are the only source of a
/// guaranteed bound.
void add_axis_options(Verb& verb, Options& options) {
  offline::EstimatorSetup& setup = options.setup;
  verb.add_option("--count-mm", setup.count_mm, "One count in mm")->required();
  verb.add_option("--cycle-hz", setup.cycle_hz,
                  "Control cycles per second; nominal with --input ticks")
      ->required();
  verb.add_option("--max-speed", setup.max_speed_mm_s, "Largest speed of the axis in mm/s");
  verb.add_option("--max-acceleration", setup.max_acceleration_mm_s2,
                  "Largest acceleration of the axis in mm/s²");
  verb.add_option("--max-jerk", setup.max_jerk_mm_s3, "Largest jerk of the axis in mm/s³");
  verb.add_option("--line-error-um", options.line_error_um,
                  "Largest encoder line error in µm, 0 = none; by default the bounds rely on what "
                  "the estimator learns about the lines");
  verb.add_option("--clock-ns", options.clock_ns,
                  "Period of the time stamps in ns, 0 = exact; default: found from the log");
}

}  // namespace
}  // namespace motion_estimate

void add_verb_motion_estimate(Session& session, Verb& verb) {
  auto options = std::make_shared<motion_estimate::Options>();
  verb.reads("log", options->log, "Log with columns t_s and count; - is stdin")->required();
  verb.add_option("--input", options->input,
                  "edges: one row per edge, with the count after it; ticks: one row per cycle")
      ->required()
      ->check(CLI::IsMember({"edges", "ticks"}));
  add_axis_options(verb, *options);
  add_log_options(verb, options->format, "t_s,count");
  CLI::Option* lines =
      verb.reads("--calibration", options->calibration,
                 "Encoder lines as written by `motion calibrate`, or a machine file");
  verb.add_option("--axis", options->axis, "Axis of the machine file the log belongs to")
      ->needs(lines);
  verb.add_option("--estimator", options->estimator,
                  fmt::format("One of {}", fmt::join(motion::offline::estimator_names(), ", ")))
      ->capture_default_str();
  verb.add_option("--lag-ms", options->lag_ms,
                  "Estimate this long after the fact: finer, if the estimator supports it");
  verb.writes("-o,--output", options->output, "Write the estimates to this file instead of stdout",
              csv_content("a table of estimates (CSV)",
                          {"t_s,position_mm,velocity_mm_s,acceleration_mm_s2,"}));
  verb.reports(options->report);
  session.on(verb, [options, &session](Progress& progress) {
    return motion_estimate::run(*options, session.json(), progress);
  });
}

}  // namespace steadyrest::apps::cli
