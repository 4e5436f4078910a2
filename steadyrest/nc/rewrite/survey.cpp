// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/read/line_source.hpp>
#include <steadyrest/nc/rewrite/survey.hpp>

namespace steadyrest::nc::rewrite {
namespace {

class Changes final : public interpret::Sink {
 public:
  void on_move(const interpret::Move& /*move*/) override {}
  void on_event(const interpret::Event& event) override {
    changed = changed || event.kind == interpret::EventKind::tool_change;
  }
  bool changed = false;
};

bool puts_length_on(const read::Block& block, read::Dialect dialect) {
  return std::ranges::any_of(block.words(), [dialect](const read::Word& word) {
    const bool g43 = word.letter == 'G' && word.value >= 43.0 && word.value < 44.0;
    const bool edge = dialect == read::Dialect::sinumerik && word.letter == 'D' && word.value > 0.0;
    return g43 || edge;
  });
}

}  // namespace

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
  auto source = read::LineSource::open(path);
  if (!source) {
    return std::unexpected(source.error());
  }
  Changes changes;
  auto run = interpret::ProgramRun::make(*source, config, changes);
  if (!run) {
    return std::unexpected(run.error());
  }
  Survey found;
  std::vector<bool> seen;
  std::uint64_t steps = 0;
  std::uint64_t changed_at = 0;
  while (run->step()) {
    ++steps;
    found.leaves_file = found.leaves_file || !run->in_main();
    if (run->in_main()) {
      found.mark(run->line(), seen, !run->at_top());
    }
    if (!run->executed()) {
      continue;
    }
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
  const interpret::Report report = run->take();
  if (!report.refused.empty()) {
    return std::unexpected(interpret::first_refusal(report, path));
  }
  return found;
}

}  // namespace steadyrest::nc::rewrite
