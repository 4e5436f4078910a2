// SPDX-License-Identifier: Apache-2.0
#include <bit>

#include <steadyrest/nc/plan/path/start_marks.hpp>

namespace steadyrest::nc::plan {

using interpret::Move;

namespace {

// FNV-1a over whole words.
constexpr std::uint64_t kBasis = 0xcbf29ce484222325U;
constexpr std::uint64_t kPrime = 0x100000001b3U;

class Hash {
 public:
  void add(double value) noexcept {
    hash_ = (hash_ ^ std::bit_cast<std::uint64_t>(value)) * kPrime;
    hash_ ^= hash_ >> 32U;
  }
  template <class Range>
  void add_all(const Range& values) noexcept {
    for (const double value : values) {
      add(value);
    }
  }
  [[nodiscard]] std::uint64_t value() const noexcept { return hash_; }

 private:
  std::uint64_t hash_ = kBasis;
};

}  // namespace

void MovedAxes::on_move(const Move& move) {
  for (std::size_t i = 0; i < moved_.size(); ++i) {
    moved_[i] = moved_[i] || move.start[i] != move.end[i];
  }
}

interpret::Config started_elsewhere(const interpret::Config& config, const MovedAxes& moved) {
  interpret::Config other = config;
  // No two axes by the same, nor by a length that programs use.
  double shift = 0.61803398875;
  for (std::size_t i = 0; i < other.start.size(); ++i) {
    other.start[i] += moved.has(i) ? shift : 0.0;
    shift *= 1.3247179572;
  }
  other.probe_short_mm += shift;
  return other;
}

std::uint64_t MoveMarks::mark_of(const Move& move) {
  Hash hash;
  hash.add(static_cast<double>(move.kind));
  hash.add(move.line);
  hash.add_all(move.start);
  hash.add_all(move.end);
  hash.add_all(move.offset);
  hash.add(move.rotation_deg);
  if (move.kind == interpret::MoveKind::arc) {
    hash.add_all(move.centre_mm);
    hash.add_all(move.normal);
    hash.add(move.turns);
  }
  for (const interpret::SplinePoint& point : move.spline) {
    hash.add(point.x_mm);
    hash.add(point.y_mm);
  }
  return hash.value();
}

void StartMarks::on_move(const Move& move) {
  const std::size_t i = moves_++;
  if (elsewhere_.has(i, move)) {
    sink_.on_move(move);
    return;
  }
  Move marked = move;
  marked.from_start = true;
  sink_.on_move(marked);
}

}  // namespace steadyrest::nc::plan
