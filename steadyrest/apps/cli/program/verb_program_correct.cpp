// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <expected>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/apps/cli/program/ahead/changed_program.hpp>
#include <steadyrest/apps/cli/program/ahead/corrected_path.hpp>
#include <steadyrest/apps/cli/program/ahead/inserted.hpp>
#include <steadyrest/apps/cli/program/ahead/predicted_change.hpp>
#include <steadyrest/apps/cli/program/ahead/program_bounds.hpp>
#include <steadyrest/apps/cli/program/ahead/speeds_ahead.hpp>
#include <steadyrest/apps/cli/program/verb_program_correct.hpp>
#include <steadyrest/apps/cli/shared/rewrite_options.hpp>
#include <steadyrest/kernel/file/memory_file.hpp>
#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/nc/rewrite/replace/stages.hpp>
#include <steadyrest/nc/rewrite/tube/prove_made.hpp>

// All that can be known beforehand, in one program. The order is that of cause and effect: a
// spindle speed takes its feeds with it, the path is made for those feeds, and heat shifts the
// whole.
namespace steadyrest::apps::cli {
namespace program_correct {
namespace {

using kernel::file::MemoryFile;
using nc::rewrite::NewLines;
using nc::rewrite::Told;

struct Options {
  RewriteOptions rewrite;  ///< program, machine, plan
  SpeedOptions speeds;
  PathOptions path;
  std::string output;
  const CLI::App* verb = nullptr;

