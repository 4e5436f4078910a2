// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <expected>
#include <string>
#include <utility>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::kernel::outcome {

/// The refusal of something the caller gave: a value; a whole file; a line of a file.
[[nodiscard]] Refusal bad_input(std::string what, std::string to_do);
[[nodiscard]] Refusal bad_input(std::string file, std::string what, std::string to_do);
[[nodiscard]] Refusal bad_input(std::string file, std::size_t line, std::string what,
                                std::string to_do);

/// The same as a Result's error: `return refuse("no speed", "give at least one speed");`.
template <class... Parts>
[[nodiscard]] std::unexpected<Refusal> refuse(Parts&&... parts) {
  return std::unexpected(bad_input(std::forward<Parts>(parts)...));
}

/// A link or device that does not answer: `return unavailable("no sample came", "start it");`.
[[nodiscard]] std::unexpected<Refusal> unavailable(std::string what, std::string to_do);

}  // namespace steadyrest::kernel::outcome
