// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/parameters/known_state.hpp>
#include <steadyrest/nc/interpret/provenance/doubt.hpp>
#include <steadyrest/nc/interpret/state/asked.hpp>
#include <steadyrest/nc/interpret/state/assumption.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/interpret/state/move.hpp>
#include <steadyrest/nc/interpret/state/opaque.hpp>
#include <steadyrest/nc/interpret/state/state.hpp>
#include <steadyrest/nc/read/text/block.hpp>
#include <steadyrest/nc/read/text/line_source.hpp>
#include <steadyrest/nc/read/text/refused.hpp>

namespace steadyrest::nc::interpret {

/// The result of running a program.
struct Report {
  std::uint64_t lines = 0;
  std::uint64_t blocks = 0;  ///< executed lines with at least one word
  std::uint64_t moves = 0;   ///< moves and dwells sent to the sink
  /// Empty when the program ran to its end. The first entry is where the execution stopped; the
  /// others are words further down that the reader or the dialect does not accept, each kind once,
  /// at most `kMostRefused`.
  std::vector<read::Refused> refused;
  /// What the program leaves to settings of the control that are not known, in no order.
  std::vector<Assumption> assumed;
  /// What the program has read of values that the control decides, and what was taken for them.
  std::vector<Assumed> unknown;
  /// Blocks that are not understood, where Config::opaque_stretches lets them be; the first 200.
  std::vector<OpaqueStretch> opaque;
  std::uint64_t opaque_blocks = 0;       ///< all of them, each time that it was executed
  std::vector<std::string> subprograms;  ///< files that it calls

  static constexpr std::size_t kMostRefused = 50;
};

/// Executes a program line by line, giving access to the state between two lines.
class ProgramRun {
 public:
  /// What the control keeps after the program, in addition to the offsets of the state.
  struct Kept {
    std::vector<Tool> tools;  ///< where a table was given
    /// Variables that are set, by their name in the program.
    std::vector<std::pair<std::string, double>> variables;
  };

  /// `source` and `sink` outlive the run.
  static kernel::outcome::Result<ProgramRun> make(read::LineSource& source, const Config& config,
                                                  Sink& sink);
  ProgramRun(ProgramRun&& other) noexcept;
  ~ProgramRun();

  /// Advances by one line. False at the program's end or when it is refused.
  bool step();
  /// Call before the first step: `other`, which must outlive this run, runs the same lines a step
  /// ahead with the same configuration. A line that is equal byte for byte and has only numbers as
  /// values is split into words once; each run executes the words itself.
  void read_with(const ProgramRun& other);
  /// Call before the first step where at_top() is asked: looks through the file for jumps that go
  /// back (fanuc, sinumerik).
  void note_jumps();
  /// The report; call once, after the last step.
  [[nodiscard]] Report take();

  // Of the line that step() has just been at:
  [[nodiscard]] std::uint32_t line() const noexcept;
  /// Its words were executed: it was not skipped and has no O-word.
  [[nodiscard]] bool executed() const noexcept;
  /// Its words are a straight move and numbers: of the state, only position, motion and feed may
  /// have changed.
  [[nodiscard]] bool moved_alone() const noexcept;
  /// It is in the program itself, outside any subprogram, condition and loop; after note_jumps()
  /// also outside the lines that a jump may execute again.
  [[nodiscard]] bool at_top() const noexcept;
  [[nodiscard]] bool in_main() const noexcept;  ///< not in a subprogram's own file
  [[nodiscard]] const read::Block& block() const noexcept;
  /// What its expressions have read of the control's own state.
  [[nodiscard]] const Asked& asked() const noexcept;
  /// It was not understood: what it does, only the control knows.
  [[nodiscard]] bool at_opaque() const noexcept;
  /// What it depends on that only the control knows.
  [[nodiscard]] Doubt doubt() const noexcept;
  /// So far: see Report.
  [[nodiscard]] const std::vector<Assumed>& unknown() const noexcept;
  [[nodiscard]] const State& state() const noexcept;  ///< as it is now
  [[nodiscard]] Kept kept() const;                    ///< likewise

 private:
  class Run;
  explicit ProgramRun(std::unique_ptr<Run> run);
  std::unique_ptr<Run> run_;
};

/// Executes a whole program from a file, in bounded memory. An error is a file that cannot be read;
/// refused words are in the report.
kernel::outcome::Result<Report> run_file(const std::string& path, const Config& config, Sink& sink);

/// The same for a text in memory.
kernel::outcome::Result<Report> run_text(std::string_view text, const Config& config, Sink& sink);

/// The same for any source of lines.
kernel::outcome::Result<Report> run_lines(read::LineSource& source, const Config& config,
                                          Sink& sink);

/// The first refusal of a report in the form used by all rooms: `FILE:LINE: what; to do`.
[[nodiscard]] kernel::outcome::Refusal first_refusal(const Report& report, const std::string& path);

}  // namespace steadyrest::nc::interpret
