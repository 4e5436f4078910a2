// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/decode/dialect_rules.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/interpret/state/move.hpp>
#include <steadyrest/nc/read/text/line_source.hpp>
#include <steadyrest/nc/rewrite/text/writing.hpp>
#include <steadyrest/nc/rewrite/walk/kept_moves.hpp>
#include <steadyrest/nc/rewrite/walk/said.hpp>
#include <steadyrest/nc/rewrite/walk/survey.hpp>

namespace steadyrest::nc::rewrite {

/// What kind of place there is before a line for a shift of one axis.
enum class Site : std::uint8_t {
  none,       ///< not safe
  rapid,      ///< the line is a G0 that programs the axis absolutely: the shift acts in it
  clearance,  ///< between two rapids that do not move the axis: it is restated there
  feed        ///< the line is a G1 that programs the axis absolutely
};
[[nodiscard]] std::string_view name(Site site) noexcept;

/// What the line does to the frame that holds a correction.
enum class Frame : std::uint8_t {
  kept,
  changed,   ///< selects another work offset, or sets the active one (G10 L2)
  measured,  ///< G10 L20 for an inactive work offset: it would take the shift with it
  stored     ///< G28.1, G30.1: stores the machine's position, including the shift
};

/// Goes through a program line by line and judges the place before each line. See README.md for the
/// law of a safe place. A program with lines with `/` is walked in both positions of the operator's
/// switch, and a place must be the same in both.
class Walk {
 public:
  /// The survey must be of the same program and configuration.
  static kernel::outcome::Result<std::unique_ptr<Walk>> make(const std::string& path,
                                                             const interpret::Config& config,
                                                             const Survey& survey, const Way& way);

  bool step();
  [[nodiscard]] interpret::Report take() { return run_->take(); }

  /// Of the line that step() is at. `index` in interpret::Axes.
  [[nodiscard]] Site site(char letter, std::size_t index) const;
  [[nodiscard]] Frame frame(char letter) const;
  /// Lines may be inserted before this one: it is executed exactly once, in no condition, the
  /// operator cannot skip it, and neither cutter compensation nor a rotation of this axis is in
  /// force.
  [[nodiscard]] bool may_write(std::size_t index) const noexcept;
  /// A start state of the control that keeps a line from being a place, and what to do about it.
  struct Unsaid {
    std::string_view what;
    std::string_view to_do;
  };
  /// Nothing where the line is a place, or is not one for other reasons.
  [[nodiscard]] const Unsaid* unsaid(char letter, std::size_t index) const;
  /// The first finding that keeps the program from being corrected, in either position of the
  /// switch.
  [[nodiscard]] const std::optional<Taken>& taken() const noexcept {
    return said_.taken() || other_ == nullptr ? said_.taken() : other_->said_.taken();
  }
  /// The program has by now selected mm or inches, in both positions of the switch.
  [[nodiscard]] bool units_said() const noexcept {
    constexpr auto kUnits = mode(interpret::GGroup::units);
    return said_.has(kUnits) && (other_ == nullptr || other_->said_.has(kUnits));
  }
  /// The line sets this axis of the work offset or the shift in force (G92, G52), whatever its
  /// value was.
  [[nodiscard]] bool sets_offset(char letter) const noexcept;
  /// The line writes to what the control keeps: G10, G28.1, G30.1.
  [[nodiscard]] bool stores() const noexcept { return facts_.data || facts_.reference; }
  [[nodiscard]] bool moves_axis(std::size_t index) const noexcept;
  /// It has words for machine coordinates: G53, SUPA, G28, G30.
  [[nodiscard]] bool machine_frame() const noexcept { return facts_.machine_frame; }
  [[nodiscard]] std::uint32_t line() const noexcept { return run_->line(); }
  /// The last line outside subprograms and loops, including this one.
  [[nodiscard]] std::uint32_t top_line() const noexcept { return top_line_; }
  [[nodiscard]] const interpret::ProgramRun& run() const noexcept { return *run_; }
  [[nodiscard]] const std::vector<interpret::Move>& moves() const noexcept { return kept_.moves; }
  [[nodiscard]] std::vector<interpret::Move>& moves() noexcept { return kept_.moves; }
  [[nodiscard]] const std::vector<interpret::Event>& events() const noexcept {
    return kept_.events;
  }
  [[nodiscard]] bool ends() const noexcept { return ends_; }  ///< it ended the program

