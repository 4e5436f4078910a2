// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/core.h>

#include <steadyrest/math/geometry/vector.hpp>
#include <steadyrest/nc/interpret/state/step.hpp>
#include <steadyrest/nc/rewrite/prove/compare.hpp>
#include <steadyrest/nc/rewrite/tube/same_line.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using interpret::Axes;
using interpret::Event;
using interpret::EventKind;
using interpret::Move;
using interpret::MoveKind;

constexpr double kTurns_ratio = 1e-4;  ///< S is written in whole rpm

/// The largest difference of the linear axes.
double largest_difference(const Axes& a, const Axes& b) noexcept {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    most = std::max(most, std::abs(a[i] - b[i]));
  }
  return most;
}

/// Ends in the work coordinates, which the line's words give.
std::string end_difference(const Move& a, const Move& b, double rounding_mm) {
  for (std::size_t i = 0; i < a.end.size(); ++i) {
    const double end = b.end[i] - a.end[i];
    // An axis that is not named goes on being where it was.
    const bool carried =
        std::abs(end) <= rounding_mm && std::abs(end - (b.start[i] - a.start[i])) <= kSame_mm;
    if (std::abs(end) > kSameEnd_mm && !carried) {
      return fmt::format("ends {:.6f} mm from where the original's ends in {}", std::abs(end),
                         interpret::kAxisLetters[i]);
    }
  }
  return {};
}

std::string start_difference(const Move& a, const Move& b, double rounding_mm, double tube_mm) {
  const double apart = largest_difference(a.start, b.start);
  double most = rounding_mm + kSameEnd_mm;
  switch (a.kind) {
    case MoveKind::rapid:
    case MoveKind::linear:
      most = tube_mm;
      break;
    case MoveKind::arc:
      most = std::max(most, kSameArc_mm);
      break;
    case MoveKind::spline:
    case MoveKind::probe:
    case MoveKind::thread:
    case MoveKind::dwell:
      break;
  }
  return apart <= most ? std::string{}
                       : fmt::format(
                             "starts {:.6f} mm from where the original's starts; {:.6f} mm "
                             "are allowed",
                             apart, most);
}

bool no_length(const Move& move) noexcept {
  return move.kind == MoveKind::linear && largest_difference(move.start, move.end) <= kSame_mm;
}

bool same_control_points(const Move& a, const Move& b, double within_mm) noexcept {
  return std::ranges::equal(a.spline, b.spline, [within_mm](const auto& x, const auto& y) {
    return std::abs(x.x_mm - y.x_mm) <= within_mm && std::abs(x.y_mm - y.y_mm) <= within_mm &&
           std::abs(x.weight - y.weight) <= kSame_mm;
  });
}

std::string move_difference(const Move& a, Move b, const LinePair& pair,
                            const Permitted& permitted) {
  if (auto fault = spindle_fault(permitted, a.spindle_rev_s, b.spindle_rev_s); !fault.empty()) {
    return fault;
  }
  const bool dwell = a.kind == MoveKind::dwell && b.kind == a.kind;
  if (auto fault = dwell ? std::string{}
                         : kept_feed_fault(permitted, a, b, pair.replaceable || no_length(a));
      !fault.empty()) {
    return fault;
  }
  // A dwell of so many turns (sinumerik G4 S) is shorter at a higher speed.
  const double turns = a.dwell_s * a.spindle_rev_s;
  if (permitted.speeds && a.spindle_rev_s != b.spindle_rev_s &&
      std::abs(b.dwell_s * b.spindle_rev_s - turns) <= kTurns_ratio * std::abs(turns)) {
    b.dwell_s = a.dwell_s;
  }
  b.spindle_rev_s = a.spindle_rev_s;
  b.feed_mm_s = a.feed_mm_s;
  if (const auto other = first_difference(a, b); !other.empty()) {
    return fmt::format("differs from the original in its {}", other);
  }
  if (dwell) {
    return {};
  }
  if (largest_difference(a.offset, b.offset) > kSame_mm || a.machine_axes != b.machine_axes) {
    return "differs from the original in its offset";
  }
  if (auto fault = end_difference(a, b, pair.rounding_mm); !fault.empty()) {
    return fault;
  }
  if (!same_control_points(a, b, pair.rounding_mm + kSameEnd_mm)) {
    return "differs from the original in its control points";
  }
  return start_difference(a, b, pair.rounding_mm, permitted.tube_mm);
}

bool is_value(const read::Word& word) noexcept {
  return word.letter == 'S' || word.letter == 'F';
}

/// From `at` on, the first word that is not S or F.
std::size_t next_word(const read::Block& block, std::size_t at) noexcept {
  const auto words = block.words();
  while (at < words.size() && is_value(words[at])) {
    ++at;
  }
  return at;
}

bool has_letter(const read::Block& block, char letter) noexcept {
  return std::ranges::any_of(block.words(),
                             [letter](const read::Word& word) { return word.letter == letter; });
}

}  // namespace

std::string line_difference(const LinePair& pair, const Permitted& permitted) {
  if (pair.original.size() != pair.changed.size()) {
    return "makes more or fewer moves than in the original";
  }
  for (std::size_t i = 0; i < pair.original.size(); ++i) {
    auto fault = move_difference(pair.original[i], pair.changed[i], pair, permitted);
    if (!fault.empty()) {
      return fault;
    }
  }
  return {};
}

std::string event_difference(std::span<const Event> original, std::span<const Event> changed,
                             const Permitted& permitted) {
  if (original.size() != changed.size()) {
    return "does more or less than in the original: spindle, coolant, tool, stop";
  }
  for (std::size_t i = 0; i < original.size(); ++i) {
    const Event& a = original[i];
    const Event& b = changed[i];
    if (a.kind == b.kind && a.kind == EventKind::spindle) {
      if (auto fault = spindle_fault(permitted, a.value, b.value); !fault.empty()) {
        return fault;
      }
    } else if (a.kind != b.kind || a.value != b.value) {
      return "does something else than in the original: spindle, coolant, tool, stop";
    }
  }
  return {};
}

bool is_moved_arc(const Move& original, const Move& changed) {
  return original.kind == MoveKind::arc &&
         (largest_difference(original.start, changed.start) > kSame_mm ||
          math::geometry::distance(original.centre_mm, changed.centre_mm) > kSame_mm);
}

bool differs_in_values_alone(const read::Block& original, const read::Block& changed) {
  std::size_t a = next_word(original, 0);
  std::size_t b = next_word(changed, 0);
  while (a < original.words().size() && b < changed.words().size()) {
    const read::Word& x = original.words()[a];
    const read::Word& y = changed.words()[b];
    if (x.letter != y.letter || x.name != y.name || x.text != y.text) {
      return false;
    }
    a = next_word(original, a + 1);
    b = next_word(changed, b + 1);
  }
  return a == original.words().size() && b == changed.words().size() &&
         original.deleted() == changed.deleted() && original.flow().kind == read::FlowKind::none &&
         changed.flow().kind == read::FlowKind::none &&
         has_letter(original, 'S') == has_letter(changed, 'S');
}

}  // namespace steadyrest::nc::rewrite
