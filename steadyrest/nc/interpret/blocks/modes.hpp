// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <steadyrest/nc/interpret/control/stage.hpp>

namespace steadyrest::nc::interpret {

/// Modes that stay in force, and M70 to M73, which save and restore them.
class Modes : private Stage {
 public:
  using Stage::Stage;

  void units(const Step& step) noexcept;
  void plane_and_units(const Step& step) noexcept;
  void path(const Step& step) noexcept;
  void distance_and_retract(const Step& step) noexcept;
  bool keep(const Step& step);
  /// A subprogram begins or ends: it has its own saved modes (M70, M73). True where earlier modes
  /// are restored.
  void enter_call();
  bool leave_call();

 private:
  struct Kept {
    std::optional<State> state;
    bool restores_itself = false;  ///< M73
  };
  void restore(const State& kept);
  void smoothing(const Step& step) noexcept;

  std::vector<Kept> kept_{1};
};

}  // namespace steadyrest::nc::interpret
