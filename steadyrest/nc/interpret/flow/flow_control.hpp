// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <steadyrest/nc/interpret/flow/program_files.hpp>
#include <steadyrest/nc/interpret/parameters/parameters.hpp>
#include <steadyrest/nc/read/reader.hpp>
#include <steadyrest/nc/read/text/block.hpp>
#include <steadyrest/nc/read/text/refused.hpp>

namespace steadyrest::nc::interpret {

/// Decides which line comes next: subprograms, conditions and loops.
///
/// Follows LinuxCNC 2.9's interpreter (rs274, by experiment): a subprogram's definition is skipped
/// where it occurs and executed where it is called; a call looks among the definitions seen so far,
/// then for NAME.ngc, then further down in the file. Calls nest nine deep, those of the other
/// dialects ten. A label belongs to the subprogram that contains it and may head only one block. Of
/// skipped lines only O-words are read. Every program ends: lines executed in loops and calls count
/// against a limit.
///
/// Where a condition, a count or a label follows from a value that the control decides, the lines
/// up to its end are executed or skipped in doubt. `return`, `break` and `continue` in doubt carry
/// it to the end of their subprogram or loop.
class FlowControl {
 public:
  static constexpr std::size_t kDeepestCall = 10;         ///< of fanuc and sinumerik
  static constexpr std::size_t kDeepestLinuxcncCall = 9;  ///< found with rs274 2.9

  /// All outlive the object.
  FlowControl(ProgramFiles& files, Parameters& parameters, read::Reader& reader,
              const Config& config);

  /// The next lines are skipped: give them to pass_over() instead of executing them.
  [[nodiscard]] bool passing_over() const noexcept { return passing_ != Passing::nothing; }
  bool pass_over(read::Block& block);
  /// Executes the O-word of a block. False when it is refused: see refused().
  bool act(const read::Block& block);
  /// M98 P… L… and M99.
  bool call_program(std::uint32_t line, std::string_view label, double repeats);
  bool end_program(std::uint32_t line);
  /// M98 of fanuc: a program anywhere in the same file, else a file in the folders named after its
  /// number.
  bool call_numbered(std::uint32_t line, std::int32_t number, double repeats);
  /// A call by name of sinumerik: NAME.SPF or NAME.MPF in the folders.
  bool call_named(const read::Block& block);
  /// END PGM of a program that CALL PGM has called.
  bool end_file(const read::Block& block);
  /// How many programs are being called by CALL PGM, and whether any is.
  [[nodiscard]] std::size_t files() const noexcept { return files_called_; }
  [[nodiscard]] bool in_file() const noexcept { return files_called_ != 0; }
  /// To be called for each line, with the moves so far; false when the limit is reached.
  bool count_line(std::uint64_t moves_before);
  /// Why the file must not end here; false when it may.
  bool refuse_end();
  [[nodiscard]] bool in_call() const noexcept { return frames_.size() > 1; }
  [[nodiscard]] bool repeating() const noexcept {
    return in_call() || !frames_.back().open.empty() || jumped_;
  }

  /// Whether the line at hand is executed is the control's decision.
  [[nodiscard]] bool in_doubt() const noexcept;
  /// What may have been set, or not, by lines that neither were executed nor will be skipped.
  enum class Lost : std::uint8_t {
    nothing,
    turn,  ///< by another turn of the loop that has just ended
    all
  };
  /// The lines are skipped for a condition or a count, not in search of a subprogram.
  [[nodiscard]] bool passing_branch() const noexcept { return passing_ >= Passing::to_else; }
  /// A line that is skipped in doubt has M98 or M99.
  void skip_program_word() noexcept;
  [[nodiscard]] Lost take_lost() noexcept { return std::exchange(lost_, Lost::nothing); }

  [[nodiscard]] const read::Refused& refused() const noexcept { return refused_; }

