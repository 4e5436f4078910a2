// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <steadyrest/nc/interpret/flow/program_files.hpp>
#include <steadyrest/nc/read/reader.hpp>
#include <steadyrest/nc/read/text/refused.hpp>

namespace steadyrest::nc::interpret {

/// Where in a file jumps may go and what belongs together: block numbers, labels, structures (IF,
/// loops) and the programs that share the file. Made in one pass over the file when a program first
/// needs it; at most kMost entries.
///
/// A target belongs to the program that contains it. A structure is closed within its program.
class ProgramMap {
 public:
  static constexpr std::size_t kMost = std::size_t{1} << 20U;  ///< entries of one file
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  static constexpr std::uint32_t kToItsEnd = static_cast<std::uint32_t>(-1);

  /// A structure by its lines: the places before its head, behind it, behind ELSE and behind its
  /// end.
  struct Structure {
    read::FlowKind kind = read::FlowKind::none;
    Place head;
    Place body;
    Place otherwise;  ///< behind ELSE; line 0: it has none
    Place foot;       ///< before its end
    Place after;
    std::size_t parent = kNone;
  };
  /// Of a jump.
  struct Target {
    enum class Found : std::uint8_t { no, yes, twice } found = Found::no;
    Place place;  ///< before the block
  };

  /// Reads the file that is being read, from its beginning to its end; the caller goes back. False
  /// when it is refused: a structure that is not closed, too many entries.
  bool note(ProgramFiles& files, const read::Reader& reader, bool block_delete,
            read::Refused& refused);

  /// The structure whose head, ELSE or end is this line; kNone: there is none.
  [[nodiscard]] std::size_t at(std::uint32_t line) const noexcept;
  [[nodiscard]] const Structure& structure(std::size_t index) const noexcept {
    return structures_[index];
  }
  /// The innermost structure that contains the line. Its head's line is outside, its end's inside.
  [[nodiscard]] std::size_t around(std::uint32_t line) const noexcept;
  /// The target of a jump in `from`, a line; `name`: `N100`, `:100`, digits, or a label.
  /// Of several the nearest in that direction; `twice` only for Towards::anywhere.
  [[nodiscard]] Target find(std::string_view name, std::uint32_t from, read::Towards towards) const;
  /// Before the first block of the program that contains the line.
  [[nodiscard]] Place start_of_program(std::uint32_t line) const noexcept;
  /// The program of this name, in capitals; fanuc: its number.
  [[nodiscard]] std::optional<Place> program(std::string_view name) const;

  /// Where what is in doubt from `line` on, at least before `to`, is certain again, whatever jumps
  /// between them are executed: a line, or kToItsEnd where one goes back, leaves the program or has
  /// a target that is calculated, and where a modal call begins or ends.
  [[nodiscard]] std::uint32_t end_of_doubt(std::uint32_t line, std::uint32_t to) const;
  /// A jump or a repeated section may execute the line again: it is between a target and a jump
  /// that goes back to it, or in the program of a jump whose target is calculated.
  [[nodiscard]] bool may_repeat(std::uint32_t line) const noexcept;

 private:
  struct Mark {
    std::uint32_t line = 0;
    std::size_t structure = kNone;
    std::size_t inside = kNone;  ///< the innermost structure behind the line
  };
  struct Exit {
    std::uint32_t line = 0;
    read::FlowKind kind = read::FlowKind::jump;
    std::string target;  ///< empty: calculated, a return or a modal call
    read::Towards towards = read::Towards::either;
  };
  class Noting;
  using Lines = std::pair<std::uint32_t, std::uint32_t>;  ///< first and last
  [[nodiscard]] Lines extent(std::uint32_t line) const noexcept;
  void note_repeats();

  std::vector<Structure> structures_;
  std::vector<Mark> marks_;
  std::vector<Exit> exits_;      ///< and sections
  std::vector<Lines> repeats_;   ///< in order, apart
  std::vector<Place> programs_;  ///< before their first blocks, in order
  std::unordered_map<std::string, Place> program_names_;
  std::unordered_map<std::string, std::vector<Place>> labels_;
  std::vector<std::pair<std::uint32_t, Place>> numbers_;  ///< by number, then by line
};

}  // namespace steadyrest::nc::interpret
