// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace steadyrest::fuzz {

/// What an input of a target has before and behind its NC program.
struct Layout {
  std::size_t head = 1;                      ///< bytes of choices in front of the program
  std::uint8_t dialects = 1;                 ///< the first of them is '0' + one of so many
  const std::uint8_t* dialect_of = nullptr;  ///< by choice: 0 linuxcnc, 1 fanuc, 2 sinumerik
  bool edits = false;                        ///< behind the program: a NUL and groups of four bytes
};

/// Changes an input so that it is likely to stay an accepted program: whole lines are put in (from
/// a list of lines with numbers to fill in), taken out, doubled, exchanged; numbers are changed.
/// Returns the new size; one seed gives one change.
std::size_t mutate_program(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed,
                           const Layout& layout);

}  // namespace steadyrest::fuzz

/// libFuzzer's own change of some bytes.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);
