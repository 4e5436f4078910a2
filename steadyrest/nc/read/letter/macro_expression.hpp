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
/// 0° … 360°, ATAN[a] −90° … 90°: parameter 6004#0 = 0. BCD writes the decimal digits of a whole
/// number as hexadecimal ones, BIN reads them. POW and ADP are refused.
///
/// A vacant variable is 0 in a calculation; alone it stays vacant (NaN). In a comparison it equals
/// only another vacant one, and is 0 for GT, GE, LT and LE ("Variables", undefined variable). A
/// variable that the program has not set is refused, since the control may have kept a value.
/// Never allocates.
class MacroExpression : public Climber<MacroExpression> {
 public:
  static constexpr int kDeepest = 5;

  /// `increment`: what ROUND rounds to; 1 in a macro statement, 0 where it is not known.
  MacroExpression(std::string_view line, std::size_t at, const Values& values,
                  double increment) noexcept
      : Climber(line, at, values), increment_(increment) {}

  /// One value without operators: what may follow an address.
  bool read(double& out) { return operand(out); }
  /// `[#1 EQ 2]`, `[[#1 GT 0] AND [#1 LT 5]]`: 1 or 0. Numbers that differ by less than 10⁻⁹ of
  /// their size but are not equal are refused: controls round differently.
  bool read_condition(double& out);
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
  bool comparison(double& out);
  bool compare(std::string_view how, double left, double right, double& out);
  bool decimal_digits(bool write, double x, double& out);
  bool bits(Operator op, double& left, double right);
  bool function(double& out);
  bool evaluate(std::string_view name, double x, double& out);
  bool arc_tangent(double y, double& out);
  bool variable(double& out);

  double increment_;
  bool conditional_ = false;  ///< brackets may compare
  bool compared_ = false;
};

/// Why a variable of a macro could not be read or set.
[[nodiscard]] LookupText macro_lookup_text(Lookup lookup) noexcept;

}  // namespace steadyrest::nc::read
