// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <steadyrest/nc/interpret/decode/dialect_rules.hpp>
#include <steadyrest/nc/interpret/parameters/macro_variables.hpp>
#include <steadyrest/nc/interpret/parameters/parameters.hpp>
#include <steadyrest/nc/interpret/parameters/q_parameters.hpp>
#include <steadyrest/nc/interpret/parameters/sinumerik_variables.hpp>
#include <steadyrest/nc/read/reader.hpp>

namespace steadyrest::nc::interpret {

/// The variables of every kind of dialect; a program uses those of its own.
struct ProgramVariables {
  explicit ProgramVariables(const State& state) : macro(state) {}

  /// Gives the reader those that `kind` says; `parameters` outlives it, as this does.
  void bind(Variables kind, Parameters& parameters, read::Reader& reader);
  /// Those of `kind` that are set, by their names in the program.
  void list(Variables kind, const Parameters& parameters,
            std::vector<std::pair<std::string, double>>& out) const;

  MacroVariables macro;
  SinumerikVariables typed;
  QParameters q;
};

}  // namespace steadyrest::nc::interpret