  [[nodiscard]] const std::string& file() const noexcept { return rewrite.program.file; }
  [[nodiscard]] bool asks_speeds() const noexcept { return !speeds.process.empty(); }
  [[nodiscard]] bool asks_path() const { return verb->get_option("--max-error-mm")->count() > 0; }
  [[nodiscard]] bool asks_plan() const noexcept { return !rewrite.plan.empty(); }
};

/// What is asked for, in the order in which it is done.
std::string changes(const Options& options) {
  std::string out = options.asks_speeds() ? "speeds" : "";
  if (options.asks_path()) {
    out += (out.empty() ? "" : ",") + changes_of(options.path);
  }
  return out;
}

/// A refusal about a stage of the program: in the original, the line that it came from.
Refusals of_original(Refusal refusal, const std::string& stage, const nc::rewrite::Stage& lines,
                     const std::string& original) {
  if (refusal.file == stage) {
    refusal.file = original;
    const auto line = static_cast<std::size_t>(refusal.line);
    refusal.line = line < lines.origin.size() ? lines.origin[line] : 0;
  }
  return {std::move(refusal)};
}

/// Refusals about the program with its corrections inserted: they have no line in the original.
Refusals of_original(Refusals refusals, const std::optional<MemoryFile>& between,
                     const std::string& original) {
  for (Refusal& refusal : refusals) {
    if (between && refusal.file == between->path()) {
      refusal.file = original + " with its corrections";
    }
  }
  return refusals;
}

/// New lines for the original: speeds, then the path at the feeds that they leave.
std::expected<NewLines, Refusals> new_lines(const Options& options, const SourceProgram& program,
                                            const std::vector<Told>& told, Answer& answer,
                                            Progress& progress) {
  NewLines lines;
  if (options.asks_speeds()) {
    const auto speeds = speeds_ahead(options.speeds, program, options.file(), progress);
    if (!speeds) {
      return std::unexpected(speeds.error());
    }
    Answer part;
    answer.text += put_speeds(part, *speeds);
    answer.json["speeds"] = std::move(part.json);
    lines = speeds->lines;
  }
  if (!options.asks_path()) {
    return lines;
  }
  const auto stage = nc::rewrite::with_lines(options.file(), lines);
  if (!stage) {
    return refused(stage.error());
  }
  const auto file = MemoryFile::make(stage->text);
  if (!file) {
    return refused(file.error());
  }
  PathOptions how = options.path;
  how.staged = options.asks_speeds();
  const auto path = corrected_path(how, program, file->path(), told, progress);
  if (!path) {
    return std::unexpected(of_original(path.error(), file->path(), *stage, options.file()));
  }
  Answer part;
  answer.text += put_corrected(part, *path, options.path);
  answer.text += put_kept(part, program.blocks, Rewrites::path);
  answer.notes += part.notes;
  answer.json["path"] = std::move(part.json);
  return nc::rewrite::composed(lines, *stage, path->done.lines);
}

/// The text with its blocks replaced, proved against the original.
std::expected<nc::rewrite::Replaced, Refusals> replace(const Options& options,
                                                       const SourceProgram& program,
                                                       const NewLines& lines,
                                                       const std::vector<Told>& told,
                                                       Answer& answer, Progress& progress) {
  auto changed = nc::rewrite::replace(options.file(), program.config.dialect, lines, told);
  if (!changed) {
    return refused(changed.error());
  }
  put_replaced(answer, *changed);
  if (changed->replaced == 0) {
    answer.text += "no block had to be replaced\n";
    return std::move(*changed);
  }
  const auto proof = nc::rewrite::prove_made(options.file(), *changed, program.config,
                                             program.machine, progress.reporter());
  if (!proof) {
    return refused(proof.error());
  }
  answer.json["tube_mm"] = proof->tube_mm;
  answer.json["farthest_mm"] = proof->farthest_mm;
  answer.text += fmt::format(
      "{} lines replaced by {}, proved: at most {:.4f} mm from the original's path (tube {:g} mm); "
      "{}\n",
      proof->replaced_lines, proof->new_lines, proof->farthest_mm, proof->tube_mm,
      proof->assumed.empty() ? "everything else is the same"
                             : "every other line is the original's, and the control's decisions "
                               "reach no replaced block");
  return std::move(*changed);
}

/// The program with the plan's corrections inserted.
std::expected<std::string, Refusals> inserted(const Options& options, Answer& answer,
                                              Progress& progress) {
  const auto task = read_rewrite_task(options.rewrite, progress);
  if (!task) {
    return std::unexpected(task.error());
  }
  std::string text;
  const auto done = nc::rewrite::compensate(options.file(), options.output, task->plan,
                                            task->config, task->machine, task->settings, &text);
  if (!done) {
    return refused(done.error());
  }
  Answer part;
  answer.text += put_insertions(part, *done);
  answer.json["plan"] = std::move(part.json);
  return text;
}

/// Blocks replaced in a program, which may have corrections inserted.
std::expected<nc::rewrite::Replaced, Refusals> changed(Options& options, Answer& answer,
                                                       Progress& progress) {
  progress.update(0.0, "reading the program");
  const auto program = read_source_program(options.rewrite.program, options.rewrite.machine);
  if (!program) {
    return std::unexpected(program.error());
  }
  if (options.asks_path()) {
    if (auto fits = within_bounds(*program, options.rewrite.program.file, kLongestPath_s); !fits) {
      return refused(fits.error());
    }
    if (auto settled = settle_shift(options.path, *program); !settled) {
      return refused(settled.error());
    }
  }
  std::vector<Told> more;
  if (options.asks_speeds()) {
    more.push_back({"depth-mm", fmt::format("{:g}", options.speeds.depth_mm)});
  }
  if (options.asks_path()) {
    std::ranges::move(told_of(options.path), std::back_inserter(more));
  }
  const auto told = told_of_change(changes(options), *options.verb, *program, std::move(more));
  if (!told) {
    return std::unexpected(told.error());
  }
  const auto lines = new_lines(options, *program, *told, answer, progress);
  if (!lines) {
    return std::unexpected(lines.error());
  }
  return replace(options, *program, *lines, *told, answer, progress);
}

/// The corrections first: they are lines of their own, and the path is made for what is cut then.
Outcome run(Options options, Progress& progress) {
  if (!options.asks_speeds() && !options.asks_path() && !options.asks_plan()) {
    return refused(bad_input("nothing is asked for",
                             "give at least one of --max-error-mm, --process, --plan"));
  }
  Answer answer;
  std::string text;
  std::optional<MemoryFile> between;
  if (options.asks_plan()) {
    auto made = inserted(options, answer, progress);
    if (!made) {
      return std::unexpected(made.error());
    }
    text = std::move(*made);
  }
  if (options.asks_speeds() || options.asks_path()) {
    const std::string original = options.file();
    if (!text.empty()) {
      auto file = MemoryFile::make(text);
      if (!file) {
        return refused(file.error());
      }
      between.emplace(std::move(*file));
      ProgramOptions& program = options.rewrite.program;
      if (program.subprograms.empty()) {
        program.subprograms = {std::filesystem::absolute(original).parent_path().string()};
      }
      program.file = between->path();
    }
    auto made = changed(options, answer, progress);
    if (!made) {
      return std::unexpected(of_original(made.error(), between, original));
    }
    text = std::move(made->text);
  }
  if (auto written = kernel::file::write_file(options.output, text); !written) {
    return refused(written.error());
  }
  return answer;
}

}  // namespace
}  // namespace program_correct

void add_verb_program_correct(Session& session, Verb& verb) {
  auto options = std::make_shared<program_correct::Options>();
  options->verb = &verb;
  add_machine_program_options(verb, options->rewrite.program);
  add_rewrite_options(verb, options->rewrite);
  verb.get_option("--plan")->required(false)->description(
      "Insert the corrections of this plan (JSON), too");
  verb.get_option("--machine")
      ->required()
      ->description("Machine file (TOML); its keys are in docs/machine-file.md");
  add_path_options(verb, options->path);
  add_speed_options(verb, options->speeds);
  add_changed_program(verb, options->output);
  session.on(verb,
             [options](Progress& progress) { return program_correct::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
