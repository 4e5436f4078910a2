// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/apps/cli/program/verb_program_verify.hpp>
#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/apps/cli/shared/rewrite_options.hpp>
#include <steadyrest/apps/cli/shared/value_check.hpp>
#include <steadyrest/kernel/file/memory_file.hpp>
#include <steadyrest/nc/rewrite/prove/verify.hpp>
#include <steadyrest/nc/rewrite/text/mark.hpp>
#include <steadyrest/nc/rewrite/text/put_back.hpp>
#include <steadyrest/nc/rewrite/tube/changed_lines.hpp>
#include <steadyrest/nc/rewrite/tube/verify_tube.hpp>

// The proof of a changed program: it and its original are interpreted and compared move by move.
// Its marks tell what is to be proved: corrections inserted, blocks replaced, or both.
namespace steadyrest::apps::cli {
namespace program_verify {
namespace {

using nc::rewrite::ChangedLines;
using nc::rewrite::Proof;
using nc::rewrite::Told;
using nc::rewrite::TubeProof;

struct Options {
  RewriteOptions rewrite;
  std::string changed;
  std::optional<double> tube_mm;
};

/// What the changed program says of itself.
struct Marks {
  std::vector<Told> inserted;
  std::vector<Told> replaced;
};

/// Nothing had to be changed: the text is the original's.
bool is_original(const Options& options) {
  return ChangedLines::compare(options.rewrite.program.file, options.changed).has_value();
}

std::expected<Marks, Refusals> marks_of(const Options& options) {
  auto inserted = nc::rewrite::read_mark(options.changed);
  auto replaced = nc::rewrite::read_replaced_mark(options.changed);
  if (!inserted || !replaced) {
    return refused(inserted ? replaced.error() : inserted.error());
  }
  const bool planned = !options.rewrite.plan.empty();
  if (!inserted->empty() && !planned) {
    return refused(bad_input(options.changed, "has corrections of a plan inserted",
                             "give the plan with --plan PLAN.json"));
  }
  if (inserted->empty() && replaced->empty() && !planned && !is_original(options)) {
    return refused(
        bad_input(options.changed, "has neither corrections inserted nor blocks replaced",
                  "give the program that compensate, predistort, feeds or speeds has written"));
  }
  return Marks{std::move(*inserted), std::move(*replaced)};
}

/// Where the program runs slower than the original: how much that is, nobody but its user can
/// judge.
std::string slowest(const TubeProof& tube) {
  return tube.slowest_line == 0
             ? std::string{}
             : fmt::format("the lowest feed is {:.3g} of the original's (line {}); ",
                           tube.least_feed_ratio, tube.slowest_line);
}

/// What of the rest is proved.
std::string_view rest_of(const TubeProof& tube) {
  return tube.assumed.empty()
             ? "everything else is the same"
             : "every other line is the original's; what the control decides reaches no replaced "
               "block, and finds both programs at the same place";
}

void put(Answer& answer, const std::optional<Proof>& plan, const std::optional<TubeProof>& tube) {
  const Proof none;
  const Proof& proof = plan ? *plan : none;
  Json& json = answer.json;
  json["proved"] = true;
  json["moves"] = tube ? tube->moves : proof.moves;
  json["corrected_moves"] = proof.corrected;
  json["added_moves"] = proof.added;
  json["inserted_lines"] = proof.inserted_lines;
  json["changes"] = proof.changes;
  json["largest_error_mm"] = proof.largest_error_mm;
  json["seconds"] = plan ? Json(proof.program_s) : Json(nullptr);
  if (plan) {
    answer.text = fmt::format(
        "proved: {} moves compared; {} differ by the planned corrections, none in any other way\n",
        proof.moves, proof.corrected);
  }
  if (tube) {
    json["replaced_lines"] = tube->replaced_lines;
    json["new_lines"] = tube->new_lines;
    json["tube_mm"] = tube->tube_mm;
    json["farthest_mm"] = tube->farthest_mm;
    json["least_feed_ratio"] = tube->least_feed_ratio;
    json["slowest_line"] = tube->slowest_line == 0 ? Json(nullptr) : Json(tube->slowest_line);
    answer.text += fmt::format(
        "proved: {} moves; {} lines replaced by {}, at most {:.4f} mm from the original's path "
        "(tube {:g} mm); {}{}\n",
        tube->moves, tube->replaced_lines, tube->new_lines, tube->farthest_mm, tube->tube_mm,
        slowest(*tube), rest_of(*tube));
    put_unknown(answer, tube->assumed);
  }
}

/// How the programs are read, and the machine where one is given.
struct Reading {
  nc::interpret::Config config;
  std::optional<kernel::machine::Machine> machine;
};

std::expected<Reading, Refusals> read(const Options& options, const std::vector<Told>& mark) {
  // Without a mark the program is unchanged, and the options alone say how it is read.
  const auto told = mark.empty() ? std::expected<RewriteOptions, Refusals>(options.rewrite)
                                 : with_told(options.rewrite, options.changed, mark);
  if (!told) {
    return std::unexpected(told.error());
  }
  Reading out;
  if (!told->machine.empty()) {
    auto machine = read_machine(told->machine);
    if (!machine) {
      return std::unexpected(machine.error());
    }
    out.machine = std::move(*machine);
  }
  auto config =
      out.machine ? program_config(told->program, *out.machine) : program_config(told->program);
  if (!config) {
    return refused(config.error());
  }
  out.config = std::move(*config);
  // The same text is the same program in any unit; a tube is so many mm.
  if (!mark.empty()) {
    if (const auto known = no_assumption(options.rewrite.program.file, out.config); !known) {
      return refused(known.error());
    }
  }
  return out;
}

std::expected<TubeProof, Refusals> prove_tube(const Options& options, const Reading& reading,
                                              const std::string& original,
                                              const std::vector<Told>& mark, Progress& progress) {
  const kernel::outcome::Result<nc::rewrite::Permitted> permitted =
      mark.empty() ? nc::rewrite::Permitted{}
                   : nc::rewrite::permitted_of(options.changed, mark, options.tube_mm,
                                               reading.machine ? &*reading.machine : nullptr);
  if (!permitted) {
    return refused(permitted.error());
  }
  auto proof = nc::rewrite::verify_tube(
      original, options.changed, reading.config, *permitted,
      [&progress](double share, std::string_view what) { progress.update(share, what); });
  if (!proof) {
    return refused(proof.error());
  }
  return *proof;
}

std::expected<RewriteTask, Refusals> plan_task(const Options& options, Progress& progress) {
  return read_rewrite_task(options.rewrite, options.changed, progress);
}

std::expected<Proof, Refusals> prove_plan(const Options& options, const RewriteTask& task,
                                          const std::string& changed) {
  auto proof = nc::rewrite::verify(options.rewrite.program.file, changed, task.plan, task.config,
                                   task.machine, task.settings);
  if (!proof) {
    return refused(proof.error());
  }
  return *proof;
}

/// A refusal about the program between original and changed, which is in no file: the
/// same line of the changed one.
Refusals of_changed(Refusals refusals, const std::string& between, const std::string& changed) {
  const auto lines = ChangedLines::compare(between, changed);
  for (Refusal& refusal : refusals) {
    if (refusal.file == between) {
      refusal.file = changed;
      refusal.line = lines ? lines->place_of(static_cast<std::uint32_t>(refusal.line)) : 0;
    }
  }
  return refusals;
}

/// Corrections in a program whose blocks were replaced: with the blocks put back it must be the
/// original with its corrections, and the replaced blocks are proved against that.
Outcome prove_both(const Options& options, const Marks& marks, Progress& progress) {
  const auto back = nc::rewrite::put_back(options.changed);
  if (!back) {
    return refused(back.error());
  }
  const auto between = kernel::file::MemoryFile::make(back->text);
  if (!between) {
    return refused(between.error());
  }
  const auto task = plan_task(options, progress);
  if (!task) {
    return std::unexpected(task.error());
  }
  const auto plan = prove_plan(options, *task, between->path());
  if (!plan) {
    return std::unexpected(of_changed(plan.error(), between->path(), options.changed));
  }
  const auto tube = prove_tube(options, {.config = task->config, .machine = task->machine},
                               between->path(), marks.replaced, progress);
  if (!tube) {
    return std::unexpected(of_changed(tube.error(), between->path(), options.changed));
  }
  Answer answer;
  put(answer, *plan, *tube);
  return answer;
}

/// A proof either holds or is refused with the line at which it fails; there is no partial answer.
Outcome run(const Options& options, Progress& progress) {
  const auto marks = marks_of(options);
  if (!marks) {
    return std::unexpected(marks.error());
  }
  if (!marks->replaced.empty() && !options.rewrite.plan.empty()) {
    return prove_both(options, *marks, progress);
  }
  Answer answer;
  if (options.rewrite.plan.empty()) {
    const auto reading = read(options, marks->replaced);
    if (!reading) {
      return std::unexpected(reading.error());
    }
    const auto tube =
        prove_tube(options, *reading, options.rewrite.program.file, marks->replaced, progress);
    if (!tube) {
      return std::unexpected(tube.error());
    }
    put(answer, {}, *tube);
    return answer;
  }
  const auto task = plan_task(options, progress);
  if (!task) {
    return std::unexpected(task.error());
  }
  const auto plan = prove_plan(options, *task, options.changed);
  if (!plan) {
    return std::unexpected(plan.error());
  }
  put(answer, *plan, {});
  return answer;
}

}  // namespace
}  // namespace program_verify

void add_verb_program_verify(Session& session, Verb& verb) {
  auto options = std::make_shared<program_verify::Options>();
  add_machine_program_options(verb, options->rewrite.program);
  verb.reads("CHANGED", options->changed, "The changed program")->required();
  add_rewrite_options(verb, options->rewrite);
  verb.get_option("--plan")->required(false)->description(
      "Plan of the corrections (JSON); needed for a program that has corrections inserted");
  verb.add_option("--tube-mm", options->tube_mm,
                  "How far replaced blocks may leave the original's path; default: as the changed "
                  "program says of itself")
      ->check(within(0.0001, 10.0));
  session.on(verb,
             [options](Progress& progress) { return program_verify::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
