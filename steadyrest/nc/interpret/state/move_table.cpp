// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/nc/interpret/state/move_table.hpp>

namespace steadyrest::nc::interpret {
namespace {

constexpr std::size_t kBuffer = std::size_t{1} << 18U;

double norm(const Move& move, std::size_t first) noexcept {
  return std::hypot(move.end[first] - move.start[first],
                    move.end[first + 1] - move.start[first + 1],
                    move.end[first + 2] - move.start[first + 2]);
}

double arc_length(const Move& move) noexcept {
  // Cyclic order keeps first, second, normal right-handed in all three planes.
  const std::size_t normal = move.normal[2] != 0.0 ? 2 : move.normal[1] != 0.0 ? 1 : 0;
  const std::size_t first = (normal + 1) % 3;
  const std::size_t second = (normal + 2) % 3;
  const auto angle = [&](const Axes& point) {
    return std::atan2(point[second] - move.centre_mm[second], point[first] - move.centre_mm[first]);
  };
  using kernel::units::kTurn;
  constexpr double kSame_rad = 1e-12;
  const double sign = move.turns < 0 ? -1.0 : 1.0;
  double sweep = std::fmod(sign * (angle(move.end) - angle(move.start)), kTurn);
  // An end at the start, or before it by a rounding error, is a whole turn, as on the controls.
  if (sweep < kSame_rad) {
    sweep += kTurn;
  }
  sweep += (std::abs(move.turns) - 1) * kTurn;
  // The start radius is used for the whole arc: both ends agree within the arc tolerance.
  const double radius = std::hypot(move.start[first] - move.centre_mm[first],
                                   move.start[second] - move.centre_mm[second]);
  return std::hypot(radius * sweep, move.end[normal] - move.start[normal]);
}

// F/60·60 is not always F again; values within rounding of nine decimals are snapped to them.
double tidy(double value) noexcept {
  const double rounded = std::round(value * 1e9) / 1e9;
  return std::abs(value - rounded) <= 1e-14 * std::abs(value) ? rounded : value;
}

}  // namespace

std::string_view name(MoveKind kind) noexcept {
  constexpr std::array<std::string_view, 7> kNames = {"rapid", "linear", "arc",  "spline",
                                                      "probe", "thread", "dwell"};
  return kNames[static_cast<std::size_t>(kind)];
}

double path_length(const Move& move) noexcept {
  if (move.kind == MoveKind::dwell) {
    return 0.0;
  }
  if (move.kind == MoveKind::arc) {
    return arc_length(move);
  }
  // What the feed refers to, as in LinuxCNC: X Y Z; without them U V W; without them A B C in
  // degrees.
  for (const std::size_t first : {std::size_t{0}, std::size_t{6}, std::size_t{3}}) {
    if (const double length = norm(move, first); length > 0.0) {
      return length;
    }
  }
  return 0.0;
}

// The column is mm/min in any feed mode; G93 is 1/min times the length.
double feed_mm_min(const Move& move) noexcept {
  switch (move.feed_mode) {
    case FeedMode::per_minute:
      return tidy(move.feed_mm_s * 60.0);
    case FeedMode::inverse_time:
      return tidy(move.feed_mm_s * 60.0 * path_length(move));
    case FeedMode::per_revolution:
      return tidy(move.feed_mm_s * std::abs(move.spindle_rev_s) * 60.0);
  }
  return 0.0;
}

MoveTable::MoveTable(kernel::file::OutputFile& out) : out_(out) {
  // One more line fits beyond the threshold at which the buffer is written: no reallocation.
  buffer_.reserve(kBuffer + 4096);
  buffer_ = kHead;
}

// The shortest text that reads back as the same double: no digit added, none lost.
void MoveTable::number(double value) {
  buffer_ += ',';
  std::array<char, 32> text{};
  // value == 0.0 holds for −0 too, which would be printed with its sign.
  const auto [end, error] =
      std::to_chars(text.data(), text.data() + text.size(), value == 0.0 ? 0.0 : value);
  buffer_.append(text.data(), static_cast<std::size_t>(end - text.data()));
}

void MoveTable::on_move(const Move& move) {
  std::array<char, 16> text{};
  const auto line = std::to_chars(text.data(), text.data() + text.size(), move.line);
  buffer_.append(text.data(), static_cast<std::size_t>(line.ptr - text.data()));
  buffer_ += ',';
  buffer_ += name(move.kind);
  for (std::size_t i = 0; i < 6; ++i) {
    number(move.end[i]);
  }
  const double feed = feed_mm_min(move);
  if (feed > 0.0) {
    number(feed);
  } else {
    buffer_ += ',';
  }
  if (move.kind == MoveKind::arc) {
    for (const double centre : move.centre_mm) {
      number(centre);
    }
    number(move.turns);
  } else {
    buffer_ += ",,,,";
  }
  buffer_ += '\n';
  if (buffer_.size() >= kBuffer) {
    finish();
  }
}

void MoveTable::finish() {
  out_.write(buffer_);
  buffer_.clear();
}

}  // namespace steadyrest::nc::interpret
