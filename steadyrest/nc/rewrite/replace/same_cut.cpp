// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/math/geometry/vector.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/rewrite/prove/compare.hpp>
#include <steadyrest/nc/rewrite/replace/same_cut.hpp>
#include <steadyrest/nc/rewrite/walk/kept_moves.hpp>

namespace steadyrest::nc::rewrite {
namespace {

namespace geometry = math::geometry;
using interpret::Axes;
using interpret::Move;
using interpret::MoveKind;
using kernel::outcome::Result;
using kernel::signal::Point;

/// Rounding of F and S as they are written.
constexpr double kRounding = 1e-4;

bool is_cut(const Move& move) noexcept {
  return move.kind == MoveKind::linear || move.kind == MoveKind::arc;
}

bool near(const Axes& a, const Axes& b, double tolerance) {
  return std::ranges::equal(
      a, b, [tolerance](double x, double y) { return std::abs(x - y) <= tolerance; });
}

Point point_of(const Axes& axes) noexcept {
  return {axes[0], axes[1], axes[2]};
}

bool same_ratio(double a, double b) noexcept {
  return std::abs(a - b) <= kRounding * std::abs(b);
}

/// A feed that has changed as far as it may.
bool feed_permitted(const Move& a, const Move& b, Changes changes) noexcept {
  if (changes == Changes::feeds) {
    return b.feed_mm_s > 0.0 ? b.feed_mm_s <= a.feed_mm_s * (1.0 + kRounding)
                             : a.feed_mm_s == b.feed_mm_s;
  }
  if (a.feed_mode != interpret::FeedMode::per_minute || a.spindle_rev_s == 0.0) {
    return a.feed_mm_s == b.feed_mm_s;
  }
  return a.feed_mm_s == b.feed_mm_s ||
         same_ratio(b.feed_mm_s * a.spindle_rev_s, a.feed_mm_s * b.spindle_rev_s);
}

/// What differs apart from the path of a cut; empty when nothing does.
std::string_view difference(Move a, const Move& b, Changes changes) {
  if (is_cut(a) && a.kind == b.kind && a.feed_mode == b.feed_mode &&
      feed_permitted(a, b, changes)) {
    a.feed_mm_s = b.feed_mm_s;
  }
  if (changes == Changes::speeds && a.spindle_rev_s * b.spindle_rev_s > 0.0) {
    // A dwell of so many turns (sinumerik G4 S) is shorter at a higher speed.
    if (a.kind == MoveKind::dwell &&
        same_ratio(b.dwell_s * b.spindle_rev_s, a.dwell_s * a.spindle_rev_s)) {
      a.dwell_s = b.dwell_s;
    }
    a.spindle_rev_s = b.spindle_rev_s;
  }
  if (a.kind == MoveKind::arc && b.kind == MoveKind::arc && a.turns * b.turns > 0) {
    a.turns = b.turns;
  }
  return first_difference(a, b);
}

/// The point is on the line or the arc.
bool lies_on(const Move& whole, const Point& point, double tolerance_mm) noexcept {
  const Point start = point_of(whole.start);
  if (whole.kind == MoveKind::arc) {
    const auto radius = [&](const Point& p) {
      const Point from = geometry::subtract(p, whole.centre_mm);
      return geometry::norm(
          geometry::add_scaled(from, whole.normal, -geometry::dot(from, whole.normal)));
    };
    return std::abs(radius(point) - radius(start)) <= tolerance_mm;
  }
  const Point way = geometry::subtract(point_of(whole.end), start);
  const double length = geometry::norm(way);
  const Point to = geometry::subtract(point, start);
  const double along = length > 0.0 ? geometry::dot(to, way) / length : 0.0;
  return along >= -tolerance_mm && along <= length + tolerance_mm &&
         geometry::norm_squared(to) - along * along <= tolerance_mm * tolerance_mm;
}

/// A program that is run line by line.
struct Side {
  static Result<Side> make(read::LineSource source, const interpret::Config& config) {
    Side side{std::make_unique<read::LineSource>(std::move(source)), std::make_unique<KeptMoves>(),
              nullptr};
    auto run = interpret::ProgramRun::make(*side.source, config, *side.kept);
    if (!run) {
      return std::unexpected(run.error());
    }
    side.run = std::make_unique<interpret::ProgramRun>(std::move(*run));
    return side;
  }
  std::unique_ptr<read::LineSource> source;
  std::unique_ptr<KeptMoves> kept;
  std::unique_ptr<interpret::ProgramRun> run;
};

class Comparison {
 public:
  Comparison(Side& original, Side& changed, const Replaced& text, Changes changes,
             double tolerance_mm)
      : original_(original), changed_(changed), changes_(changes), tolerance_mm_(tolerance_mm) {
    for (const std::uint32_t line : text.origin) {
      if (line >= lines_of_.size()) {
        lines_of_.resize(line + std::size_t{1}, 0);
      }
      ++lines_of_[line];
    }
  }