  /// The state before the line.
  struct Before {
    interpret::Axes position{};
    interpret::Axes offset{};  ///< machine = position + offset
    std::size_t active_offset = 0;
    bool work_offset_on = true;
    double unit_mm = 1.0;
    int motion = -1;
    bool incremental = false;
    bool inverse_time = false;
    bool cutter = false;
    double rotation_deg = 0.0;
    bool diameter = false;
    interpret::MoveKind last_move = interpret::MoveKind::rapid;
    /// Axes whose work position the program has programmed, whatever the offsets, a mask.
    std::uint32_t given = 0;
    /// Axes whose work position follows from the program, including increments, a mask.
    std::uint32_t known = 0;
  };
  [[nodiscard]] const Before& before() const noexcept { return before_; }

 private:
  /// Of a block's words.
  struct Facts {
    bool plain = false;             ///< only straight motion and harmless words
    std::uint32_t axes = 0;         ///< axis letters programmed absolutely
    std::uint32_t incremental = 0;  ///< axis letters programmed by IC( )
    bool machine_frame = false;
    bool settable = false;   ///< sinumerik G54 …, G500: loads the stored frame again
    bool data = false;       ///< G10
    bool reference = false;  ///< G28.1, G30.1
    bool loses = false;      ///< positions change by what only the control knows: the tool
    bool shifts = false;     ///< or by what the variable file has: G52, G92, a programmed frame
    double data_form = -1.0;
    double data_set = -1.0;
  };

  Walk(read::LineSource source, const interpret::Config& config, const Survey& survey,
       const Way& way);
  static kernel::outcome::Result<std::unique_ptr<Walk>> open(const std::string& path,
                                                             const interpret::Config& config,
                                                             const Survey& survey, const Way& way);
  bool step_alone();
  void follow();
  [[nodiscard]] bool together() const noexcept;
  void remember();
  [[nodiscard]] std::uint32_t given() const noexcept;
  [[nodiscard]] std::uint32_t named() const noexcept;
  void look(const read::Block& block);
  void look_at(const read::Word& word);
  void look_at_g(const read::Word& word);
  void look_for_external();
  /// The current line; in a subprogram in another file, the calling line.
  [[nodiscard]] std::uint32_t line_or_call() const noexcept {
    return run_->in_main() ? run_->line() : top_line_;
  }
  [[nodiscard]] const Unsaid* missing(std::size_t index) const noexcept;
  [[nodiscard]] bool may_write_alone(std::size_t index) const noexcept;
  [[nodiscard]] bool calm(std::size_t index) const noexcept;
  [[nodiscard]] Site site_if_said(char letter, std::size_t index) const;
  [[nodiscard]] Frame frame_alone(char letter) const;
  [[nodiscard]] bool sets_offset_alone(char letter) const noexcept;
  [[nodiscard]] bool of_active() const noexcept;

  read::LineSource source_;
  const Survey& survey_;
  std::optional<interpret::ProgramRun> run_;
  KeptMoves kept_;
  Before before_;
  Facts facts_;
  Said said_;
  bool says_ = false;            ///< the current line has no `/`
  std::unique_ptr<Walk> other_;  ///< with block delete in its other position
  bool over_ = false;
  bool any_move_ = false;
  bool ends_ = false;
  const interpret::DialectRules& rules_;
  bool start_known_ = false;
  bool mill_ = false;  ///< it has a Y: no diameters
  Method method_;
  bool external_free_;  ///< the head sets the external offset to 0, in G90
  std::uint64_t steps_ = 0;
  std::size_t interval_ = 0;
  std::uint32_t top_line_ = 0;
};

}  // namespace steadyrest::nc::rewrite
