// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include <steadyrest/nc/interpret/state/step.hpp>
#include <steadyrest/nc/read/text/block.hpp>
#include <steadyrest/nc/read/text/refused.hpp>

namespace steadyrest::nc::interpret {

/// Keeps why a block is refused. Functions that take a reason return false, so that the caller can
/// return it.
class Refusals {
 public:
  [[nodiscard]] const read::Refused& last() const noexcept { return last_; }

  bool word(std::uint32_t line, const read::Word& word, std::string_view reason,
            std::string_view text);
  /// Shows the word that gave a letter its value, under whatever name; the block's last one where
  /// none did.
  bool letter(const Step& step, char letter, std::string_view reason, std::string_view text);
  /// Shows a G word by its code, or an M word by its number; the block's first word where it is
  /// absent.
  bool g_word(const Step& step, int code, std::string_view reason, std::string_view text);
  bool m_word(const Step& step, int number, std::string_view reason, std::string_view text);
  /// Shows a word by its name, in capitals; the block's first one where it is absent.
  bool named(const Step& step, std::string_view name, std::string_view reason,
             std::string_view text);
  /// For the block as a whole: shows its first word.
  bool block(const Step& step, std::string_view reason, std::string_view text);
  /// For a call: shows its name.
  bool call(std::uint32_t line, const read::Flow& call, std::string_view reason,
            std::string_view text);

 private:
  read::Refused last_;
};

}  // namespace steadyrest::nc::interpret
