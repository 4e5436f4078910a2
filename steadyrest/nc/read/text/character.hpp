// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Character classes of NC programs: ASCII, whatever the locale.
namespace steadyrest::nc::read {

constexpr bool is_blank(char c) noexcept {
  return c == ' ' || c == '\t';
}
constexpr bool is_digit(char c) noexcept {
  return static_cast<unsigned char>(c - '0') < 10;
}
constexpr bool is_letter(char c) noexcept {
  return static_cast<unsigned char>((static_cast<unsigned char>(c) | 0x20U) - 'a') < 26;
}
/// A character of a name in the dialect `sinumerik`.
constexpr bool in_name(char c) noexcept {
  return is_letter(c) || is_digit(c) || c == '_';
}
constexpr char upper(char c) noexcept {
  return is_letter(c) ? static_cast<char>(static_cast<unsigned char>(c) & 0xdfU) : c;
}
constexpr char lower(char c) noexcept {
  return is_letter(c) ? static_cast<char>(static_cast<unsigned char>(c) | 0x20U) : c;
}
constexpr bool is_control(char c) noexcept {
  return (static_cast<unsigned char>(c) < 0x20 && c != '\t') || c == 0x7f;
}

}  // namespace steadyrest::nc::read
