// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/decode/dialect_rules.hpp>
#include <steadyrest/nc/interpret/parameters/parameters.hpp>
#include <steadyrest/nc/interpret/state/arc.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/interpret/state/cutter_compensation.hpp>
#include <steadyrest/nc/interpret/state/move.hpp>
#include <steadyrest/nc/interpret/state/refusals.hpp>
#include <steadyrest/nc/interpret/state/state.hpp>
#include <steadyrest/nc/interpret/state/step.hpp>
#include <steadyrest/nc/read/text/block.hpp>
#include <steadyrest/nc/read/text/refused.hpp>

namespace steadyrest::nc::interpret {

/// Executes blocks: keeps the modal state and gives moves and events to a sink.
///
/// Order within a block, as LinuxCNC has it: feed mode, F, S, T, tool change, spindle, coolant,
/// override switches, dwell, plane, units, tool length, work offset, path mode, distance mode,
/// retract mode, offsets and reference points, motion, program stop.
///
/// A block is checked before it acts, but a fault that shows only while it acts (a cycle's missing
/// word) may leave moves of the same block behind it; what was refused is never replaced by a
/// guess. After a refusal the state is that of the last point that is certain: stop there.
class Interpreter {
 public:
  static kernel::outcome::Result<Interpreter> make(Config config);

  /// False when the block is refused: see `refused()`.
  bool execute(const read::Block& block, Sink& sink);

  [[nodiscard]] bool finished() const noexcept { return finished_; }
  [[nodiscard]] const read::Refused& refused() const noexcept { return refusals_.last(); }
  [[nodiscard]] const State& state() const noexcept { return state_; }
  /// The last block was nothing but a straight move: of the state its position, motion and feed
  /// alone may be others than before.
  [[nodiscard]] bool moved_alone() const noexcept { return plain_before_; }
  /// The line that is read next (#<_line>).
  void at_line(std::uint32_t line) noexcept { state_.line = line; }
  /// What expressions of the program ask for. Stays valid while the interpreter is not moved.
  [[nodiscard]] Parameters& parameters() noexcept {
    parameters_->bind(state_, config_);
    return *parameters_;
  }
  /// The tool table as the program has left it; nothing where none was given.
  [[nodiscard]] const std::optional<std::vector<Tool>>& tools() const noexcept {
    return config_.tools;
  }
  /// A subprogram begins or ends: what M70 and M73 kept belongs to it.
  void enter_call();
  void leave_call(Sink& sink);
  /// A call of a drilling cycle (sinumerik); MCALL: after each block that moves, from now on.
  bool execute_cycle(const read::Block& block, Sink& sink);
  /// M98 or M99 of the block that was executed last.
  struct ProgramCall {
    enum class Kind : std::uint8_t { none, call, end } kind = Kind::none;
    std::int32_t number = 0;
    double repeats = 1.0;
  };
  [[nodiscard]] const ProgramCall& program_call() const noexcept { return program_call_; }
  /// Looks at a block's words without executing: false when a word is not in the dialect.
  bool survey(const read::Block& block);

 private:
  explicit Interpreter(Config config);

  bool decode(const read::Block& block);
  bool set_frame(const Step& step);
  bool set_fine(const read::Word& word);
  bool frame_settles(const Step& step);
  struct DrillCall;
  bool drill_call(const read::Flow& call);
  bool drill_planes(const read::Flow& call, DrillCall& hole);
  bool tap_call(const read::Flow& call, const DrillCall& hole);
  void ream_call(const read::Flow& call, const DrillCall& hole);
  void bore_call(const read::Flow& call, const DrillCall& hole);
  bool refuse_call(const read::Flow& call, std::string_view reason, std::string_view text);

  // a block of G0 or G1, F and axis words alone
  [[nodiscard]] bool is_plain(const Step& step) const noexcept;
  [[nodiscard]] bool plain_end(const Step& step, Axes& end) const noexcept;
  bool execute_plain(const Step& step, bool filled);

  // checks
  bool choose_motion(const Step& step);
  bool check(const Step& step);
  bool check_non_modal(const Step& step);
  bool check_unused(const Step& step);
  bool check_values(const Step& step);
  bool check_cutter(const Step& step);
  bool cutter_permits_what_comes_before(const Step& step);
  bool cutter_permits_what_comes_behind(const Step& step);

  // execution
  bool act(const Step& step);
  bool set_feed(const Step& step);
  bool set_spindle_speed(const Step& step);
  bool select_tool(const Step& step);
  bool change_tool(const Step& step);
  bool set_spindle(const Step& step);
  void set_coolant(const Step& step);
  bool set_override(const Step& step);
  bool set_modes(const Step& step);
  bool set_cutter(const Step& step);
  bool end_cutter(const Step& step);
  void time_by_contour();
  void read_position_anew() noexcept;
  bool cutter_tool(const Step& step, int code, CutterCompensation::Tool& tool);
  bool compensate(const Step& step, MoveKind kind, const Axes& end);
  bool cutter_fault(const Step& step, CutterCompensation::Fault fault);
  void set_units(const Step& step);
  bool set_tool_length(const Step& step);
  bool set_work_offset(const Step& step);
  bool set_path_mode(const Step& step);
  bool non_modal(const Step& step);
  bool set_data(const Step& step);
  bool set_work_data(const Step& step, double form);
  bool set_fanuc_data(const Step& step, double form);
  void place_here(const Step& step, double rotation_deg, Axes& offset) const;
  void place_tool(const Step& step, const Axes& machine, const Axes& frame, double turn_deg,
                  Tool& tool) const;
  bool set_tool_data(const Step& step, double form);
  void load_tool();
  Tool* place_of_tool(std::int32_t number);
  bool set_io(const Step& step);
  bool keep_modes(const Step& step);
  void restore_modes(const State& kept);
  bool call_program(const Step& step);
  bool set_g92(const Step& step, int code);
  bool home(const Step& step, std::size_t which);
  bool move(const Step& step);
  bool stop(const Step& step);

