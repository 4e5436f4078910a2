// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/nc/interpret/decode/step_writer.hpp>

namespace steadyrest::nc::interpret {

/// One block of a SINUMERIK program.
class SinumerikDecoder final : public StepWriter {
 public:
  SinumerikDecoder(const Decoding& in, Step& step) noexcept : StepWriter(in, {}, step) {}
  bool block(const read::Block& block);

 private:
  bool g_word(const read::Word& word);
  bool put_motion(const read::Word& word, int code);
  bool data_word(const read::Word& word);
  bool m_word(const read::Word& word);
  bool spindle_word(const read::Word& word, int code);
  bool letter_word(const read::Word& word);
  bool tool_data(const read::Word& word);
  bool finish();

  // decode_sinumerik_names.cpp
  bool name_word(const read::Word& word);
  bool bare_word(const read::Word& word, bool& done);
  bool value_word(const read::Word& word);
  bool smoothing_word(const read::Word& word);
  bool other_spindle(const read::Word& word);
  bool way_word(const read::Word& word);

  // decode_sinumerik_polar.cpp
  bool polar_word(const read::Word& word);
  bool finish_data();
  bool finish_limits();
  bool finish_pole();
  bool finish_polar();
  bool finish_line();
  [[nodiscard]] double unit_mm() const noexcept;
  [[nodiscard]] PlaneAxes plane_axes() const noexcept;

  NamedWords& named() { return step_.named ? *step_.named : step_.named.emplace(); }

  const read::Word* data_ = nullptr;    ///< G25, G26, G110 to G112
  const read::Word* radius_ = nullptr;  ///< RP
  const read::Word* angle_ = nullptr;   ///< AP
  const read::Word* slope_ = nullptr;   ///< ANG
};

}  // namespace steadyrest::nc::interpret
