// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/interpret/state/move.hpp>

namespace steadyrest::nc::plan {

/// Which axes a run moves.
class MovedAxes final : public interpret::Sink {
 public:
  void on_move(const interpret::Move& move) override;
  void on_event(const interpret::Event& /*event*/) override {}
  [[nodiscard]] bool has(std::size_t axis) const noexcept { return moved_[axis]; }

 private:
  std::array<bool, std::tuple_size_v<interpret::Axes>> moved_{};
};

/// The same configuration with another start: the axes that the program moves begin elsewhere, and
/// probing moves touch earlier. The other axes keep their positions.
[[nodiscard]] interpret::Config started_elsewhere(const interpret::Config& config,
                                                  const MovedAxes& moved);

/// The moves of a run, to be told from those of another run.
class MoveMarks final : public interpret::Sink {
 public:
  void on_move(const interpret::Move& move) override { marks_.push_back(mark_of(move)); }
  void on_event(const interpret::Event& /*event*/) override {}

  /// Whether move `i` was the same, by its geometry.
  [[nodiscard]] bool has(std::size_t i, const interpret::Move& move) const {
    return i < marks_.size() && marks_[i] == mark_of(move);
  }

 private:
  [[nodiscard]] static std::uint64_t mark_of(const interpret::Move& move);

  std::vector<std::uint64_t> marks_;
};

/// Passes a run on; a move that the run from elsewhere did not make so is marked
/// (Move::from_start).
class StartMarks final : public interpret::Sink {
 public:
  /// Both outlive it.
  StartMarks(const MoveMarks& elsewhere, interpret::Sink& sink)
      : elsewhere_(elsewhere), sink_(sink) {}

  void on_move(const interpret::Move& move) override;
  void on_event(const interpret::Event& event) override { sink_.on_event(event); }

 private:
  const MoveMarks& elsewhere_;
  interpret::Sink& sink_;
  std::size_t moves_ = 0;
};

}  // namespace steadyrest::nc::plan
