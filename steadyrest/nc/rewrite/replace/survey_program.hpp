// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <string>
#include <utility>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/read/text/line_source.hpp>
#include <steadyrest/nc/rewrite/walk/kept_moves.hpp>

namespace steadyrest::nc::rewrite {

/// Runs a program once, line after line, past a survey: `Survey(run, kept, dialect)` with
/// `line(text)` and `take()`. Refuses what the interpreter refuses.
template <class Survey>
[[nodiscard]] auto survey_program(const std::string& program, const interpret::Config& config)
    -> kernel::outcome::Result<decltype(std::declval<Survey>().take())> {
  auto source = read::LineSource::open(program);
  if (!source) {
    return std::unexpected(source.error());
  }
  KeptMoves kept;
  auto run = interpret::ProgramRun::make(*source, config, kept);
  if (!run) {
    return std::unexpected(run.error());
  }
  run->note_jumps();
  Survey survey(*run, kept, config.dialect);
  while (run->step()) {
    survey.line(source->line());
  }
  auto found = survey.take();
  if (const auto report = run->take(); !report.refused.empty()) {
    return std::unexpected(interpret::first_refusal(report, program));
  }
  return found;
}

}  // namespace steadyrest::nc::rewrite
