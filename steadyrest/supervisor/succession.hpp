// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// A new machine file under a running layer: what may change, and what goes on as it was.
namespace steadyrest::supervisor {

/// Refused: what cannot change under a running machine. That is the port, the names, kinds and
/// order of the axes, the control's periods, the watchdog's time on the machine, the override
/// tables and the shape of the thermal model.
[[nodiscard]] kernel::outcome::Result<void> fits(const kernel::machine::Machine& running,
                                                 const kernel::machine::Machine& wanted);

/// Rooms with the same settings go on with all that they have learnt; the others start over.
struct Kept {
  bool motion = false;
  bool contour = false;
  bool chatter = false;
  /// The file's own modulation is the same: what was set during the run goes on, though the room
  /// may start over.
  bool modulation = false;
  bool thermal = false;  ///< else the heat is carried over, and the rest starts over
};

[[nodiscard]] Kept kept(const kernel::machine::Machine& running,
                        const kernel::machine::Machine& wanted) noexcept;

}  // namespace steadyrest::supervisor
