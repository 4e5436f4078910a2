// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/interpret/state/move.hpp>

namespace steadyrest::nc::interpret {

/// Between interpreter and caller: the report counts moves, and the limit on repeated lines needs
/// the count too.
class Counter final : public Sink {
 public:
  Counter(Sink& sink, Report& report) : sink_(sink), report_(report) {}
  void on_move(const Move& move) override {
    ++report_.moves;
    if (opaque_) {
      Move marked = move;
      marked.opaque = true;
      sink_.on_move(marked);
      return;
    }
    sink_.on_move(move);
  }
  void on_event(const Event& event) override { sink_.on_event(event); }
  /// The moves from here on belong to an opaque stretch.
  void set_opaque(bool opaque) noexcept { opaque_ = opaque; }

 private:
  Sink& sink_;
  Report& report_;
  bool opaque_ = false;
};

}  // namespace steadyrest::nc::interpret
