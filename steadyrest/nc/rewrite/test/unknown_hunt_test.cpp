// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/rewrite/replace/cut_blocks.hpp>
#include <steadyrest/nc/rewrite/test/unknown_program.hpp>
#include <steadyrest/nc/rewrite/tube/test/tube_shop.hpp>

// Random programs whose modes, targets and jumps depend on what the control decides, with blocks
// replaced. Whatever verify_tube() proves is run with other answers of the control: the changed
// program makes the original's moves, within the tube.
namespace steadyrest::nc::rewrite {
namespace {

using interpret::Axes;
using interpret::Move;
using interpret::MoveKind;
using test::TubeShop;
using test::UnknownProgram;

constexpr double kHuntTube_mm = 0.2;

/// What the control may answer.
struct ControlAnswer {
  interpret::Config config;
  bool input = false;
  std::string name;
};

ControlAnswer random_answer(std::mt19937& random, const interpret::Config& assumed) {
  ControlAnswer answer{.config = assumed, .input = random() % 2 == 0, .name = {}};
  interpret::Config& config = answer.config;
  config.on_machine = random() % 2 == 0;
  if (random() % 2 == 0) {
    config.numbers = {{100, 1.0}, {101, 2.0}};
  }
  if (random() % 3 == 0) {
    config.active_offset = 1;
    config.work_offset[1] = {1.0, 2.0, 3.0};
  }
  if (random() % 3 == 0) {
    config.tool_in_spindle = 3;
  }
  if (random() % 3 == 0) {
    config.start = {3.0, 4.0, 5.0};
  }
  config.incremental = random() % 4 == 0;
  config.plane = random() % 6 == 0 ? interpret::Plane::zx : interpret::Plane::xy;
  answer.name = fmt::format("input {} task {} #100 {} offset {} tool {} start {} G91 {} G18 {}",
                            answer.input, config.on_machine, !config.numbers.empty(),
                            config.active_offset, config.tool_in_spindle, config.start[0],
                            config.incremental, config.plane != interpret::Plane::xy);
  return answer;
}

/// The moves of a run by the lines of the original, and how it ended.
struct AskedRun {
  struct OfLine {
    std::uint32_t line = 0;
    bool replaced = false;
    std::vector<Move> moves;
  };
  std::vector<OfLine> lines;
  bool refused = false;
  std::uint32_t refused_line = 0;
};

AskedRun run_of(std::string text, const ControlAnswer& answer,
                const std::vector<std::uint32_t>& origin) {
  constexpr std::string_view kInput = "M66 P0 L0";
  for (std::size_t at = text.find(kInput); answer.input && at != std::string::npos;
       at = text.find(kInput)) {
    text.replace(at, kInput.size(), "#5399=1");
  }
  auto source = read::LineSource::from_text(text);
  KeptMoves kept;
  auto run = interpret::ProgramRun::make(source, answer.config, kept);
  AskedRun out;
  const auto line_of = [&](std::uint32_t line) {
    return origin.empty() ? line : origin[std::min<std::size_t>(line, origin.size() - 1)];
  };
  bool more = true;
  while (more) {
    kept.clear();
    more = run->step();
    const std::uint32_t line = line_of(run->line());
    if (kept.moves.empty() || line == 0) {
      continue;
    }
    const bool again = !out.lines.empty() && out.lines.back().line == line && !origin.empty() &&
                       std::ranges::count(origin, line) > 1;
    if (!again) {
      out.lines.push_back({.line = line, .moves = {}});
    }
    out.lines.back().replaced = !origin.empty() && std::ranges::count(origin, line) > 1;
    for (const Move& move : kept.moves) {
      out.lines.back().moves.push_back(move);
    }
  }
  const auto report = run->take();
  out.refused = !report.refused.empty();
  out.refused_line = out.refused ? line_of(report.refused.front().line) : 0;
  return out;
}

double apart(const Axes& a, const Axes& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    most = std::max(most, std::abs(a[i] - b[i]));
  }
  return most;
}

/// Of a point from the straight line or the circle of a move, in X and Y.
double distance_from(const Move& move, const Axes& point) {
  if (move.kind == MoveKind::arc) {
    const double radius =
        std::hypot(move.start[0] - move.centre_mm[0], move.start[1] - move.centre_mm[1]);
    return std::abs(std::hypot(point[0] - move.centre_mm[0], point[1] - move.centre_mm[1]) -
                    radius);
  }
  const double x = move.end[0] - move.start[0];
  const double y = move.end[1] - move.start[1];
  const double length = std::hypot(x, y);
  const double along =
      length == 0.0 ? 0.0
                    : std::clamp(((point[0] - move.start[0]) * x + (point[1] - move.start[1]) * y) /
                                     (length * length),
                                 0.0, 1.0);
  return std::hypot(move.start[0] + along * x - point[0], move.start[1] + along * y - point[1]);
}

/// What the runs differ in; empty when the changed one keeps to the original.
std::string difference(const AskedRun& a, const AskedRun& b) {
  for (std::size_t i = 0; i < std::max(a.lines.size(), b.lines.size()); ++i) {
    if (i >= a.lines.size() || i >= b.lines.size()) {
      return fmt::format("{} lines move, not {}", b.lines.size(), a.lines.size());
    }
    const auto& x = a.lines[i];
    const auto& y = b.lines[i];
    if (x.line != y.line) {
      return fmt::format("line {} comes where line {} does", y.line, x.line);
    }
    if (!y.replaced && x.moves.size() != y.moves.size()) {
      return fmt::format("line {} makes {} moves", x.line, y.moves.size());
    }
    for (std::size_t j = 0; j < y.moves.size(); ++j) {
      if (!y.replaced && x.moves[j].kind == MoveKind::dwell) {
        continue;  // it may wait anywhere in the tube
      }
      const Move& of = y.replaced ? x.moves.front() : x.moves[j];
      if (!y.replaced && (of.kind != y.moves[j].kind || apart(of.end, y.moves[j].end) > 1e-5 ||
                          of.feed_mm_s != y.moves[j].feed_mm_s)) {
        return fmt::format("line {} ends {} mm away, feed {} not {}", x.line,
                           apart(of.end, y.moves[j].end), y.moves[j].feed_mm_s, of.feed_mm_s);
      }
      if (apart(of.offset, y.moves[j].offset) > 1e-9 ||
          (y.replaced && distance_from(of, y.moves[j].end) > kHuntTube_mm)) {
        return fmt::format("line {} leaves the tube", x.line);
      }
    }
  }
  return a.refused == b.refused && a.refused_line == b.refused_line ? std::string{}
                                                                    : "ends otherwise";
}

/// Each block that may be replaced in two parts, the place between them moved; so is the end, if
/// the next block is replaced too.
NewLines replaced_blocks(std::mt19937& random, const CutBlocks& blocks) {
  NewLines out;
  std::uniform_real_distribution<double> shift(-0.1, 0.1);
  std::array<double, 3> at{};
  std::uint32_t last = 0;
  for (const CutBlock& block : blocks.blocks) {
    // An arc in another plane would need the truth in space.
    const bool flat = block.motion == 10 || block.plane == interpret::Plane::xy;
    if (block.stays != Stays::free || !flat || random() % 4 == 0) {
      continue;
    }
    std::array<double, 3> from = block.line == last + 1 ? at : block.start_mm;
    std::vector<std::string> lines;
    const bool ends_beside = random() % 2 == 0;
    for (const double part : {0.5, 1.0}) {
      std::array<double, 3> to{};
      for (std::size_t i = 0; i < 3; ++i) {
        to[i] = block.start_mm[i] + part * (block.end_mm[i] - block.start_mm[i]);
      }
      if (part < 1.0 || ends_beside) {
        to[0] += shift(random);
        to[1] += shift(random);
      }
      const auto word = [&](std::size_t i) {
        return block.incremental ? to[i] - from[i] : to[i] - block.offset_mm[i];
      };
      lines.push_back(fmt::format("G1 X{:.6f} Y{:.6f}", word(0), word(1)));
      if (std::abs(block.end_mm[2] - block.start_mm[2]) > 0.0) {
        lines.back() += fmt::format(" Z{:.6f}", word(2));
      }
      lines.back() += fmt::format(" F{:.4f}", block.feed);
      from = to;
    }
    at = from;
    last = block.line;
    out[block.line] = std::move(lines);
  }
  return out;
}

TEST(UnknownHunt, NothingProvedMovesOtherwiseForAnotherAnswer) {
  const char* const asked = std::getenv("STEADYREST_UNKNOWN_PROGRAMS");
  const int count = asked != nullptr ? std::atoi(asked) : 400;
  const TubeShop shop("predistort", kHuntTube_mm);
  int proved = 0;
  int differing = 0;
  for (int seed = 1; seed <= count; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    const std::string program = UnknownProgram(random).text();
    test::write_file(shop.original(), program);
    const auto blocks = cut_blocks(shop.original(), shop.config);
    if (!blocks) {
      continue;
    }
    const NewLines lines = replaced_blocks(random, *blocks);
    const auto changed = replace(shop.original(), shop.config.dialect, lines, shop.told);
    ASSERT_TRUE(changed.has_value());
    test::write_file(shop.changed(), changed->text);
    if (lines.empty() || !shop.prove()) {
      continue;
    }
    ++proved;
    if (const char* const folder = std::getenv("STEADYREST_UNKNOWN_FOLDER"); folder != nullptr) {
      test::write_file(fmt::format("{}/{}.ngc", folder, seed), program);
      test::write_file(fmt::format("{}/{}.changed.ngc", folder, seed), changed->text);
    }
    for (int i = 0; i < 4; ++i) {
      const ControlAnswer answer = random_answer(random, shop.config);
      const AskedRun a = run_of(program, answer, {});
      const AskedRun b = run_of(changed->text, answer, changed->origin);
      const AskedRun assumed = run_of(program, {.config = shop.config, .name = {}}, {});
      differing += difference(assumed, a).empty() ? 0 : 1;
      const std::string what = difference(a, b);
      ASSERT_EQ(what, "") << "seed " << seed << ", " << answer.name << "\n"
                          << program << "\nchanged:\n"
                          << changed->text;
    }
  }
  RecordProperty("proved", proved);
  RecordProperty("differing", differing);
  // Most answers matter to some program, and some programs are corrected all the same.
  EXPECT_GT(proved, count / 8);
  EXPECT_GT(differing, count / 8);
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
