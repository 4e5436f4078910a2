// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <vector>

#include <steadyrest/nc/interpret/state/move.hpp>

namespace steadyrest::nc::rewrite {

/// The moves and events of one line, kept until the next.
class KeptMoves final : public interpret::Sink {
 public:
  void on_move(const interpret::Move& move) override {
    moves.push_back(move);
    if (!move.spline.empty()) {  // the interpreter owns its points
      splines_.emplace_back(move.spline.begin(), move.spline.end());
      moves.back().spline = splines_.back();
    }
  }
  void on_event(const interpret::Event& event) override {
    events.push_back(event);
    events.back().tool_name = {};
  }
  void clear() {
    moves.clear();
    events.clear();
    if (!splines_.empty()) {
      splines_.clear();
    }
  }
  std::vector<interpret::Move> moves;
  std::vector<interpret::Event> events;

 private:
  std::deque<std::vector<interpret::SplinePoint>> splines_;
};

}  // namespace steadyrest::nc::rewrite