 private:
  enum class Passing : std::uint8_t {
    nothing,
    to_endsub,
    to_sub,
    to_program,
    to_else,
    to_endif,
    to_endwhile,
    to_endrepeat,
    to_while,     ///< after the `while` that ends a do loop
    to_condition  ///< to that `while` itself
  };
  struct Open {
    read::FlowKind kind = read::FlowKind::none;
    std::string label;
    Place head;
    bool doubtful = false;  ///< whether it is executed, or once more, is the control's decision
    bool left = false;      ///< in doubt, by break or continue
  };
  struct Frame {
    std::string sub;
    Place back;
    Place head;
    double left = 0.0;  ///< remaining repeats (M98 L)
    bool by_number = false;
    std::vector<Open> open;
    bool doubtful = false;  ///< from here to its end
    /// Lines of loops whose further turns are in doubt. Designated initialisers may leave it out.
    // NOLINTNEXTLINE(readability-redundant-member-init)
    std::vector<std::uint32_t> left_heads = {};
    bool is_file = false;  ///< CALL PGM
    /// Lines of CALL LBL REP that are being repeated, with the repeats that are left.
    // NOLINTNEXTLINE(readability-redundant-member-init)
    std::vector<std::pair<std::uint32_t, double>> sections = {};
  };

  // heidenhain: flow_marks.cpp
  bool call_mark(const read::Block& block);
  bool repeat_section(const read::Block& block, const Place& head);
  bool end_of_mark(const read::Block& block);
  bool jump_mark(const read::Block& block);
  bool call_file(const read::Block& block);
  const Place* mark(const read::Block& block);
  bool note_marks(std::uint32_t line);
  bool refuse_mark(const read::Block& block, std::string_view reason, std::string_view text);

  bool sub(const read::Block& block);
  bool call(const read::Block& block);
  bool enter_numbered(std::uint32_t line, std::string_view label, const Place& head,
                      double repeats);
  bool note_programs(std::uint32_t line, std::uint32_t file);
  bool enter(std::uint32_t line, std::string_view label, Passing how, Frame frame);
  bool leave(const double* returned, bool unknown = false);
  bool end_of_sub(const read::Block& block);
  bool condition(const read::Block& block);
  bool otherwise(const read::Block& block);
  bool close(const read::Block& block, read::FlowKind head);
  bool head_of_while(const read::Block& block);
  bool end_of_turn(const read::Block& block, read::FlowKind loop, std::string_view unmatched);
  bool head_of_repeat(const read::Block& block);
  bool leave_loop(const read::Block& block);
  bool next_turn(const read::Block& block);
  bool arrived(read::Block& block);
  bool evaluate(read::Block& block);
  [[nodiscard]] static bool in_doubt(const Frame& frame) noexcept;
  void doubt(Open& open) noexcept;
  bool open_loop(const read::Block& block, bool unknown);
  void pass_in_doubt(bool unknown) noexcept;
  void leave_in_doubt(Open* loop) noexcept;
  void skip_in_doubt(const read::Block& block);
  void lose(Lost lost) noexcept { lost_ = std::max(lost_, lost); }

  bool open(const read::Block& block, const Place& head);
  Open* find(const read::Block& block, bool loops_only);
  void drop_to(const Open& open);
  bool define(const read::Block& block);
  bool go(std::uint32_t line, const Place& place);
  void pass(Passing how, std::string_view label);
  bool refuse(std::uint32_t line, std::string_view label, std::string_view reason,
              std::string_view text);

  ProgramFiles& files_;
  Parameters& parameters_;
  read::Reader& reader_;
  std::uint64_t most_repeated_lines_;
  std::uint64_t repeated_lines_ = 0;
  std::vector<Frame> frames_;
  std::map<std::string, Place> subs_;      ///< label → after the line of its `sub`
  std::map<std::string, Place> programs_;  ///< number → after the line of its O
  std::map<std::string, Place> heads_;     ///< labels that head a block
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> turns_left_;  ///< repeats by file, line
  bool programs_noted_ = false;
  /// Labels of heidenhain by file → after their lines; of the files that have been noted.
  std::map<std::pair<std::uint32_t, std::string>, Place> marks_;
  std::vector<std::uint32_t> marked_files_;
  std::size_t files_called_ = 0;
  bool jumped_ = false;  ///< backwards, ever: lines may be executed again
  Passing passing_ = Passing::nothing;
  std::string passing_label_;
  std::uint32_t passing_from_ = 0;
  bool passing_in_doubt_ = false;
  bool any_doubt_ = false;  ///< has ever been: nearly no program has
  Lost lost_ = Lost::nothing;
  bool after_continue_ = false;  ///< of a do loop, before any while loop
  bool after_break_ = false;     ///< of a while loop, before any do loop
  read::Refused refused_;
};

}  // namespace steadyrest::nc::interpret
