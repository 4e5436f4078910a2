// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/config.hpp>
#include <steadyrest/nc/interpret/move.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/read/line_source.hpp>
#include <steadyrest/nc/rewrite/kept_moves.hpp>
#include <steadyrest/nc/rewrite/survey.hpp>

namespace steadyrest::nc::rewrite {

/// What kind of place it is before a line, for a shift of one axis.
enum class Site : std::uint8_t {
  none,       ///< not safe
  rapid,      ///< the line is a G0 that programs the axis absolutely: the shift acts in it
  clearance,  ///< between two rapids that leave the axis where it stands: it is restated there
  feed        ///< the line is a G1 that programs the axis absolutely
};
[[nodiscard]] std::string_view name(Site site) noexcept;

/// What the line does to the frame that a correction stands in.
enum class Frame : std::uint8_t {
  kept,
  changed,  ///< another work offset is active, or the active one gets a new value (G10 L2)
  measured  ///< G10 L20 for a work offset that is not active: it would take the shift with it
};

/// Goes through a program line by line and judges the place before each line. The law of a safe
/// place stands in README.md.
class Walk {
 public:
  /// The survey must be of the same program and configuration.
  static kernel::outcome::Result<std::unique_ptr<Walk>> make(const std::string& path,
                                                             const interpret::Config& config,
                                                             const Survey& survey);

  bool step();
  [[nodiscard]] interpret::Report take() { return run_->take(); }

  /// Of the line that step() has been at. `index` in interpret::Axes.
  [[nodiscard]] Site site(char letter, std::size_t index) const;
  [[nodiscard]] Frame frame(char letter, std::size_t index) const;
  /// Lines may be put before this one at all: it is executed exactly once, in no condition, not
  /// switched off by the operator, and neither cutter compensation nor rotation is in force.
  [[nodiscard]] bool may_write() const noexcept;
  [[nodiscard]] bool moves_axis(std::size_t index) const noexcept;
  /// It has words that go to machine coordinates: G53, SUPA, G28, G30.
  [[nodiscard]] bool machine_frame() const noexcept { return facts_.machine_frame; }
  [[nodiscard]] std::uint32_t line() const noexcept { return run_->line(); }
  /// The last line outside of subprograms and loops, this one included.
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
    interpret::Axes offset{};       ///< machine = position + offset
    interpret::Axes work_offset{};  ///< of the active system
    std::size_t active_offset = 0;
    bool work_offset_on = true;
    double unit_mm = 1.0;
    int motion = -1;
    bool incremental = false;
    bool inverse_time = false;
    bool cutter = false;
    bool rotated = false;
    bool diameter = false;
    interpret::MoveKind last_move = interpret::MoveKind::rapid;
    /// Axes whose work position the program has given, whatever the offsets are, a mask.
    std::uint32_t given = 0;
  };
  [[nodiscard]] const Before& before() const noexcept { return before_; }

 private:
  /// Of a block's words.
  struct Facts {
    bool plain = false;             ///< nothing but straight motion and what goes well with it
    std::uint32_t axes = 0;         ///< axis letters programmed absolutely
    std::uint32_t incremental = 0;  ///< axis letters programmed by IC( )
    bool machine_frame = false;
    bool settable = false;  ///< sinumerik G54 …, G500: takes the stored frame anew
    bool data = false;      ///< G10
    double data_form = -1.0;
    double data_set = -1.0;
  };

  Walk(read::LineSource source, const Survey& survey)
      : source_(std::move(source)), survey_(survey) {}
  void remember();
  [[nodiscard]] std::uint32_t given() const noexcept;
  void look(const read::Block& block);
  void look_at_g(double code);
  [[nodiscard]] bool calm() const noexcept;

  read::LineSource source_;
  const Survey& survey_;
  std::optional<interpret::ProgramRun> run_;
  KeptMoves kept_;
  Before before_;
  Facts facts_;
  bool any_move_ = false;
  bool ends_ = false;
  bool sinumerik_ = false;
  std::uint64_t steps_ = 0;
  std::size_t interval_ = 0;
  std::uint32_t top_line_ = 0;
};

}  // namespace steadyrest::nc::rewrite
