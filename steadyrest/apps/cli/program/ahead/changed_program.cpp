// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <utility>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <steadyrest/apps/cli/program/ahead/changed_program.hpp>
#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/apps/cli/shared/program_warnings.hpp>
#include <steadyrest/nc/plan/path/plan_program.hpp>

namespace steadyrest::apps::cli {
namespace {

using nc::rewrite::CutBlock;
using nc::rewrite::Stays;
using nc::rewrite::Told;

/// Options that change how a program is read.
constexpr std::array kReadingOptions = {"tools",       "variables",    "data-units",
                                        "subprograms", "block-delete", "least-increment"};

/// Hands on moves with a share of their feed.
class Slower final : public nc::interpret::Sink {
 public:
  Slower(const std::vector<double>& ratio, nc::interpret::Sink& to) : ratio_(ratio), to_(to) {}
  void on_move(const nc::interpret::Move& move) override {
    nc::interpret::Move slower = move;
    slower.feed_mm_s *= move.line < ratio_.size() ? ratio_[move.line] : 1.0;
    to_.on_move(slower);
  }
  void on_event(const nc::interpret::Event& event) override { to_.on_event(event); }

 private:
  const std::vector<double>& ratio_;
  nc::interpret::Sink& to_;
};

/// As in the comments of a program: all lines while they are few.
std::string some_lines(const std::vector<std::uint32_t>& lines) {
  constexpr std::size_t kShown = 8;
  const std::vector<std::uint32_t> shown(
      lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(std::min(kShown, lines.size())));
  return fmt::format("{}{}", fmt::join(shown, ", "), lines.size() > kShown ? ", …" : "");
}

}  // namespace

std::expected<SourceProgram, Refusals> read_source_program(const ProgramOptions& options,
                                                           const std::string& machine) {
  SourceProgram program;
  auto read = read_machine(machine);
  if (!read) {
    return std::unexpected(read.error());
  }
  program.machine = std::move(*read);
  auto config = program_config(options, program.machine);
  if (!config) {
    return refused(config.error());
  }
  program.config = std::move(*config);
  const auto mark = nc::rewrite::read_replaced_mark(options.file);
  if (!mark) {
    return refused(mark.error());
  }
  if (!mark->empty()) {
    return refused(bad_input(options.file, "blocks of this program have been replaced already",
                             "take that out first: steadyrest program strip"));
  }
  nc::plan::MachineCheck check(program.machine, known_of(options));
  Result<void> known;
  auto path = nc::plan::plan_moves(program.machine, options.file, [&](nc::interpret::Sink& sink) {
    nc::plan::Both both(sink, check);
    auto report = nc::interpret::run_file(options.file, program.config, both);
    known = report ? no_assumption(*report, options.file) : known;
    return report;
  });
  if (path && !known) {
    return refused(known.error());
  }
  if (!path) {
    Answer said;
    said.refusals.push_back(path.error());
    say_dialect(said, options, program.machine);
    return std::unexpected(std::move(said.refusals));
  }
  program.path = std::move(*path);
  std::ranges::copy_if(check.warnings(), std::back_inserter(program.past_travel),
                       &nc::plan::Warning::travel);
  const bool cuts = std::ranges::any_of(program.path.segments, [](const auto& segment) {
    return segment.motion == kernel::signal::Motion::feed;
  });
  if (!cuts) {
    return refused(
        bad_input(options.file, "the program has no feed moves", "give a program that cuts"));
  }
  auto blocks = nc::rewrite::cut_blocks(options.file, program.config);
  if (!blocks) {
    return refused(blocks.error());
  }
  program.blocks = std::move(*blocks);
  return program;
}

Result<nc::plan::PlannedPath> plan_at_feeds(const SourceProgram& program, const std::string& file,
                                            const std::vector<double>& ratio) {
  auto path = nc::plan::plan_moves(program.machine, file, [&](nc::interpret::Sink& sink) {
    Slower slower(ratio, sink);
    return nc::interpret::run_file(file, program.config, slower);
  });
  if (!path) {
    return path;
  }
  std::vector<double> feed(ratio.size(), 0.0);  // of the program, by line
  for (std::size_t i = 0; i < program.path.segments.size(); ++i) {
    const std::uint32_t line = program.path.segments[i].line;
    if (line < feed.size()) {
      feed[line] = std::max(feed[line], program.path.plans[i].feed_mm_s);
    }
  }
  for (std::size_t i = 0; i < path->segments.size(); ++i) {
    const std::uint32_t line = path->segments[i].line;
    if (line < feed.size() && ratio[line] != 1.0 && feed[line] > 0.0) {
      path->plans[i].feed_mm_s = feed[line];
    }
  }
  return path;
}

std::expected<std::vector<Told>, Refusals> told_of_change(const std::string& changes,
                                                          const CLI::App& verb,
                                                          const SourceProgram& program,
                                                          std::vector<Told> more) {
  std::vector<Told> told = {{"changes", changes},
                            {"dialect", std::string(nc::read::name(program.config.dialect))}};
  std::ranges::move(more, std::back_inserter(told));
  if (program.config.unit_known) {  // also where it is from the machine file, which may change
    told.push_back({"units", program.config.inch ? "inch" : "mm"});
  }
  for (const std::string name : kReadingOptions) {
    const CLI::Option* option = verb.get_option_no_throw("--" + name);
    if (option == nullptr || option->count() == 0) {
      continue;
    }
    const bool flag = option->get_expected_max() == 0;
    const std::vector<std::string> values = flag ? std::vector<std::string>{""} : option->results();
    for (const std::string& value : values) {
      told.push_back({name, value});
    }
  }
  for (const Told& one : told) {
    if (nc::rewrite::told_as_text(one).size() > nc::rewrite::kLongestTold) {
      return refused(
          bad_input(fmt::format("--{} is too long for a comment in the program", one.name),
                    "give a shorter path"));
    }
  }
  return told;
}

std::string put_kept(Answer& answer, const nc::rewrite::CutBlocks& blocks, Rewrites rewrites) {
  std::map<Stays, std::vector<std::uint32_t>> lines;
  for (const CutBlock& block : blocks.blocks) {
    const bool changes = rewrites == Rewrites::feeds
                             ? nc::rewrite::takes_feed(block.stays)
                             : block.stays == Stays::free || block.stays == Stays::motion_needed;
    // In place of a line may come an arc.
    const bool flat = rewrites == Rewrites::path && !block.plane_known;
    if (!changes || flat) {
      lines[changes ? Stays::by_control : block.stays].push_back(block.line);
    }
  }
  put_unknown(answer, blocks.assumed);
  std::string text;
  answer.json["kept"] = Json::array();
  for (const auto& [stays, of] : lines) {
    answer.json["kept"].push_back({{"reason", nc::rewrite::sentence(stays)}, {"lines", of}});
    text += fmt::format("unchanged, because {}: {} {} ({})\n", nc::rewrite::sentence(stays),
                        of.size(), of.size() == 1 ? "block" : "blocks", some_lines(of));
  }
  return text;
}

}  // namespace steadyrest::apps::cli
