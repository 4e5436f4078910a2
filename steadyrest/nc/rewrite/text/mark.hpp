// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/rewrite/text/writing.hpp>

namespace steadyrest::nc::rewrite {

/// The options the program was made with, in the comments that begin its head, so that verify need
/// not be told again: `(STEADYREST head told --dialect linuxcnc --window-s 60 --sum 51f0c9a3)`. The
/// sum covers the others against accidental edits, which nothing else in the program would show.
struct Told {
  std::string name;   ///< of an option, without its dashes
  std::string value;  ///< empty for a flag
  bool operator==(const Told&) const = default;
};

/// How a mark begins: of a program with corrections inserted, and of one with blocks replaced. A
/// program may have both.
inline constexpr std::string_view kInsertedMark = "STEADYREST head told ";
inline constexpr std::string_view kReplacedMark = "STEADYREST head made ";

/// Longest comment that every control reads: LinuxCNC's 255 less what surrounds it.
inline constexpr std::size_t kLongestTold = 200;

/// As written: anything but a letter, a digit or one of `-_./+,:` becomes =XX; a % would end the
/// program on a fanuc.
[[nodiscard]] std::string told_as_text(const Told& one);
[[nodiscard]] std::string mark_text(const Way& way, std::vector<Told> told, std::string_view ending,
                                    std::string_view begin = kInsertedMark);
/// Empty for a program without inserted lines. Refused: an altered mark, and inserted lines without
/// one, as written by earlier versions.
[[nodiscard]] kernel::outcome::Result<std::vector<Told>> read_mark(const std::string& changed);
/// The record of a program with blocks replaced; empty for one without.
[[nodiscard]] kernel::outcome::Result<std::vector<Told>> read_replaced_mark(
    const std::string& changed);
/// A sum over the blocks that replace others and those that they replace, told in the mark as
/// kBlocksSum: it shows an edit by hand. Blanks, line ends and capital letters do not count, since
/// controls change them.
class BlocksSum {
 public:
  void add(std::string_view line) noexcept;
  [[nodiscard]] std::string text() const;

 private:
  std::uint32_t sum_ = 2166136261U;  ///< FNV-1a
};
inline constexpr std::string_view kBlocksSum = "blocks";
/// Whether the blocks of a program are as they were written.
enum class Blocks : std::uint8_t {
  whole,
  edited,
  unknown  ///< the mark has no sum over them, as in programs of earlier versions
};
/// By its mark.
[[nodiscard]] kernel::outcome::Result<Blocks> compare_blocks(const std::string& changed,
                                                             const std::vector<Told>& told);
/// The line is part of such a mark.
[[nodiscard]] bool is_mark(std::string_view line, std::string_view begin) noexcept;

}  // namespace steadyrest::nc::rewrite
