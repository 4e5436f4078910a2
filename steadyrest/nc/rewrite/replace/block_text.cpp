// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>

#include <fmt/core.h>

#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/math/geometry/vector.hpp>
#include <steadyrest/nc/interpret/state/words.hpp>
#include <steadyrest/nc/rewrite/replace/block_text.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using kernel::signal::Geometry;
using kernel::signal::Point;

constexpr bool is_figure(char c) noexcept {
  return (c >= '0' && c <= '9') || c == '.' || c == '+' || c == '-' || c == ' ' || c == '\t';
}

/// Turned about Z by the angle of the work coordinates, or back.
Point turned(const Point& p, double angle_deg) noexcept {
  if (angle_deg == 0.0) {
    return p;
  }
  const double angle = kernel::units::rad_from_deg(angle_deg);
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]};
}

/// Work coordinates in program units.
Point work_of(const CutBlock& block, const Point& machine_mm) noexcept {
  const Point from = math::geometry::subtract(machine_mm, block.offset_mm);
  return math::geometry::scale(turned(from, -block.rotation_deg), 1.0 / block.unit_mm);
}

Point machine_from(const CutBlock& block, const Point& work) noexcept {
  return math::geometry::add_scaled(block.offset_mm, turned(work, block.rotation_deg),
                                    block.unit_mm);
}

constexpr int kFeedDecimals = 4;
constexpr int kGivenDecimals = 9;  ///< beyond any control's, short of the noise of a double
constexpr double kSamePoint_mm = 1e-9;

/// Rounded to so many decimals, without the noughts behind the last figure but one.
std::string decimal(double value, int decimals) {
  std::array<char, std::numeric_limits<double>::max_exponent10 + 16> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                 std::chars_format::fixed, decimals);
  std::string text(digits.data(), end.ptr);
  while (text.ends_with('0') && !text.ends_with(".0")) {
    text.pop_back();
  }
  return text;
}

double rounded(double value, int decimals) noexcept {
  const double scale = std::pow(10.0, decimals);
  return std::round(value * scale) / scale;
}

int code_of(const NewMove& move) noexcept {
  return move.geometry == Geometry::line ? interpret::g::kLinear
         : move.clockwise                ? interpret::g::kArcClockwise
                                         : interpret::g::kArcCounterClockwise;
}

}  // namespace

int decimals_of(read::Dialect dialect, double unit_mm) noexcept {
  const int inch = unit_mm > 1.0 ? 1 : 0;
  switch (dialect) {
    case read::Dialect::linuxcnc:
    case read::Dialect::grbl:
    case read::Dialect::mach3:
      return 5 + inch;
    case read::Dialect::sinumerik:
      return 4 + inch;
    case read::Dialect::fanuc:
    case read::Dialect::haas:
      return 3 + inch;
  }
  return 3;
}

std::string_view block_number(std::string_view line) noexcept {
  const std::size_t first = line.find_first_not_of(" \t");
  if (first == std::string_view::npos || (line[first] != 'N' && line[first] != 'n')) {
    return {};
  }
  std::size_t end = first + 1;
  while (end < line.size() && line[end] >= '0' && line[end] <= '9') {
    ++end;
  }
  return end == first + 1 ? std::string_view{} : line.substr(first, end - first);
}

std::string BlockText::number(double value, int decimals) {
  std::string text = decimal(value, decimals);
  return text == "-0.0" ? "0.0" : text;
}

std::string BlockText::feed_word(const CutBlock& block, double feed_ratio) {
  return "F" + decimal(block.feed * feed_ratio, kFeedDecimals);
}

