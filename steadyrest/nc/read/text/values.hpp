// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace steadyrest::nc::read {

/// Why a parameter could not be read or written.
enum class Lookup : std::uint8_t {
  found,
  no_such_number,  ///< a number that the control does not have
  no_such_name,    ///< a named parameter that was never set
  read_only,
  assigned_in_block,       ///< set in the block being read
  not_while_compensating,  ///< positions, while cutter radius compensation is on
  not_known_here,          ///< exists on the control, but its value is known only there
  kept_by_control,         ///< may exist there with a value from before the program
  vacant                   ///< fanuc: certainly without a value
};

/// The same in the words of a refusal.
struct LookupText {
  std::string_view reason;
  std::string_view text;
};

/// What expressions read and assignments write.
class Values {
 public:
  Values() = default;
  Values(const Values&) = delete;
  Values& operator=(const Values&) = delete;
  virtual ~Values() = default;

  [[nodiscard]] virtual Lookup number(int index, double& value) const = 0;
  /// `name` in lower case without blanks; a name that begins with `_` is global.
  [[nodiscard]] virtual Lookup name(std::string_view name, double& value) const = 0;
  /// Assignments take effect together, when the whole line has been read: see commit().
  virtual Lookup set_number(int index, double value) = 0;
  virtual Lookup set_name(std::string_view name, double value) = 0;
  virtual void commit() = 0;
  /// The increment to which a calculated value of this letter's word is rounded; 0: not rounded.
  [[nodiscard]] virtual double increment(char /*letter*/) const { return 0.0; }
  virtual void drop() noexcept = 0;  ///< forgets assignments that were not committed
  /// Whether a value read since the last call is one that the control decides: it was assumed.
  [[nodiscard]] virtual bool take_unknown() const noexcept { return false; }
  /// The number of the parameter that is being set is not known: it may be any.
  virtual void sets_any() noexcept {}
};

}  // namespace steadyrest::nc::read
