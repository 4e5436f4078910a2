// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include <steadyrest/nc/interpret/parameters/macro_arguments.hpp>

namespace steadyrest::nc::interpret {
namespace {

using read::Word;

/// Argument specification I, by letter − 'A'; 0: no argument.
constexpr std::array<std::uint8_t, 26> kVariables = {
    1, 2, 3, 7, 8, 9, 0, 11, 4, 5, 6, 0, 13, 0, 0, 0, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26};

/// I, J and K in groups of three from #4 on.
class Groups {
 public:
  /// The variable of the word; 0: not certain, 34 and more: too many.
  std::size_t place(char letter) noexcept {
    const auto in_group = static_cast<std::size_t>(letter - 'I');
    // Groups are counted by their order; where some letters are left out, counting each letter by
    // itself could give another group.
    group_ += begun_ && in_group <= last_ ? 1U : 0U;
    begun_ = true;
    last_ = in_group;
    const std::size_t of_letter = counts_.at(in_group)++;
    constexpr std::size_t kFirst = 4;
    return of_letter == group_ ? kFirst + 3 * group_ + in_group : 0;
  }

 private:
  bool begun_ = false;
  std::size_t last_ = 0;
  std::size_t group_ = 0;
  std::array<std::size_t, 3> counts_{};
};

/// The value of an argument; false where its unit is not certain.
bool value_of(const Word& word, DecimalRule rule, double unit_mm, double& value) noexcept {
  value = word.value;
  if (word.decimal_point || rule == DecimalRule::calculator || value == 0.0) {
    return true;
  }
  constexpr std::string_view kLengths = "XYZUVWIJKQR";
  constexpr std::string_view kAngles = "ABC";
  constexpr double kMetric = 1e-3;
  constexpr double kInch = 1e-4;
  if (kLengths.find(word.letter) != std::string_view::npos) {
    value *= unit_mm == 1.0 ? kMetric : kInch;
  } else if (kAngles.find(word.letter) != std::string_view::npos) {
    value *= kMetric;
  }
  return word.letter != 'E' && word.letter != 'F';
}

}  // namespace

bool macro_arguments(const read::Block& block, DecimalRule rule, double unit_mm, Refusals& refusals,
                     MacroArguments& out) {
  out.given = out.unknown = 0;
  Groups groups;
  for (const Word& word : block.words().subspan(1)) {
    if (word.letter == 'P' || word.letter == 'L') {
      continue;  // the program and its repeats
    }
    const bool letter = word.letter >= 'A' && word.letter <= 'Z';
    std::size_t place = letter ? kVariables.at(static_cast<std::size_t>(word.letter - 'A')) : 0;
    if (place == 0) {
      return refusals.word(block.line(), word, "macro_argument",
                           "an address that is no argument of a macro; G, L, N, O and P are not");
    }
    if (word.letter >= 'I' && word.letter <= 'K') {
      place = groups.place(word.letter);
      if (place == 0 || place >= MacroArguments::kLocals) {
        return refusals.word(block.line(), word, "macro_argument",
                             "I, J and K of a macro call that are more than ten, or of which it is "
                             "not certain which #4 to #33 they are; write each group as I J K");
      }
    }
    double value = 0.0;
    if (!value_of(word, rule, unit_mm, value)) {
      return refusals.word(block.line(), word, "macro_argument",
                           "an argument E or F without a decimal point, whose unit depends on the "
                           "control; write it with a point");
    }
    const std::uint64_t bit = std::uint64_t{1} << place;
    out.value.at(place) = value;
    out.given |= bit;
    out.unknown = word.unknown ? out.unknown | bit : out.unknown & ~bit;
  }
  return true;
}

}  // namespace steadyrest::nc::interpret
