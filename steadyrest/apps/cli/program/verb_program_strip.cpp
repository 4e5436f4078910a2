// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <fmt/core.h>

#include <steadyrest/apps/cli/program/verb_program_strip.hpp>
#include <steadyrest/nc/rewrite/text/tag.hpp>

namespace steadyrest::apps::cli {
namespace program_strip {
namespace {

struct Options {
  std::string file;
  std::string output;
};

/// strip() knows its own lines by tag and form, so it needs no plan and no machine: a program can
/// be cleaned years later.
Outcome run(const Options& options) {
  const auto removed = nc::rewrite::strip(options.file, options.output);
  if (!removed) {
    return refused(removed.error());
  }
  Answer answer;
  answer.json["removed_lines"] = *removed;
  answer.text = fmt::format("{} {} taken out\n", *removed, *removed == 1 ? "line" : "lines");
  return answer;
}

}  // namespace
}  // namespace program_strip

void add_verb_program_strip(Session& session, Verb& verb) {
  auto options = std::make_shared<program_strip::Options>();
  verb.reads("FILE", options->file, "The changed program")->required();
  verb.writes("-o,--output", options->output,
              "The restored original; with --force it may be FILE itself", program_content())
      ->required();
  session.on(verb, [options](Progress& /*progress*/) { return program_strip::run(*options); });
}

}  // namespace steadyrest::apps::cli
