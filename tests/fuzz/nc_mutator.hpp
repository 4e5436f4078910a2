// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace steadyrest::fuzz {

/// What an input of a target has before and after its NC program.
struct Layout {
  std::size_t head = 1;                      ///< bytes of choices before the program
  std::uint8_t dialects = 1;                 ///< the first of them is '0' + one of this many
  const std::uint8_t* dialect_of = nullptr;  ///< by choice: 0 linuxcnc, 1 fanuc, 2 sinumerik
  bool edits = false;                        ///< after the program: a NUL and groups of four bytes
};

/// Changes an input so that it is likely to remain an accepted program: whole lines are inserted
/// (from a list of lines with numbers to fill in), removed, doubled, exchanged; numbers are
/// changed. Returns the new size; one seed gives one change.
std::size_t mutate_program(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed,
                           const Layout& layout);

}  // namespace steadyrest::fuzz

/// libFuzzer's own change of some bytes.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);
