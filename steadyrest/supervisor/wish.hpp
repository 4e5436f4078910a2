// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <variant>

#include <steadyrest/chatter/online/modulator_range.hpp>
#include <steadyrest/supervisor/supervisor.hpp>

/// What people ask of the rooms while the layer runs.
namespace steadyrest::supervisor {

/// A text of at most `kMost` bytes, a plain value.
template <std::size_t kMost>
struct ShortText {
  std::size_t size = 0;
  std::array<char, kMost> bytes{};

  ShortText() = default;
  /// Cuts what is too long, at a character of UTF-8.
  explicit ShortText(std::string_view text) noexcept {
    size = std::min(text.size(), kMost);
    while (size > 0 && size < text.size() && (text[size] & '\xc0') == '\x80') {
      --size;
    }
    std::copy_n(text.begin(), size, bytes.begin());
  }
  [[nodiscard]] std::string_view view() const noexcept { return {bytes.data(), size}; }
};

/// A measured size: how far an axis is from its proper place, with the offset in force.
struct Measured {
  std::size_t axis = 0;  ///< by the machine's axes
  ShortText<16> name;    ///< of that axis, for people
  double displacement_mm = 0.0;
  double sd_mm = 0.0;  ///< ≥ 0; 0: the noise of the thermal passport
};

/// A plain value: on its way to the cycle it allocates nothing.
struct Wish {
  std::variant<chatter::online::Modulation, Measured> what;
  ShortText<64> author;  ///< for people
};

/// What became of a wish.
enum class WishOutcome : std::uint8_t {
  taken,
  rejected,      ///< the reading is an outlier; the thermal room has counted it
  room_off,      ///< the chatter or the thermal room
  no_model,      ///< the axis has no thermal model
  out_of_range,  ///< a value
  listening      ///< the layer listens for chatter and chooses the speed itself
};

/// Between two cycles. Only `taken` and `rejected` have changed anything.
WishOutcome grant(Supervisor& layer, const Wish& wish) noexcept;

}  // namespace steadyrest::supervisor
