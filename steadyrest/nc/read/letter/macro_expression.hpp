// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include <steadyrest/nc/read/text/climber.hpp>
#include <steadyrest/nc/read/text/values.hpp>

namespace steadyrest::nc::read {

/// Values of FANUC custom macros at a place in a line: a number, `#5`, `#[…]`, `[…]`, `SIN[…]`,
/// `ATAN[y]/[x]`, each with signs before it.
///
/// Law of the Series 30i manual ("Arithmetic and logic operation"): functions first, then
/// `* / MOD AND`, then `+ - OR XOR`, left to right; brackets nest five deep, those of functions
/// included. A function may be shortened to its first two letters. AND OR XOR work bit by bit on
/// whole numbers; FIX goes towards zero, FUP away from it; ROUND goes to the nearest whole number,
/// or within an address to its least increment. ASIN gives 270° … 90°, ATAN[y]/[x]
/// 0° … 360°, ATAN[a] −90° … 90°: parameter 6004#0 = 0. A vacant variable is refused, because its
/// effect depends on the word; so are BIN, BCD, ADP and POW. Never allocates.
class MacroExpression : public Climber<MacroExpression> {
 public:
  static constexpr int kDeepest = 5;

  /// `increment`: what ROUND rounds to; 1 in a macro statement, 0 where it is not known.
  MacroExpression(std::string_view line, std::size_t at, const Values& values,
                  double increment) noexcept
      : Climber(line, at, values), increment_(increment) {}

  /// One value without operators: what may follow an address.
  bool read(double& out) { return operand(out); }
  /// A whole expression: what may follow `=`.
  bool read_sum(double& out);
  /// What is between # and = : digits or [ ].
  bool variable_number(int& index);

 private:
  friend class Climber<MacroExpression>;
  static const std::array<Sign, 8> kSigns;
  static constexpr bool kBlanksWithin = true;
  static constexpr char kClosing = ']';
  bool operand(double& out);
  bool apply(Operator op, double& left, double right);
  bool bracket(double& out);
  bool bits(Operator op, double& left, double right);
  bool function(double& out);
  bool evaluate(std::string_view name, double x, double& out);
  bool arc_tangent(double y, double& out);
  bool variable(double& out);

  double increment_;
};

/// Why a variable of a macro could not be read or set.
[[nodiscard]] LookupText macro_lookup_text(Lookup lookup) noexcept;

}  // namespace steadyrest::nc::read
