// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <steadyrest/nc/interpret/decode/fanuc/fanuc_words.hpp>
#include <steadyrest/nc/interpret/decode/step_writer.hpp>

namespace steadyrest::nc::interpret {

/// One block of a control of the fanuc family.
class FanucDecoder final : public StepWriter {
 public:
  FanucDecoder(const FanucVariant& variant, const Decoding& in, Step& step) noexcept
      : StepWriter(in, {.numbered_programs = true, .orientation = true}, step), variant_(variant) {}

  /// False when it is refused.
  bool block(const read::Block& block);

 private:
  bool g_word(const read::Word& word);
  bool frame_word(const read::Word& word, int code, bool& taken);
  bool haas_word(const read::Word& word, int code, bool& taken);
  bool m_word(const read::Word& word);
  bool letter_word(const read::Word& word);
  bool word_of_another_kind(const read::Word& word, int motion, bool& taken);
  bool corner_word(const read::Word& word);
  bool factor_word(const read::Word& word);
  bool time_word(const read::Word& word);
  [[nodiscard]] double scaled(const read::Word& word, double value);
  bool finish();
  bool program_call();
  bool machine_points();
  bool offset_number();

  FanucWords& own() noexcept {
    step_.has_fanuc = step_.others = true;
    return step_.fanuc;
  }
  [[nodiscard]] int frame() const noexcept { return step_.has_fanuc ? step_.fanuc.frame : -1; }
  [[nodiscard]] bool increments(const read::Word& word) const noexcept {
    return !word.decimal_point && in_.config.decimal_rule == DecimalRule::least_increment;
  }

  const FanucVariant& variant_;
  std::uint32_t quiet_letters_ = 0;  ///< of words without effect
  double offset_ = -1.0;             ///< P of G54.1
};

}  // namespace steadyrest::nc::interpret
