// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// What is allowed in a machine file but will disappoint: the findings of `steadyrest doctor`.
namespace steadyrest::passport {

enum class Severity : std::uint8_t {
  note,     ///< good to know
  warning,  ///< works, but worse than it could
  error     ///< the layer cannot do its work with this
};

struct Finding {
  Severity severity = Severity::note;
  std::string_view check;  ///< stable name of the check, for scripts
  std::string what;
  std::string to_do;
  kernel::outcome::Kind kind = kernel::outcome::Kind::bad_input;  ///< of an error
};

[[nodiscard]] std::vector<Finding> findings(const kernel::machine::Machine& machine);
[[nodiscard]] std::string_view word(Severity severity) noexcept;

}  // namespace steadyrest::passport