std::string BlockText::code(const CutBlock& block, const NewMove& move, Point& at_mm) const {
  constexpr std::string_view kAxes = "XYZ";
  constexpr std::string_view kCentres = "IJK";
  // The block's own end keeps all digits that the program gave it: a full circle that stays behind
  // it is one only while its start is its end.
  const int decimals = math::geometry::distance(move.end_mm, block.end_mm) < kSamePoint_mm
                           ? std::max(decimals_, kGivenDecimals)
                           : decimals_;
  const interpret::PlaneAxes plane = interpret::axes_of(block.plane);
  const bool arc = move.geometry == Geometry::arc;
  const Point from = work_of(block, at_mm);
  const Point to = work_of(block, move.end_mm);
  const Point centre = work_of(block, move.centre_mm);
  Point reached = from;
  std::string text = "G" + std::to_string(code_of(move) / 10);
  for (std::size_t i = 0; i < 3; ++i) {
    const double value = rounded(block.incremental ? to[i] - from[i] : to[i], decimals);
    const double then = block.incremental ? from[i] + value : value;
    const bool in_plane = i == plane.first || i == plane.second;
    // An axis that does not move is left out, unless the arc needs it to be read as one.
    if (std::abs(then - from[i]) > 0.5 * std::pow(10.0, -decimals) || (arc && in_plane)) {
      text.append(1, ' ').append(1, kAxes[i]).append(number(value, decimals));
      reached[i] = then;
    }
  }
  for (const std::size_t i : {plane.first, plane.second}) {
    if (arc) {
      const double value = block.centre_absolute ? centre[i] : centre[i] - from[i];
      text.append(1, ' ').append(1, kCentres[i]).append(number(value, decimals_));
    }
  }
  at_mm = machine_from(block, reached);
  return text;
}

std::vector<std::string> BlockText::write(const CutBlock& block, std::string_view line,
                                          std::span<const NewMove> moves, Point& at_mm) const {
  std::vector<std::string> out;
  std::string number_word(block_number(line));
  for (const NewMove& move : moves) {
    const Point before = at_mm;
    std::string text = code(block, move, at_mm);
    // Too short for the control's resolution: it would be a block without an axis.
    if (at_mm == before) {
      continue;
    }
    text += " " + feed_word(block, move.feed_ratio);
    out.push_back(number_word.empty() ? std::move(text) : number_word + " " + text);
    number_word.clear();
  }
  return out;
}

std::string BlockText::restore(const CutBlock& block, std::span<const NewMove> moves) const {
  if (moves.empty()) {
    return {};
  }
  const NewMove& last = moves.back();
  std::string text;
  if (block.inherited && code_of(last) != block.motion) {
    text = fmt::format("G{}", block.motion / 10);
  }
  const std::string as_it_was = feed_word(block, 1.0);
  if (block.feed_inherited && feed_word(block, last.feed_ratio) != as_it_was) {
    text += (text.empty() ? "" : " ") + as_it_was;
  }
  return text;
}

std::string BlockText::with_feed(const CutBlock& block, std::string_view line,
                                 double feed_ratio) const {
  return with_word(dialect_, line, feed_word(block, feed_ratio));
}

std::string dwell_text(read::Dialect dialect, double seconds) {
  const char letter = dialect == read::Dialect::sinumerik ? 'F'
                      : dialect == read::Dialect::fanuc   ? 'X'
                                                          : 'P';  // haas: seconds with a point
  return fmt::format("G4 {}{:.2f}", letter, seconds);
}

std::string with_word(read::Dialect dialect, std::string_view line, std::string_view word) {
  // In plain words and outside the comments the letter is the word's.
  const char letter = word.front();
  const char small = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  const bool round_comments = dialect != read::Dialect::sinumerik;
  std::size_t at = 0;
  for (; at < line.size() && line[at] != ';'; ++at) {
    if (round_comments && line[at] == '(') {
      at = std::min(line.find(')', at), line.size() - 1);
      continue;
    }
    if (line[at] == letter || line[at] == small) {
      std::size_t end = at + 1;
      end += line.substr(end).starts_with('=') ? 1U : 0U;
      while (end < line.size() && is_figure(line[end])) {
        ++end;
      }
      while (end > at && (line[end - 1] == ' ' || line[end - 1] == '\t')) {
        --end;
      }
      return fmt::format("{}{}{}", line.substr(0, at), word, line.substr(end));
    }
  }
  // None: it goes before the comment that ends the line.
  std::string_view code = line.substr(0, at);
  const std::size_t last = code.find_last_not_of(" \t");
  code = code.substr(0, last == std::string_view::npos ? 0 : last + 1);
  return fmt::format("{} {}{}", code, word, line.substr(code.size()));
}

}  // namespace steadyrest::nc::rewrite
