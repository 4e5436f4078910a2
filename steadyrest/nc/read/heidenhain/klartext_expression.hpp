// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include <steadyrest/nc/read/text/climber.hpp>
#include <steadyrest/nc/read/text/values.hpp>

namespace steadyrest::nc::read {

/// A formula of `heidenhain` at a place in a line: numbers, `Q1`, `QL1`, `QR1`, PI, `( )`.
///
/// Law of the manual "Entering formulas directly": functions and signs, then `^`, then `* / %`,
/// then `+ -`, equals from left to right (5 * 3 + 2 * 10 = 35, SQ 10 - 3^3 = 73). Functions take
/// the operand behind them, with brackets or without: SIN COS TAN ASIN ACOS ATAN (degrees), SQ SQRT
/// LN LOG EXP NEG INT ABS FRAC SGN. `a % b` is the remainder with the sign of a. A signed number
/// before
/// `^` without brackets is refused: which of the two acts first is not certain. Nesting is bounded
/// by `kDeepest`. Never allocates. Source: HEIDENHAIN, iTNC 530 and TNC 640 user's manuals,
/// "Programming: Q parameters".
class KlartextExpression : public Climber<KlartextExpression> {
 public:
  static constexpr int kDeepest = 64;

  KlartextExpression(std::string_view line, std::size_t at, const Values& values) noexcept
      : Climber(line, at, values) {}

  /// A whole formula.
  bool read(double& out);
  /// A number or a parameter with its sign, as FN 0 to FN 13 and the words of a block take.
  bool read_operand(double& out);

 private:
  friend class Climber<KlartextExpression>;
  static const std::array<Sign, 6> kSigns;
  static constexpr bool kBlanksWithin = false;
  static constexpr char kClosing = ')';
  bool operand(double& out);
  bool apply(Operator op, double& left, double right);
  bool unsigned_operand(double& out);
  bool function(double& out);
  bool call(std::string_view name, double x, double& out);
};

}  // namespace steadyrest::nc::read
