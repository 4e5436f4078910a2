// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/path/piece.hpp>
#include <steadyrest/nc/rewrite/replace/block_text.hpp>
#include <steadyrest/nc/rewrite/replace/cut_blocks.hpp>
#include <steadyrest/nc/rewrite/tube/stretch.hpp>
#include <steadyrest/nc/rewrite/tube/test/tube_shop.hpp>

// Random programs, replaced by themselves in parts. Truth: the discrete Fréchet distance of dense
// points along all that both programs do.
namespace steadyrest::nc::rewrite {
namespace {

namespace geometry = math::geometry;
using interpret::Move;
using kernel::signal::PathSegment;
using kernel::signal::Point;
using test::TubeShop;

constexpr double kTube_mm = 0.3;
constexpr double kStep_mm = 0.04;

double random_mm(int low, int high) {
  return 0.001 * *rc::gen::inRange(1000 * low, 1000 * high);
}

/// Lines and arcs in the plane, between a rapid to the start and one away.
std::string random_program(bool arcs) {
  std::string program = "G21 G90 G94 G17\nG0 X0 Y0 Z0\nF600\n";
  double x = 0.0;
  double y = 0.0;
  const int blocks = *rc::gen::inRange(1, 6);
  for (int i = 0; i < blocks; ++i) {
    const double dx = random_mm(-3, 4);
    const double dy = random_mm(-3, 3);
    if (arcs && *rc::gen::inRange(0, 2) == 0 && std::hypot(dx, dy) > 0.1) {
      // A half circle over the chord.
      program += fmt::format("G{} X{:.4f} Y{:.4f} I{:.4f} J{:.4f}\n", *rc::gen::inRange(2, 4),
                             x + dx, y + dy, 0.5 * dx, 0.5 * dy);
    } else {
      program += fmt::format("G1 X{:.4f} Y{:.4f}\n", x + dx, y + dy);
    }
    x += dx;
    y += dy;
  }
  return program + "G0 X0 Y20\nM2\n";
}

PathSegment segment_of(const Move& move) {
  PathSegment segment;
  segment.start_mm = machine_point(move, move.start);
  segment.end_mm = machine_point(move, move.end);
  segment.length_mm = geometry::distance(segment.start_mm, segment.end_mm);
  if (move.kind == interpret::MoveKind::arc) {
    plan::set_arc(segment, move);
  }
  return segment;
}

std::vector<Move> moves_of_file(const TubeShop& shop, const std::string& path) {
  KeptMoves kept;
  const auto report = interpret::run_file(path, shop.config, kept);
  RC_ASSERT(report.has_value() && report->refused.empty());
  return kept.moves;
}

/// Each block that cuts in up to four parts.
NewLines divided(const TubeShop& shop, const std::string& program) {
  test::write_file(shop.original(), program);
  const auto blocks = cut_blocks(shop.original(), shop.config);
  RC_ASSERT(blocks.has_value());
  const BlockText text(read::Dialect::linuxcnc, 5);
  NewLines lines;
  for (const Move& move : moves_of_file(shop, shop.original())) {
    const CutBlock* block = blocks->find(move.line);
    if (block == nullptr || block->stays != Stays::free) {
      continue;
    }
    const PathSegment segment = segment_of(move);
    const int parts = *rc::gen::inRange(1, 5);
    std::vector<NewMove> moves;
    for (int i = 1; i <= parts; ++i) {
      moves.push_back({.geometry = segment.geometry,
                       .end_mm = geometry::point_at(segment, static_cast<double>(i) / parts),
                       .centre_mm = segment.centre_mm,
                       .clockwise = move.turns < 0,
                       .feed_ratio = 1.0});
    }
    Point at = block->start_mm;
    lines[move.line] = text.write(*block, "", moves, at);
    if (auto restore = text.restore(*block, moves); !restore.empty()) {
      lines[move.line].push_back(restore);
    }
  }
  return lines;
}

std::vector<Point> dense_points(const std::vector<Move>& moves) {
  std::vector<Point> out;
  for (const Move& move : moves) {
    const PathSegment segment = segment_of(move);
    const double parts = std::max(1.0, std::ceil(segment.length_mm / kStep_mm));
    // The rapids are straight and far: a tenth of their points is enough.
    const bool rapid = move.kind == interpret::MoveKind::rapid;
    for (double i = 0.0; i <= parts; i += rapid ? parts : 1.0) {
      out.push_back(geometry::point_at(segment, i / parts));
    }
  }
  return out;
}

double frechet_of_points(const std::vector<Point>& a, const std::vector<Point>& b) {
  std::vector<double> row(b.size());
  std::vector<double> next(b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      double best = i == 0 && j == 0 ? 0.0 : 1e300;
      best = i > 0 ? std::min(best, row[j]) : best;
      best = j > 0 ? std::min(best, next[j - 1]) : best;
      best = i > 0 && j > 0 ? std::min(best, row[j - 1]) : best;
      next[j] = std::max(best, geometry::distance(a[i], b[j]));
    }
    std::swap(row, next);
  }
  return row.back();
}

/// One number of an X, Y, I or J word of one new line changed by this much.
std::string one_number_off(std::string text, double by_mm) {
  std::vector<std::pair<std::size_t, std::size_t>> numbers;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = text.find('\n', begin);
    const std::string line = text.substr(begin, end - begin);
    for (std::size_t i = 0; line.ends_with(";STEADYREST new") && line[i] != ';'; ++i) {
      if (std::string_view("XYIJ").find(line[i]) != std::string_view::npos) {
        numbers.emplace_back(begin + i + 1, line.find(' ', i) - i - 1);
      }
    }
    begin = end == std::string::npos ? text.size() : end + 1;
  }
  RC_PRE(!numbers.empty());
  const auto [at, length] = numbers[*rc::gen::inRange<std::size_t>(0, numbers.size())];
  const double value = std::stod(text.substr(at, length)) + by_mm;
  return text.replace(at, length, fmt::format("{:.5f}", value));
}

