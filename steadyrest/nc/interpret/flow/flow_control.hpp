// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <steadyrest/nc/interpret/flow/program_files.hpp>
#include <steadyrest/nc/interpret/flow/program_map.hpp>
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
/// In fanuc and sinumerik a map of the file (ProgramMap) says where jumps go and what belongs
/// together. A jump out of a structure closes it, a jump into one is refused.
///
/// Where a condition, a count or a label follows from a value that the control decides, the lines
/// up to its end are executed or skipped in doubt. `return`, `break` and `continue` in doubt carry
/// it to the end of their subprogram or loop. A jump in doubt puts all lines up to its target in
/// doubt, and up to the targets of the jumps among them; if one of them goes back, all lines up to
/// the end of the subprogram.
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
  /// Before a line is read: a section that is repeated ends here. False when it is refused.
  bool between_lines() { return frames_.back().sections.empty() || end_of_section(); }
  /// M98 P… L… and M99.
  bool call_program(std::uint32_t line, std::string_view label, double repeats);
  bool end_program(std::uint32_t line);
  /// M99 P: back to a block of the caller; in the main program a jump.
  bool end_program_at(std::uint32_t line, std::int32_t number);
  /// M98 of fanuc: a program anywhere in the same file, else a file in the folders named after its
  /// number.
  bool call_numbered(std::uint32_t line, std::int32_t number, double repeats);
  /// A call by name of sinumerik: a program of the same file (%_N_NAME_SPF), else NAME.SPF or
  /// NAME.MPF in the folders.
  bool call_named(std::uint32_t line, const read::Flow& call);
  /// A program that is called after each block that moves: G66, MCALL NAME. Without a label: none.
  bool set_modal(std::uint32_t line, const read::Flow& call);
  [[nodiscard]] bool modal_due() const noexcept {
    return modal_.kind != read::FlowKind::none && !modal_running_;
  }
  [[nodiscard]] bool modal() const noexcept { return modal_.kind != read::FlowKind::none; }
  bool call_modal(std::uint32_t line);
  /// The values of the last call by name.
  [[nodiscard]] const read::Flow& values() const noexcept { return values_; }
  /// To be called for each line, with the moves so far; false when the limit is reached.
  bool count_line(std::uint64_t moves_before);
  /// Why the file must not end here; false when it may.
  bool refuse_end();
  /// Looks for the jumps of the main program, so that may_repeat() knows them; before it begins.
  void note_jumps();
  /// A jump of the main program may execute its line again: see ProgramMap.
  [[nodiscard]] bool may_repeat(std::uint32_t line) const noexcept {
    return main_map_ != nullptr && main_map_->may_repeat(line);
  }
  [[nodiscard]] bool in_call() const noexcept { return frames_.size() > 1; }
  [[nodiscard]] bool repeating() const noexcept {
    return in_call() || !frames_.back().open.empty();
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
    std::size_t structure = ProgramMap::kNone;  ///< in the map of its file
    double limit = 0.0;                         ///< of a loop that counts
  };
  /// REPEAT LABEL: lines that are executed again before the program goes on.
  struct Section {
    Place first;
    std::uint32_t last_line = 0;
    Place back;
    double left = 0.0;
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
    // NOLINTNEXTLINE(readability-redundant-member-init)
    std::vector<Section> sections = {};
    std::uint32_t doubt_to = 0;  ///< lines before this one are in doubt; 0: none
    bool modal = false;          ///< called by a modal call
  };

  // flow_jumps.cpp, flow_structures.cpp: by the map of the file
  bool act_mapped(const read::Block& block);
  const ProgramMap* map_of(std::uint32_t line, std::uint32_t file);
  bool jump(const read::Block& block, const ProgramMap& map);
  bool jump_to(std::uint32_t line, const ProgramMap& map, const Place& target);
  bool refuse_target(std::uint32_t line, std::string_view name, ProgramMap::Target::Found found);
  void doubt_lines(const ProgramMap& map, std::uint32_t from, std::uint32_t to) noexcept;
  bool structure(const read::Block& block, const ProgramMap& map);
  bool branch(const read::Block& block, std::size_t index, const ProgramMap::Structure& structure);
  bool loop_head(const read::Block& block, std::size_t index,
                 const ProgramMap::Structure& structure);
  bool loop_end(const read::Block& block, const ProgramMap& map,
                const ProgramMap::Structure& structure);
  bool section(const read::Block& block, const ProgramMap& map);
  bool end_of_section();
  bool go_back(std::uint32_t line, const Place& place);
  void carry_doubt_over(bool doubtful) noexcept;

  bool sub(const read::Block& block);
  bool call(const read::Block& block);
  bool enter_numbered(std::uint32_t line, std::string_view label, const Place& head,
                      double repeats);
  std::optional<Place> find_named(std::uint32_t line, const std::string& name);
  std::optional<Place> program_of_file(std::uint32_t line, std::string_view name);
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
  Passing passing_ = Passing::nothing;
  std::string passing_label_;
  std::uint32_t passing_from_ = 0;
  bool passing_in_doubt_ = false;
  bool any_doubt_ = false;  ///< has ever been: nearly no program has
  Lost lost_ = Lost::nothing;
  bool block_delete_;
  std::map<std::uint32_t, ProgramMap> maps_;  ///< by file
  const ProgramMap* main_map_ = nullptr;      ///< where jumps were looked for
  std::uint32_t jumped_back_ = 0;             ///< the line that did so last
  read::Flow modal_;
  bool modal_running_ = false;  ///< its own moves do not call it
  read::Flow values_;
  bool after_continue_ = false;  ///< of a do loop, before any while loop
  bool after_break_ = false;     ///< of a while loop, before any do loop
  read::Refused refused_;
};

}  // namespace steadyrest::nc::interpret
