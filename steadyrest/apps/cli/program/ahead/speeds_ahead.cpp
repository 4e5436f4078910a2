// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/program/ahead/speeds_ahead.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/apps/cli/shared/value_check.hpp>
#include <steadyrest/chatter/offline/process/process_file.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::apps::cli {
namespace {

using kernel::units::rpm_from_rev_s;
using nc::rewrite::SpindleSpan;

Json or_null(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

}  // namespace

void add_speed_options(Verb& verb, SpeedOptions& options) {
  CLI::Option* const process =
      verb.reads("--process", options.process, "Process file (TOML) of the cuts");
  verb.also_reads([&options] {
    return options.process.empty() ? std::vector<std::string>{}
                                   : chatter::offline::response_files(options.process);
  });
  CLI::Option* const depth =
      verb.add_option("--depth-mm", options.depth_mm, "Depth of cut of that process")
          ->check(within(0.0001, 1000.0));
  process->needs(depth);
  depth->needs(process);
  verb.add_option("--tool", options.tool,
                  "Number of the tool that the process is for; cuts of others stay. Default: all")
      ->needs(process);
}

std::expected<SpeedsAhead, Refusals> speeds_ahead(const SpeedOptions& options,
                                                  const SourceProgram& program,
                                                  const std::string& file, Progress& progress) {
  const auto process = chatter::offline::read_process_all_faults(options.process);
  if (!process) {
    return std::unexpected(process.error());
  }
  SpeedsAhead done;
  auto spans = nc::rewrite::spindle_spans(file, program.config);
  if (!spans) {
    return refused(spans.error());
  }
  done.spans = std::move(*spans);
  auto choices = choose_speeds(
      {.process = *process,
       .machine = program.machine,
       .depth_mm = options.depth_mm,
       .tool = options.tool,
       .progress = [&](double share, std::string_view what) { progress.update(share, what); }},
      done.spans);
  if (!choices) {
    return refused(choices.error());
  }
  done.choices = std::move(*choices);
  for (const SpeedChoice& choice : done.choices) {
    done.ratio.push_back(choice.ratio);
  }
  nc::rewrite::keep_carried_feeds(done.spans, done.ratio);
  for (std::size_t i = 0; i < done.ratio.size(); ++i) {
    if (done.ratio[i] != done.choices[i].ratio) {
      done.choices[i].decision = "stays";
      done.choices[i].limit_depth_mm.reset();
    }
  }
  auto lines = nc::rewrite::speed_lines(file, program.config.dialect, done.spans, done.ratio);
  if (!lines) {
    return refused(lines.error());
  }
  done.lines = std::move(*lines);
  return done;
}

std::string put_speeds(Answer& answer, const SpeedsAhead& done) {
  Table table({"line", "tool", "cuts in", "rpm", "new rpm", "decision", "stable to mm"});
  std::string reasons;
  answer.json["cuts"] = Json::array();
  for (std::size_t i = 0; i < done.spans.size(); ++i) {
    const SpindleSpan& span = done.spans[i];
    const SpeedChoice& choice = done.choices[i];
    if (span.first_cut == 0) {
      continue;
    }
    const double rpm = rpm_from_rev_s(choice.speed_rev_s);
    const double ratio = done.ratio[i];
    const std::string& why = span.stays.empty() ? choice.why : span.stays;
    answer.json["cuts"].push_back(
        {{"line", span.speed.line},
         {"tool", span.tool},
         {"first_cut_line", span.first_cut},
         {"last_cut_line", span.last_cut},
         {"speed_rpm_before", span.surface_speed ? Json(nullptr) : Json(rpm)},
         {"speed_rpm_after", span.surface_speed ? Json(nullptr) : Json(rpm * ratio)},
         {"feed_ratio", ratio},
         {"decision", choice.decision},
         {"limit_depth_mm", or_null(choice.limit_depth_mm)},
         {"reason", why}});
    const auto depth = choice.limit_depth_mm;
    table.row({fmt::format("{}", span.speed.line), fmt::format("T{}", span.tool),
               fmt::format("{}–{}", span.first_cut, span.last_cut),
               span.surface_speed ? "G96" : fmt::format("{:.0f}", rpm),
               span.surface_speed ? "G96" : fmt::format("{:.0f}", rpm * ratio), choice.decision,
               !depth                  ? "–"
               : std::isfinite(*depth) ? fmt::format("{:.3f}", *depth)
                                       : "deeper than sought"});
    reasons += why.empty() ? "" : fmt::format("line {}: {}\n", span.speed.line, why);
  }
  return table.text() + reasons;
}

}  // namespace steadyrest::apps::cli
