// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include <steadyrest/nc/interpret/decode/dialect_rules.hpp>

namespace steadyrest::nc::interpret {

/// Puts words into a step: the part of decoding that all dialects share. A decoder translates what
/// its dialect writes differently and passes the rest on.
class StepWriter {
 public:
  /// Words that not every dialect has.
  struct Vocabulary {
    bool cutter_compensation = false;  ///< G41, G42
    bool outputs_and_modes = false;    ///< M19, M62 to M73
    bool numbered_programs = false;    ///< M98, M99
    bool orientation = false;          ///< M19
  };

  StepWriter(const Decoding& in, Vocabulary vocabulary, Step& step) noexcept
      : in_(in), vocabulary_(vocabulary), step_(step) {}

  /// A G word by its code in `words.hpp`.
  bool put_g(const read::Word& word, int code);
  /// An M word as written.
  bool take_m(const read::Word& word);
  /// Stores a value under a letter, which need not be the word's own.
  bool put_letter(const read::Word& word, char letter, double value);

 protected:
  /// A G word of the dialect's own, in the group named.
  bool put_in(const read::Word& word, int code, GGroup group);
  /// Tells refusals that a letter or a group has its value from this word.
  void from(const read::Word& word, char letter) noexcept;
  void from(const read::Word& word, GGroup group) noexcept;
  bool refuse(const read::Word& word, std::string_view reason, std::string_view text) {
    return in_.refusals.word(step_.line, word, reason, text);
  }
  /// One of the two words of `Config::modulation_on` and `modulation_off`.
  [[nodiscard]] bool is_modulation(const read::Word& word) const noexcept;

  const Decoding& in_;
  Vocabulary vocabulary_;
  Step& step_;

 private:
  [[nodiscard]] std::uint8_t place_of(const read::Word& word) const noexcept {
    return static_cast<std::uint8_t>(&word - step_.block->words().data());
  }
  bool put_m(const read::Word& word, int code);
  bool put_modulation(const read::Word& word);
};

}  // namespace steadyrest::nc::interpret
