// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <fmt/core.h>

#include <steadyrest/apps/cli/program/ahead/feeds_ahead.hpp>
#include <steadyrest/apps/cli/program/ahead/predicted_change.hpp>
#include <steadyrest/apps/cli/program/ahead/program_bounds.hpp>
#include <steadyrest/apps/cli/program/verb_program_feeds.hpp>
#include <steadyrest/apps/cli/shared/machine_option.hpp>
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

Json json_of(const FeedReserve& reserve) {
  return {{"margin_mm", reserve.margin_mm},
          {"half_backlash_mm", reserve.backlash_mm},
          {"encoder_mm", reserve.encoder_mm}};
}

std::string text_of(const FeedsAhead& done, const FeedReserve& reserve, double max_error_mm) {
  std::string text = fmt::format(
      "limit {:.2f} µm = {:.2f} µm less {:.2f} µm margin, {:.2f} µm for the backlash and {:.2f} µm "
      "for the encoders\n{}",
      kUm * reserve.limit_mm, kUm * max_error_mm, kUm * reserve.margin_mm,
      kUm * reserve.backlash_mm, kUm * reserve.encoder_mm,
      prediction_table(done, reserve.limit_mm).text());
  text += done.changed.replaced == 0
              ? std::string("the program keeps the limit as it is; nothing is changed\n")
              : fmt::format("{} blocks replaced by {}\n", done.changed.replaced,
                            done.changed.new_lines);
  return text + first_of(done.over.size(), [&](std::size_t i) {
           return fmt::format("line {}: {} remain ({})\n", done.over[i].line,
                              in_um(done.over[i].error_mm), done.over[i].why);
         });
}

Answer answer_of(const FeedsAhead& done, const SourceProgram& program, const FeedReserve& reserve,
                 double max_error_mm) {
  Answer answer;
  put_prediction(answer, done, max_error_mm);
  answer.json["reserved"] = json_of(reserve);
  answer.json["limit_mm"] = reserve.limit_mm;
  put_replaced(answer, done.changed);
  answer.json["remaining"] = Json::array();
  for (const OverLimit& one : done.over) {
    answer.json["remaining"].push_back(
        {{"line", one.line}, {"predicted_error_mm", one.error_mm}, {"reason", one.why}});
  }
  answer.text = text_of(done, reserve, max_error_mm);
  answer.text += put_kept(answer, program.blocks, Rewrites::feeds);
  return answer;
}

Outcome run(const Options& options, Progress& progress) {
  progress.update(0.0, "reading the program");
  auto program = read_source_program(options.program, options.machine);
  if (!program) {
    return std::unexpected(program.error());
  }
  if (const auto fits = within_bounds(*program, options.program.file, kLongestFeeds_s); !fits) {
    return refused(fits.error());
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
  add_changed_program(verb, options->output);
  session.on(verb,
             [options](Progress& progress) { return program_feeds::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
