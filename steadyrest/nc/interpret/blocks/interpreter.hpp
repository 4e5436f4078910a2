// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/blocks/frames.hpp>
#include <steadyrest/nc/interpret/blocks/machine_words.hpp>
#include <steadyrest/nc/interpret/blocks/modes.hpp>
#include <steadyrest/nc/interpret/blocks/offset_data.hpp>
#include <steadyrest/nc/interpret/blocks/offsets.hpp>
#include <steadyrest/nc/interpret/blocks/plain_block.hpp>
#include <steadyrest/nc/interpret/blocks/text_frames.hpp>
#include <steadyrest/nc/interpret/check/assumptions.hpp>
#include <steadyrest/nc/interpret/cycle/cycle_calls.hpp>
#include <steadyrest/nc/interpret/cycle/drilling.hpp>
#include <steadyrest/nc/interpret/cycle/hole_patterns.hpp>
#include <steadyrest/nc/interpret/motion/corners.hpp>
#include <steadyrest/nc/interpret/motion/motion.hpp>
#include <steadyrest/nc/interpret/motion/threading.hpp>

namespace steadyrest::nc::interpret {

/// Executes blocks: decodes and checks each, runs the stages in order, and sends their moves and
/// events to a sink.
///
/// Order within a block, as in LinuxCNC: feed mode, F, S, T, tool change, spindle, coolant,
/// override switches, dwell, plane, units, tool length, work offset, path mode, distance mode,
/// retract mode, offsets and reference points, motion, program stop.
///
/// A block is checked before it acts, but a fault that shows only while it acts (a cycle's missing
/// word) may come after moves of the same block; a refusal is never replaced by a guess. After a
/// refusal the state is that of the last certain point: stop there.
class Interpreter {
 public:
  static kernel::outcome::Result<std::unique_ptr<Interpreter>> make(Config config);

  /// False when the block is refused: see `refused()`.
  bool execute(const read::Block& block, Sink& sink);
  /// A call of a drilling cycle (sinumerik); with MCALL it runs after each block that moves from
  /// now on.
  bool execute_cycle(const read::Block& block, Sink& sink);
  /// The file ends without the program's end word: false where the dialect needs one.
  bool end_of_file(std::uint32_t line, Sink& sink);
  /// Checks a block's words without executing: false when a word is not in the dialect.
  bool survey(const read::Block& block);

  [[nodiscard]] bool finished() const noexcept { return finished_; }
  [[nodiscard]] const read::Refused& refused() const noexcept { return control_.refusals.last(); }
  [[nodiscard]] const State& state() const noexcept { return control_.state; }
  /// The last block was only a straight move: of the state, only position, motion and feed may have
  /// changed.
  [[nodiscard]] bool moved_alone() const noexcept { return plain_.was_last(); }
  /// What the blocks so far have left to a setting of the control that is not known.
  [[nodiscard]] std::vector<Assumption> assumed() const { return assumptions_.found(); }
  /// The line that is read next (#<_line>).
  void at_line(std::uint32_t line) noexcept { control_.state.line = line; }
  /// The values that the program's expressions read.
  [[nodiscard]] Parameters& parameters() noexcept { return parameters_; }
  /// The tool table as the program left it; nothing where none was given.
  [[nodiscard]] const std::optional<std::vector<Tool>>& tools() const noexcept {
    return control_.config.tools;
  }
  /// A subprogram begins or ends: it has its own saved modes (M70, M73).
  void enter_call() { modes_.enter_call(); }
  void leave_call(Sink& sink);
  /// M98 or M99 of the block that was executed last.
  struct ProgramCall {
    enum class Kind : std::uint8_t { none, call, end } kind = Kind::none;
    std::int32_t number = 0;
    double repeats = 1.0;
  };
  [[nodiscard]] const ProgramCall& program_call() const noexcept { return program_call_; }

 private:
  explicit Interpreter(Config config);

  /// Executes Config::settings.startup: refused where it moves, or is not one block.
  kernel::outcome::Result<void> start_up();
  bool decode(const read::Block& block);
  bool act(const Step& step);
  bool non_modal(const Step& step);
  void assume_feed(const Step& step) noexcept;
  void motion_in_force(int motion) noexcept;
  void end_cycle() noexcept;
  bool move(const Step& step);
  bool call_program(const Step& step);
  bool stop(const Step& step);

  Control control_;
  Decoding decoding_{.config = control_.config,
                     .state = control_.state,
                     .axes = control_.axes,
                     .refusals = control_.refusals};
  Parameters parameters_;
  MoveOutput out_{control_.state};
  BlockCheck check_{control_};
  Assumptions assumptions_{control_};
  MachineWords machine_{control_, out_};
  Modes modes_{control_, out_};
  Offsets offsets_{control_, out_};
  OffsetData data_{control_, out_};
  Frames frames_{control_, out_};
  TextFrames text_frames_{control_, out_};
  CutterStage cutter_{control_, out_};
  Corners corners_{control_, out_};
  Motion motion_{control_, out_, cutter_, corners_, parameters_};
  Splines splines_{control_, out_};
  Threading threading_{control_, out_};
  Drilling drilling_{control_, out_, assumptions_};
  HolePatterns patterns_{control_, out_, drilling_};
  CycleCalls cycle_calls_{control_, out_};
  PlainBlock plain_{control_, out_, machine_, cutter_, splines_};
  Step step_{};
  ProgramCall program_call_;
  bool finished_ = false;
};

}  // namespace steadyrest::nc::interpret
