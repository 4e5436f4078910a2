// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bench/hostile/dice.hpp>

#include <steadyrest/kernel/machine/machine.hpp>

namespace steadyrest::bench::hostile {

/// Another table of the same switch, as machine builders fill them: steps repeated anywhere, one
/// step alone, 256 steps, steps that the control clips; a binary switch with its codes in any
/// order, a Gray switch with those of its positions.
void vary_steps(kernel::machine::OverrideTable& table, Dice& dice);

/// The same values, some of them on several steps.
void repeat_steps(kernel::machine::OverrideTable& table, Dice& dice);

/// Another machine of the same kind: other switches, wires, rights and rates; wishes come without a
/// room.
void vary(kernel::machine::Machine& m, Dice& dice);

/// Other limits of the offsets, as a changed machine file brings them.
void vary_limits(kernel::machine::Machine& m, Dice& dice);

}  // namespace steadyrest::bench::hostile
