// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <steadyrest/nc/interpret/decode/dialect_rules.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/interpret/state/refusals.hpp>
#include <steadyrest/nc/interpret/state/state.hpp>

namespace steadyrest::nc::interpret {

/// The state of a control while it executes a program. All stages share it.
struct Control {
  /// `start` is not checked: see Interpreter::make.
  explicit Control(Config start);
  Control(const Control&) = delete;
  Control& operator=(const Control&) = delete;
  ~Control() = default;

  Config config;  ///< G10 changes its tool table
  const DialectRules& rules;
  std::uint32_t axes = 0;      ///< mask of the axis letters that the machine has
  std::uint32_t wrapped = 0;   ///< mask of those that count in turns
  std::uint32_t indexers = 0;  ///< mask of those that move alone, by G0
  std::vector<kernel::machine::RemappedCode> remapped;
  State state;
  Refusals refusals;
};

}  // namespace steadyrest::nc::interpret
