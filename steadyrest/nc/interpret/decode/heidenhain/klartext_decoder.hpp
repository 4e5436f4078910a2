// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include <steadyrest/nc/interpret/decode/step_writer.hpp>
#include <steadyrest/nc/interpret/state/arc.hpp>
#include <steadyrest/nc/read/heidenhain/klartext_words.hpp>

namespace steadyrest::nc::interpret {

/// Klartext → Step. Path functions become lines and arcs with absolute ends and centres: poles,
/// polar coordinates, tangents and mirrored axes are worked out here, from the modal state.
///
/// Laws, in the working plane with axes 1 and 2, pole C, position P:
///   LP, CP:  end = C + PR·(cos PA, sin PA); a missing PR or PA is the present one
///   CT:      centre = P + n·|d|²/(2 d·n), d from P to the end, n the left normal of the heading at
///            P; counter-clockwise where the factor is positive
/// Source: HEIDENHAIN, iTNC 530 user's manual, "Programming contours".
class KlartextDecoder final : public StepWriter {
 public:
  KlartextDecoder(const Decoding& in, Step& step) noexcept : StepWriter(in, {}, step) {}
  bool block(const read::Block& block);

 private:
  /// Words of a path function that are not put into the step at once.
  struct Words {
    const read::Word* radius_polar = nullptr;  ///< PR
    const read::Word* angle_polar = nullptr;   ///< PA
    const read::Word* direction = nullptr;     ///< DR
    const read::Word* radius = nullptr;        ///< R of CR
    const read::Word* length = nullptr;        ///< of RND and CHF
    const read::Word* rapid = nullptr;         ///< FMAX
    const read::Word* feed = nullptr;          ///< F or FAUTO
  };
  // decode_heidenhain.cpp
  bool begin(const read::Block& block);
  bool tool_call(const read::Block& block);
  bool tool_word(const read::Word& word, bool& changes);
  bool cycle(const read::Block& block, read::Klartext function);
  bool cycle_word(const read::Word& word);
  bool m_word(const read::Word& word);
  bool both(const read::Word& word, int spindle);
  bool named(const read::Word& word, Words& words);
  bool common(const read::Block& block, Words& words, bool places);
  [[nodiscard]] double feed_of(const read::Word& word) const noexcept;
  // klartext_geometry.cpp
  bool path(const read::Block& block, read::Klartext function);
  bool pole(const read::Block& block);
  bool corner(const read::Block& block, bool rounds);
  bool feed(const Words& words);
  bool axis(const read::Word& word);
  bool polar(const read::Word& first, const Words& words);
  bool arc(const read::Word& first, read::Klartext function, const Words& words);
  bool polar_arc(const read::Word& first, const Words& words);
  bool tangent(const read::Word& first);
  bool put_end(const read::Word& word, PlanePoint end);
  bool put_centre(const read::Word& word, PlanePoint centre);
  [[nodiscard]] PlanePoint now() const noexcept;
  [[nodiscard]] PlanePoint pole_now() const noexcept;
  [[nodiscard]] PlanePoint mirrored(PlanePoint point) const noexcept;
  [[nodiscard]] bool flips() const noexcept;
  [[nodiscard]] double end_of(std::size_t axis) const noexcept;
  [[nodiscard]] KlartextStep& klartext() noexcept;

  bool machine_ = false;  ///< M91
};

}  // namespace steadyrest::nc::interpret
