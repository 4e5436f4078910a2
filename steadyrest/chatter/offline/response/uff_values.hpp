// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include <steadyrest/chatter/offline/response/uff_function.hpp>
#include <steadyrest/chatter/offline/response/uff_lines.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// The numbers of a dataset 58, as text or as bytes.
namespace steadyrest::chatter::offline {

/// How the numbers are written: the head of dataset 58 or 58b.
struct UffForm {
  enum class Bytes : std::uint8_t { none, little_endian, big_endian };
  Bytes bytes = Bytes::none;  ///< none: text
  std::size_t announced = 0;  ///< bytes of the numbers
};

/// Record 7: kind of numbers, how many, first abscissa and step (even), or none (uneven).
struct UffShape {
  int number_type = 5;
  std::size_t count = 0;
  bool even = true;
  double first = 0.0;
  double step = 0.0;
};

/// Of the line that names the dataset. Refused: VAX and IBM numbers, an unknown byte order.
[[nodiscard]] kernel::outcome::Result<UffForm> uff_form(std::string_view kind,
                                                        const UffLines& lines);
/// `over_time`: the abscissa may begin before 0, at a trigger.
[[nodiscard]] kernel::outcome::Result<UffShape> uff_shape(UffLines& lines, bool over_time);

/// Fills in number type, abscissa and values. Refused: fewer numbers than announced, words.
/// Nothing is reserved that the text does not hold.
[[nodiscard]] std::optional<kernel::outcome::Refusal> uff_values(const UffForm& form,
                                                                 const UffShape& shape,
                                                                 UffLines& lines, UffFunction& out);

}  // namespace steadyrest::chatter::offline
