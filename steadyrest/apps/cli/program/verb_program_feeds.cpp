// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <fmt/core.h>

#include <steadyrest/apps/cli/program/feeds_ahead.hpp>
#include <steadyrest/apps/cli/program/verb_program_feeds.hpp>
#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/kernel/file/output_file.hpp>

// For a control without a live connection: the servo model knows beforehand where the feed must
// fall, so it can be written into the program.
namespace steadyrest::apps::cli {
namespace program_feeds {
namespace {

struct Options {
  ProgramOptions program;
  std::string machine;
  double max_error_mm = 0.01;
  std::string output;
  const CLI::App* verb = nullptr;
};

constexpr double kUm = 1000.0;
constexpr double kPercent = 100.0;

Json json_of(const FeedReserve& reserve) {
  return {{"margin_mm", reserve.margin_mm},
          {"half_backlash_mm", reserve.backlash_mm},
          {"encoder_mm", reserve.encoder_mm}};
}

std::string text_of(const FeedsAhead& done, const FeedReserve& reserve, double max_error_mm) {
  Table table({"", "before", "after"});
  const auto row = [&](const char* name, const char* unit, double before, double after) {
    table.row(
        {name, fmt::format("{:.2f} {}", before, unit), fmt::format("{:.2f} {}", after, unit)});
  };
  const auto& before = done.before.nominal();
  const auto& after = done.after.nominal();
  row("cycle time", "s", done.seconds_before, done.seconds_after);
  row("contour error, largest", "µm", kUm * before.max_mm, kUm * after.max_mm);
  row("contour error, RMS", "µm", kUm * before.rms_mm(), kUm * after.rms_mm());
  row("of the cut over the limit", "%", kPercent * done.before.share_over(),
      kPercent * done.after.share_over());
  std::string text = fmt::format(
      "limit {:.2f} µm = {:.2f} µm less {:.2f} µm margin, {:.2f} µm for the backlash and {:.2f} µm "
      "for the encoders\n{}",
      kUm * reserve.limit_mm, kUm * max_error_mm, kUm * reserve.margin_mm,
      kUm * reserve.backlash_mm, kUm * reserve.encoder_mm, table.text());
  text += done.changed.replaced == 0
              ? std::string("the program keeps the limit as it is; nothing is changed\n")
              : fmt::format("{} blocks replaced by {}\n", done.changed.replaced,
                            done.changed.new_lines);
  constexpr std::size_t kShown = 10;
  for (std::size_t i = 0; i < std::min(kShown, done.over.size()); ++i) {
    text += fmt::format("line {}: {:.1f} µm remain ({})\n", done.over[i].line,
                        kUm * done.over[i].error_mm, done.over[i].why);
  }
  if (done.over.size() > kShown) {
    text += fmt::format("… {} more (--json has all)\n", done.over.size() - kShown);
  }
  return text;
}

Answer answer_of(const FeedsAhead& done, const SourceProgram& program, const FeedReserve& reserve,
                 double max_error_mm) {
  Answer answer;
  const auto& before = done.before.nominal();
  const auto& after = done.after.nominal();
  answer.json["seconds_before"] = done.seconds_before;
  answer.json["seconds_after"] = done.seconds_after;
  answer.json["predicted_error_max_mm"] = after.max_mm;
  answer.json["predicted_error_rms_mm"] = after.rms_mm();
  answer.json["predicted_error_max_before_mm"] = before.max_mm;
  answer.json["predicted_error_rms_before_mm"] = before.rms_mm();
  answer.json["share_over_limit_before"] = done.before.share_over();
  answer.json["share_over_limit"] = done.after.share_over();
  answer.json["max_error_mm"] = max_error_mm;
  answer.json["reserved"] = json_of(reserve);
  answer.json["limit_mm"] = reserve.limit_mm;
  answer.json["unchanged"] = done.changed.replaced == 0;
  answer.json["replaced_lines"] = done.changed.replaced;
  answer.json["new_lines"] = done.changed.new_lines;
  answer.json["remaining"] = Json::array();
  for (const OverLimit& one : done.over) {
    answer.json["remaining"].push_back(
        {{"line", one.line}, {"predicted_error_mm", one.error_mm}, {"reason", one.why}});
  }
  answer.text = text_of(done, reserve, max_error_mm);
  answer.text += put_kept(answer, program.blocks);
  return answer;
}

Outcome run(const Options& options, Progress& progress) {
  const auto program = read_source_program(options.program, options.machine);
  if (!program) {
    return std::unexpected(program.error());
  }
  const FeedReserve reserve = feed_reserve(program->machine, options.max_error_mm);
  if (!(reserve.limit_mm > 0.0)) {
    return refused(bad_input(
        fmt::format("--max-error-mm {} leaves nothing: {:.4f} mm are kept back for margin_percent, "
                    "{:.4f} mm for half of the backlash and {:.4f} mm for the encoders",
                    options.max_error_mm, reserve.margin_mm, reserve.backlash_mm,
                    reserve.encoder_mm),
        "permit a larger error"));
  }
  auto told = told_of_change("feeds", *options.verb, *program,
                             {{"max-error-mm", fmt::format("{:g}", options.max_error_mm)}});
  if (!told) {
    return std::unexpected(told.error());
  }
  const auto done = feeds_ahead(*program, options.program.file, reserve.limit_mm, *told, progress);
  if (!done) {
    return refused(done.error());
  }
  if (const auto written = kernel::file::write_file(options.output, done->changed.text); !written) {
    return refused(written.error());
  }
  return answer_of(*done, *program, reserve, options.max_error_mm);
}

}  // namespace
}  // namespace program_feeds

void add_verb_program_feeds(Session& session, Verb& verb) {
  auto options = std::make_shared<program_feeds::Options>();
  options->verb = &verb;
  add_machine_program_options(verb, options->program);
  add_machine_option(verb, options->machine);
  verb.add_option("--max-error-mm", options->max_error_mm,
                  "Largest contour error permitted; margin_percent of the machine file and half of "
                  "its largest backlash are kept back from it")
      ->required()
      ->check(within(0.0001, 10.0));
  verb.writes("-o,--output", options->output,
              "The changed program; with --force it may replace the program itself",
              program_content())
      ->required();
  session.on(verb,
             [options](Progress& progress) { return program_feeds::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