  /// What differs; empty when nothing does.
  std::string run() {
    // The head has no moves; number 0 itself is no line.
    step_changed(lines_of_.empty() ? 0 : lines_of_[0] - 1);
    bool head_known = !changed_.kept->moves.empty() || !changed_.kept->events.empty();
    if (head_known) {
      return "the head moves the machine";
    }
    while (original_.run->step()) {
      const std::uint32_t line = original_.run->line();
      const bool main = original_.run->in_main() && line < lines_of_.size();
      step_changed(main ? lines_of_[line] : 1);
      if (std::string what = compare(); !what.empty()) {
        return fmt::format("line {}: {}", line, what);
      }
      original_.kept->clear();
      changed_.kept->clear();
    }
    step_changed(1);
    if (!changed_.kept->moves.empty()) {
      return "the changed program goes on after the original has ended";
    }
    interpret::State end = changed_.run->state();
    if (changes_ == Changes::speeds ||
        same_ratio(end.feed_mm_s, original_.run->state().feed_mm_s)) {
      end.feed_mm_s = original_.run->state().feed_mm_s;
    }
    if (changes_ == Changes::speeds) {
      end.spindle_speed_rev_s = original_.run->state().spindle_speed_rev_s;
    }
    return std::string(state_difference(original_.run->state(), end));
  }

 private:
  /// A spindle that turns may turn at another speed, the same way.
  [[nodiscard]] bool same_events(const std::vector<interpret::Event>& a,
                                 std::vector<interpret::Event> b) const {
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
      if (changes_ == Changes::speeds && a[i].kind == interpret::EventKind::spindle &&
          b[i].kind == a[i].kind && a[i].value * b[i].value > 0.0) {
        b[i].value = a[i].value;
      }
    }
    return equal_events(a, b);
  }
  void step_changed(std::uint32_t lines) const {
    for (std::uint32_t i = 0; i < lines; ++i) {
      changed_.run->step();
    }
  }
  std::string compare() const {
    const auto& a = original_.kept->moves;
    const auto& b = changed_.kept->moves;
    if (!same_events(original_.kept->events, changed_.kept->events)) {
      return "another event";
    }
    std::size_t at = 0;
    for (const Move& move : a) {
      if (std::string what = compare(move, b, at); !what.empty()) {
        return what;
      }
    }
    return at == b.size() ? "" : "more moves";
  }
  /// The moves from `at` on that replace one of the original.
  std::string compare(const Move& move, const std::vector<Move>& b, std::size_t& at) const {
    for (; at < b.size(); ++at) {
      if (const std::string_view what = difference(move, b[at], changes_); !what.empty()) {
        return fmt::format("another {}", what);
      }
      // A full circle is at its end from the start on.
      const bool last = at + 1 == b.size() || b.size() == original_.kept->moves.size();
      if (last && near(b[at].end, move.end, tolerance_mm_)) {
        ++at;
        return {};
      }
      if (last || !is_cut(move) || !lies_on(move, point_of(b[at].end), tolerance_mm_)) {
        return "another path";
      }
    }
    return "fewer moves";
  }

  Side& original_;
  Side& changed_;
  Changes changes_;
  double tolerance_mm_;
  std::vector<std::uint32_t> lines_of_;  ///< of the changed program, for each of the original
};

}  // namespace

Result<void> prove_same_cut(const std::string& original, const Replaced& changed,
                            const interpret::Config& config, Changes changes, double tolerance_mm) {
  auto source = read::LineSource::open(original);
  if (!source) {
    return std::unexpected(source.error());
  }
  auto a = Side::make(std::move(*source), config);
  auto b = Side::make(read::LineSource::from_text(changed.text), config);
  if (!a || !b) {
    return std::unexpected(!a ? a.error() : b.error());
  }
  const std::string what = Comparison(*a, *b, changed, changes, tolerance_mm).run();
  for (Side* side : {&*a, &*b}) {
    if (const auto report = side->run->take(); !report.refused.empty()) {
      return std::unexpected(interpret::first_refusal(report, original));
    }
  }
  if (!what.empty()) {
    return kernel::outcome::refuse(
        original, "the changed program would not cut the same: " + what,
        "leave the program as it is, and report this fault with the program");
  }
  return {};
}

}  // namespace steadyrest::nc::rewrite
