// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include <steadyrest/nc/read/text/climber.hpp>
#include <steadyrest/nc/read/text/name.hpp>
#include <steadyrest/nc/read/text/typed_values.hpp>
#include <steadyrest/nc/read/text/values.hpp>

namespace steadyrest::nc::read {

/// An expression of `sinumerik` at a place in a line: numbers (`1.5`, `1.5EX-3`), `R1`, `R[…]`,
/// variables, elements of arrays `A[R1,2]`, system variables, characters `"A"`, TRUE, FALSE, `( )`,
/// functions; strings where two of them are compared (`NAME=="TOP"`).
///
/// Law of the manual "Job planning", "Priority of the operations", from strong to weak: NOT B_NOT
/// and signs; `* / DIV MOD`; `+ -`; B_AND; B_XOR; B_OR; AND; XOR; OR; `== <> < > <= >=`; equals
/// from left to right. Comparisons treat numbers as equal when they differ by at most 10⁻¹² of
/// their size. Functions: SIN COS TAN ASIN ACOS ATAN2 SQRT ABS POT TRUNC ROUND LN EXP MINVAL MAXVAL
/// BOUND; angles are degrees, ATAN2(y, x) −180° … 180°. DIV and MOD of negative numbers are
/// refused. Nesting is bounded by `kDeepest`. Never allocates.
class SinumerikExpression : public Climber<SinumerikExpression> {
 public:
  static constexpr int kDeepest = 64;

  /// `typed`: null: no system variables and strings.
  SinumerikExpression(std::string_view line, std::size_t at, const Values& values,
                      const TypedValues* typed = nullptr) noexcept
      : Climber(line, at, values), typed_(typed) {}

  bool read(double& out);

 private:
  friend class Climber<SinumerikExpression>;
  static const std::array<Sign, 18> kSigns;
  static constexpr bool kBlanksWithin = false;
  static constexpr char kClosing = ')';
  bool operand(double& out);
  bool apply(Operator op, double& left, double right);
  bool arithmetic(Operator op, double& left, double right);
  bool bits(Operator op, double& left, double right);
  bool number(double& out);
  bool word(double& out);
  bool parameter(double& out, std::string_view name);
  bool element(double& out, Name& name);
  bool system_variable(double& out);
  bool text_comparison(double& out);
  bool function(std::string_view name, double& out);
  bool arguments(std::array<double, 3>& values, std::size_t wanted);
  bool looked_up(Lookup lookup);
  bool closing(char bracket);

  const TypedValues* typed_;
};

/// The name of a variable in lower case; false when it is too long.
bool lower_name(std::string_view written, Name& name) noexcept;

/// Why a parameter or variable could not be read or set.
[[nodiscard]] LookupText sinumerik_lookup_text(Lookup lookup) noexcept;

}  // namespace steadyrest::nc::read
