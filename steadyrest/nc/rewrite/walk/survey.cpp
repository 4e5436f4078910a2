// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <steadyrest/nc/interpret/decode/dialect_rules.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/read/text/line_source.hpp>
#include <steadyrest/nc/rewrite/walk/survey.hpp>

namespace steadyrest::nc::rewrite {
namespace {

// Only tool changes matter to the survey.
class Changes final : public interpret::Sink {
 public:
  void on_move(const interpret::Move& /*move*/) override {}
  void on_event(const interpret::Event& event) override {
    changed = changed || event.kind == interpret::EventKind::tool_change;
  }
  bool changed = false;
};

// From G43 (D1) on the tool length is in force.
bool puts_length_on(const read::Block& block, read::Dialect dialect) {
  return std::ranges::any_of(block.words(), [dialect](const read::Word& word) {
    const int code = word.letter == 'G' ? interpret::g::code_of(word.value) : -1;
    const bool g43 = code >= interpret::g::kToolLength && code <= interpret::g::kAddToolLength;
    const bool edge =
        interpret::rules_of(dialect).edge_chooses_length && word.letter == 'D' && word.value > 0.0;
    return g43 || edge;
  });
}

/// The survey with the switch as it is, and whether there are lines that it skips.
kernel::outcome::Result<std::pair<Survey, bool>> survey_once(const std::string& path,
                                                             const interpret::Config& config) {
  auto source = read::LineSource::open(path);
  if (!source) {
    return std::unexpected(source.error());
  }
  Changes changes;
  auto run = interpret::ProgramRun::make(*source, config, changes);
  if (!run) {
    return std::unexpected(run.error());
  }
  run->note_jumps();
  // Runs the whole program: which lines are repeated depends on values in loops and calls.
  Survey found;
  std::vector<bool> seen;
  std::uint64_t steps = 0;
  std::uint64_t changed_at = 0;
  bool deletable = false;
  while (run->step()) {
    ++steps;
    deletable = deletable || run->block().deleted();
    if (run->in_main()) {
      // A line outside of the top level (subprogram, loop, condition) counts as repeated even if it
      // runs once: its times could change with a value.
      found.mark(run->line(), seen, !run->at_top());
    }
    if (!run->executed()) {
      continue;
    }
    // LinuxCNC changes the tool before it applies the length, so G43 in the same block as M6 ends
    // the interval at once.
    if (changes.changed) {
      changed_at = steps;
    }
    if (changed_at != 0 && puts_length_on(run->block(), config.dialect)) {
      found.without_length.emplace_back(changed_at, steps);
      changed_at = 0;
    }
    changes.changed = false;
  }
  found.end_line = run->line();
  interpret::Report report = run->take();
  if (!report.refused.empty()) {
    return std::unexpected(interpret::first_refusal(report, path));
  }
  found.subprogram_files = std::move(report.subprograms);
  return std::pair{std::move(found), deletable};
}

}  // namespace

// One bit a line: 10 million lines are 1.2 MB.
void Survey::mark(std::uint32_t line, std::vector<bool>& seen, bool again) {
  if (line >= seen.size()) {
    seen.resize(line + 1U);
  }
  again = again || seen[line];
  seen[line] = true;
  if (again && line >= repeated.size()) {
    repeated.resize(line + 1U);
  }
  if (again) {
    repeated[line] = true;
  }
}

kernel::outcome::Result<Survey> survey(const std::string& path, const interpret::Config& config) {
  auto found = survey_once(path, config);
  if (!found) {
    return std::unexpected(found.error());
  }
  // `/` lines make it two programs, which are judged separately.
  if (found->second) {
    auto other = survey_once(path, switched(config));
    if (!other) {
      return std::unexpected(of_other_position(other.error(), config));
    }
    found->first.other = std::make_shared<const Survey>(std::move(other->first));
  }
  return std::move(found->first);
}

interpret::Config switched(interpret::Config config) {
  config.block_delete = !config.block_delete;
  return config;
}

kernel::outcome::Refusal of_other_position(kernel::outcome::Refusal refusal,
                                           const interpret::Config& config) {
  refusal.what = std::string{config.block_delete ? "without block delete (lines with / executed): "
                                                 : "with block delete (lines with / skipped): "} +
                 refusal.what;
  return refusal;
}

}  // namespace steadyrest::nc::rewrite
