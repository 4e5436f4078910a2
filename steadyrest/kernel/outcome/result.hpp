// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <expected>
#include <string>

namespace steadyrest::kernel::outcome {

/// Why a request from outside was turned down.
enum class Kind {
  bad_input,    ///< the caller gave something that is not allowed (exit code 2)
  unavailable,  ///< a file, link or device does not answer (exit code 1)
};

/// A refusal: where the fault is, what was seen and what is allowed, what to do.
///
/// No exception crosses a room boundary; a refusal travels as the error of a Result.
struct Refusal {
  Kind kind = Kind::bad_input;
  std::string file;      ///< as the user named it; empty when there is none
  std::size_t line = 0;  ///< 1-based; 0 = the file as a whole
  std::string what;      ///< the value seen and what is allowed
  std::string to_do;     ///< the remedy, in the imperative
};

template <class T>
using Result = std::expected<T, Refusal>;

/// `FILE:LINE: what; to_do`: the one form in which refusals appear.
[[nodiscard]] std::string text(const Refusal& refusal);

}  // namespace steadyrest::kernel::outcome