RC_GTEST_PROP(VerifyTube, ProvesProgramsReplacedByThemselvesInParts, ()) {
  const TubeShop shop("predistort", 0.001);
  const std::string program = random_program(true);
  RC_ASSERT(shop.verdict(program, divided(shop, program)) == "proved");
}

// A line moves by no more than its end.
RC_GTEST_PROP(VerifyTube, ProvesLinesThatMoveByLessThanTheTube, ()) {
  const TubeShop shop("predistort", kTube_mm);
  const std::string program = random_program(false);
  const std::string text = shop.change(program, divided(shop, program));
  const double by = 0.99 * kTube_mm * 0.01 * *rc::gen::inRange(-100, 101);
  test::write_file(shop.changed(), one_number_off(text, by));
  RC_ASSERT(shop.verdict() == "proved");
}

// Programs with arcs may be refused for an arc that does not close, too.
RC_GTEST_PROP(VerifyTube, ProvesWhatIsWithinTheTubeByDensePoints, ()) {
  const TubeShop shop("predistort", kTube_mm);
  const bool arcs = *rc::gen::inRange(0, 3) == 0;
  const std::string program = random_program(arcs);
  const std::string text = shop.change(program, divided(shop, program));
  const double by = 2.0 * kTube_mm * 0.01 * *rc::gen::inRange(-100, 101);
  test::write_file(shop.changed(), one_number_off(text, by));
  const bool proved = shop.prove().has_value();
  RC_CLASSIFY(proved);
  RC_CLASSIFY(!proved && !arcs);
  KeptMoves kept;
  const auto report = interpret::run_file(shop.changed(), shop.config, kept);
  RC_ASSERT(report.has_value() && (arcs || report->refused.empty()));
  if (!report->refused.empty()) {
    RC_ASSERT(!proved);
    return;
  }
  const double truth = frechet_of_points(dense_points(kept.moves),
                                         dense_points(moves_of_file(shop, shop.original())));
  RC_ASSERT(!proved || truth <= kTube_mm + kStep_mm);
  RC_ASSERT(proved || arcs || truth > kTube_mm - kStep_mm);
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
