// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <fmt/core.h>

#include <steadyrest/apps/cli/program/verb_program_verify.hpp>
#include <steadyrest/apps/cli/shared/rewrite_options.hpp>
#include <steadyrest/nc/rewrite/prove/verify.hpp>

// The proof that a changed program is the original plus the planned corrections: both are
// interpreted and compared move by move.
namespace steadyrest::apps::cli {
namespace program_verify {
namespace {

struct Options {
  RewriteOptions rewrite;
  std::string changed;
};

/// A proof either holds or is refused with the line at which it fails; there is no partial answer.
Outcome run(const Options& options, Progress& progress) {
  const auto task = read_rewrite_task(options.rewrite, options.changed, progress);
  if (!task) {
    return std::unexpected(task.error());
  }
  const auto proof = nc::rewrite::verify(options.rewrite.program.file, options.changed, task->plan,
                                         task->config, task->machine, task->settings);
  if (!proof) {
    return refused(proof.error());
  }
  Answer answer;
  answer.json["proved"] = true;
  answer.json["moves"] = proof->moves;
  answer.json["corrected_moves"] = proof->corrected;
  answer.json["added_moves"] = proof->added;
  answer.json["inserted_lines"] = proof->inserted_lines;
  answer.json["changes"] = proof->changes;
  answer.json["largest_error_mm"] = proof->largest_error_mm;
  answer.json["seconds"] = proof->program_s;
  answer.text = fmt::format(
      "proved: {} moves compared; {} differ by the planned corrections, none in any other way\n",
      proof->moves, proof->corrected);
  return answer;
}

}  // namespace
}  // namespace program_verify

void add_verb_program_verify(Session& session, Verb& verb) {
  auto options = std::make_shared<program_verify::Options>();
  add_machine_program_options(verb, options->rewrite.program);
  verb.reads("CHANGED", options->changed, "The changed program")->required();
  add_rewrite_options(verb, options->rewrite);
  session.on(verb,
             [options](Progress& progress) { return program_verify::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