  // motion
  bool straight(const Step& step);
  bool thread(const Step& step);
  bool spindle_turns(const Step& step);
  void emit_thread(const Axes& end, double pitch_mm);
  struct ThreadCycle;
  bool thread_cycle(const Step& step);
  bool read_thread_cycle(const Step& step, ThreadCycle& cycle);
  bool thread_is_possible(const Step& step, const ThreadCycle& cycle);
  void thread_pass(const ThreadCycle& cycle, double depth_mm);
  bool spline(const Step& step);
  bool cubic(const Step& step);
  bool quadratic(const Step& step);
  bool control_point(const Step& step);
  bool end_spline(const Step& step);
  void emit_spline(std::span<const SplinePoint> points, int order, const Axes& end);
  bool probe(const Step& step);
  void polar_point(const Step& step, Axes& point) const;
  bool arc(const Step& step);
  bool arc_centre(const Step& step, const PlaneAxes& axes, const Axes& end, PlanePoint& centre);
  bool arc_fault(const Step& step, ArcFault fault);
  bool cycle(const Step& step);
  struct Hole;
  bool check_cycle(const Step& step);
  bool remember_cycle(const Step& step);
  bool measure_hole(const Step& step, Hole& hole);
  void go_to_hole(const Step& step, const Hole& hole, double height_mm);
  bool drill(const Step& step, const Hole& hole);
  bool peck(const Step& step, const Hole& hole);
  bool tap(const Step& step, const Hole& hole);
  bool bore(const Step& step, const Hole& hole);
  bool back_bore(const Step& step, const Hole& hole);
  bool has_feed(const Step& step);
  bool end_point(const Step& step, Axes& end);
  void machine_end(const Step& step, Axes& end);
  [[nodiscard]] bool tool_stays(std::size_t axis) const noexcept;
  double component(const Step& step, std::size_t axis) const noexcept;

  void fill(MoveKind kind, const Axes& end);
  void emit(MoveKind kind, const Axes& end);
  void emit_normal(MoveKind kind, std::size_t axis, double value);
  void emit_dwell(double seconds);
  void emit_spindle();
  void emit_event(EventKind kind, double value);
  void update_offset() noexcept;
  [[nodiscard]] Axes to_machine(const Axes& work) const noexcept;
  [[nodiscard]] Axes to_work(const Axes& machine) const noexcept;
  const Tool* find_tool(std::int32_t number) const noexcept;
  bool tool_number(const Step& step, char letter, std::int32_t& number);

  bool refuse(const Step& step, char letter, std::string_view reason, std::string_view text);
  bool refuse_code(const Step& step, char letter, int code, std::string_view reason,
                   std::string_view text);
  bool refuse_word(std::uint32_t line, const read::Word& word, std::string_view reason,
                   std::string_view text);

  /// Far beyond every machine; values above lose their meaning in the arithmetic that follows.
  static constexpr double kLargestValue = 1e7;

  Config config_;
  const DialectRules* rules_;
  State state_;
  std::unique_ptr<Parameters> parameters_ = std::make_unique<Parameters>();
  Step step_{};
  std::uint32_t axes_allowed_ = 0;  ///< mask of the axis letters that the machine has
  Move move_;
  Sink* sink_ = nullptr;
  bool plain_before_ = false;  ///< move_ has the modes of a plain block that was executed last
  int motion_now_ = -1;        ///< motion of the block in hand; −1 = none
  bool finished_ = false;
  std::array<double, 2> cubic_tangent_mm_{};  ///< P and Q of the G5 before
  bool cubic_goes_on_ = false;
  std::vector<SplinePoint> spline_points_;  ///< of G5.2
  int spline_order_ = 0;
  Axes spline_end_{};
  ProgramCall program_call_;
  std::optional<read::Flow> modal_cycle_;  ///< sinumerik MCALL
  struct KeptModes {
    std::optional<State> state;
    bool restores_itself = false;  ///< M73
  };
  std::vector<KeptModes> kept_{1};
  std::unique_ptr<CutterCompensation> cutter_ = std::make_unique<CutterCompensation>();
  /// Behind G40 the tool stands beside the point in force, until the next move.
  std::optional<Axes> beside_;
  bool arc_allowed_ = true;    ///< false from G40 to the next straight move
  double rounding_mm_ = 0.0;   ///< sinumerik ADIS in force
  std::string selected_name_;  ///< sinumerik T="NAME", until M6
  Refusals refusals_;
};

}  // namespace steadyrest::nc::interpret
