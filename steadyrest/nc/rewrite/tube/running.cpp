// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/nc/rewrite/prove/compare.hpp>
#include <steadyrest/nc/rewrite/tube/running.hpp>
#include <steadyrest/nc/rewrite/tube/same_line.hpp>
#include <steadyrest/nc/rewrite/tube/stretch.hpp>

namespace steadyrest::nc::rewrite {
namespace {

constexpr double kSomewhere_mm = 1e-3;

/// A whole circle, say, ends where it starts.
bool goes_somewhere(const interpret::Move& move) {
  const bool straight =
      move.kind == interpret::MoveKind::rapid || move.kind == interpret::MoveKind::linear;
  return !straight || !std::ranges::equal(move.start, move.end, [](double a, double b) {
    return std::abs(a - b) <= kSomewhere_mm;
  });
}

}  // namespace

kernel::outcome::Result<std::unique_ptr<Running>> Running::open(const std::string& file,
                                                                const interpret::Config& config) {
  auto source = read::LineSource::open(file);
  if (!source) {
    return std::unexpected(source.error());
  }
  auto out = std::make_unique<Running>(std::move(*source), file);
  auto run = interpret::ProgramRun::make(out->source, config, out->kept);
  if (!run) {
    return std::unexpected(run.error());
  }
  run->note_jumps();
  out->run.emplace(std::move(*run));
  return out;
}

void Running::note_position() {
  for (const interpret::Move& move : kept.moves) {
    if (move.kind != interpret::MoveKind::dwell) {
      at_mm = machine_point(move, move.end);
      if (goes_somewhere(move)) {
        behind_rapid = move.kind == interpret::MoveKind::rapid;
      }
      used.add(move, run->line());
    }
  }
}

std::string parted(const Running& original, const Running& changed, double rounding_mm,
                   bool feeds) {
  if (!original.run->doubt().line) {
    return {};
  }
  if (original.run->at_opaque() &&
      (modes_of(original.run->state()) != modes_of(changed.run->state()) ||
       original.source.line() != changed.source.line())) {
    return "is not understood, and has other words or other modes in force than in the original";
  }
  const Running::Standing& a = original.before;
  const Running::Standing& b = changed.before;
  const double within_mm = kSameEnd_mm + rounding_mm;
  const bool place = std::ranges::equal(a.position, b.position, [within_mm](double x, double y) {
    return std::abs(x - y) <= within_mm;
  });
  return place && a.motion == b.motion && (!feeds || a.feed_mm_s == b.feed_mm_s)
             ? std::string{}
             : "depends on what the control decides, and begins at another position or with "
               "another "
               "motion word or feed in force than in the original";
}

}  // namespace steadyrest::nc::rewrite
