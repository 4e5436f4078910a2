// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/kernel/testing/cases.hpp>
#include <steadyrest/nc/interpret/flow/test/random_flow.hpp>
#include <steadyrest/nc/interpret/test/moves.hpp>

// Random jumps, conditions, loops and repeated sections against an evaluation of its own, and what
// is in doubt against every answer of the control. STEADYREST_FLOW_PROGRAMS runs more of them.
namespace steadyrest::nc::interpret {
namespace {

using read::Dialect;
using test::RandomFlow;

unsigned random_programs() {
  const char* const asked = std::getenv("STEADYREST_FLOW_PROGRAMS");
  return asked != nullptr ? static_cast<unsigned>(std::atoi(asked))
                          : (kernel::testing::kSanitized ? 20U : 150U);
}

Config config_of(Dialect dialect) {
  Config config;
  config.dialect = dialect;
  return config;
}

/// The moves behind the first, which goes to the origin.
std::vector<RandomFlow::Done> done_by(const std::string& text, Dialect dialect) {
  Kept kept;
  const auto report = run_text(text, config_of(dialect), kept);
  EXPECT_TRUE(report && report->refused.empty())
      << (report && !report->refused.empty()
              ? report->refused.front().reason + " " + std::to_string(report->refused.front().line)
              : "")
      << '\n'
      << text;
  std::vector<RandomFlow::Done> done;
  for (std::size_t i = 1; i < kept.moves.size(); ++i) {
    done.push_back({.line = static_cast<int>(kept.moves[i].line), .x = kept.moves[i].end[0]});
  }
  return done;
}

class RandomFlowOf : public testing::TestWithParam<Dialect> {};

TEST_P(RandomFlowOf, ExecutesTheLinesThatItsOwnEvaluationSays) {
  std::size_t moves = 0;
  for (unsigned seed = 1; seed <= random_programs(); ++seed) {
    const RandomFlow program(GetParam(), seed, false);
    std::vector<RandomFlow::Done> expected;
    if (!program.run(0, expected)) {
      continue;
    }
    const auto found = done_by(program.text(), GetParam());
    ASSERT_TRUE(found == expected) << "seed " << seed << '\n' << program.text();
    moves += found.size();
  }
  EXPECT_GT(moves, random_programs() * 5U);
}

/// Where the moves of each line begin.
using Begins = std::map<int, std::vector<double>>;

struct CertainLines {
  std::set<int> doubtful;  ///< lines
  Begins begins;
};

class Unheard final : public Sink {
 public:
  void on_move(const Move& /*move*/) override {}
  void on_event(const Event& /*event*/) override {}
};

CertainLines certain_of(const std::string& text, Dialect dialect) {
  auto source = read::LineSource::from_text(text);
  Unheard unheard;
  auto run = ProgramRun::make(source, config_of(dialect), unheard);
  CertainLines out;
  run->note_jumps();
  double x = 0.0;
  while (run->step()) {
    const auto line = static_cast<int>(run->line());
    const Doubt doubt = run->doubt();
    if (doubt.line || (doubt.axes & 1U) != 0 || !run->at_top()) {
      out.doubtful.insert(line);
    }
    if (run->executed()) {
      out.begins[line].push_back(x);
    }
    x = run->state().position[0];
  }
  EXPECT_TRUE(run->take().refused.empty()) << text;
  return out;
}

// A line of the top level whose moves are certain makes them as often, and from the same places,
// whatever the control answers.
TEST_P(RandomFlowOf, IsCertainOnlyWhereEveryAnswerOfTheControlMeansTheSame) {
  std::size_t compared = 0;
  for (unsigned seed = 1; seed <= random_programs(); ++seed) {
    const RandomFlow program(GetParam(), seed, true);
    std::vector<RandomFlow::Done> assumed;
    if (!program.run(0, assumed)) {
      continue;
    }
    const CertainLines certain = certain_of(program.text(), GetParam());
    for (unsigned answers = 1; answers < 8; ++answers) {
      std::vector<RandomFlow::Done> moves;
      if (!program.run(answers, moves, 20'000)) {
        continue;  // an answer that never ends
      }
      Begins begins;
      double x = 0.0;
      for (const auto& move : moves) {
        begins[move.line].push_back(x);
        x = move.x;
      }
      for (const auto& move : assumed) {
        if (!certain.doubtful.contains(move.line)) {
          ++compared;
          ASSERT_EQ(begins[move.line], certain.begins.at(move.line))
              << "seed " << seed << " answers " << answers << " line " << move.line << '\n'
              << program.text();
        }
      }
    }
  }
  EXPECT_GT(compared, random_programs() * 2U);
}

INSTANTIATE_TEST_SUITE_P(Dialects, RandomFlowOf,
                         testing::Values(Dialect::fanuc, Dialect::sinumerik));

}  // namespace
}  // namespace steadyrest::nc::interpret
