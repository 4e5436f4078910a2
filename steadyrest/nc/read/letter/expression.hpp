// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include <steadyrest/nc/read/text/climber.hpp>
#include <steadyrest/nc/read/text/name.hpp>
#include <steadyrest/nc/read/text/values.hpp>

namespace steadyrest::nc::read {

/// Real values of the dialects with `#` and `[ ]` (`linuxcnc`, `fanuc`), at a place in a line:
/// a number, `#5`, `#<name>`, `##5`, `#[…]`, `[…]`, a function `SIN[…]`, `ATAN[y]/[x]`,
/// `EXISTS[#<name>]`, each with signs before it.
///
/// Law of LinuxCNC 2.9's interpreter, found by experiment with rs274: all operators are
/// left-associative; from strong to weak `**`; `* / MOD`; `+ -`; `EQ NE GT GE LT LE`;
/// `AND OR XOR`; a sign binds to its value before all of them. EQ and NE treat numbers as equal
/// when they differ by less than 0.0001. Angles are degrees. MOD is never negative. A result that
/// is not finite is refused. Blanks have no meaning, not even between the digits of a number.
/// Nesting is bounded by `kDeepest`. Never allocates.
class Expression : public Climber<Expression> {
 public:
  static constexpr int kDeepest = 64;

  /// `values` supplies the parameters; both outlive the object.
  Expression(std::string_view line, std::size_t at, const Values& values) noexcept
      : Climber(line, at, values) {}

  /// Reads one real value. False when it is refused: see reason() and text().
  bool read(double& out);
  /// Reads what is between # and = : the number of a parameter, or its name when `<` follows.
  bool parameter_number(int& index);

 private:
  friend class Climber<Expression>;
  static const std::array<Sign, 15> kSigns;
  static constexpr bool kBlanksWithin = true;
  static constexpr char kClosing = ']';
  bool operand(double& out);
  bool bracket(double& out);
  [[nodiscard]] static bool holds(Operator op, double a, double b) noexcept;
  bool apply(Operator op, double& left, double right);
  bool function(double& out);
  bool named_function(std::string_view name, double& out);
  bool arc_tangent(double& out);
  bool exists(double& out);
  bool parameter(double& out);
  bool parameter_name(Name& name);
  bool spaced_number(double& out);
  bool looked_up(Lookup lookup);
};

}  // namespace steadyrest::nc::read
