// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <steadyrest/contour/online/contour_error.hpp>
#include <steadyrest/contour/online/estimate/reserve.hpp>
#include <steadyrest/contour/online/forecast.hpp>
#include <steadyrest/contour/online/look_ahead.hpp>
#include <steadyrest/contour/online/nominal_error.hpp>
#include <steadyrest/contour/online/precompensator.hpp>
#include <steadyrest/contour/online/search/objective_search.hpp>
#include <steadyrest/contour/online/servo_model.hpp>
#include <steadyrest/kernel/machine/axis.hpp>
#include <steadyrest/kernel/machine/contour.hpp>
#include <steadyrest/kernel/machine/control.hpp>
#include <steadyrest/kernel/machine/envelope.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/machine/override_table.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/signal/frame.hpp>
#include <steadyrest/kernel/signal/in_force.hpp>
#include <steadyrest/kernel/signal/request.hpp>

namespace steadyrest::contour::online {

/// One step of the override as the objective sees it.
struct Candidate {
  double ratio = 1.0;
  double error_mm = 0.0;   ///< predicted largest |ε| while it is held
  double limit_mm = 0.01;  ///< ε_max
  double min_ratio = 0.1;  ///< v_min, v_max as ratios of the programmed feed
  double max_ratio = 1.0;
  double weight_contour = 0.5;
  double weight_feed = 0.5;
};

/// J = w1·ε/ε_max + w2·(v_max − v)/(v_max − v_min), smaller is better.
[[nodiscard]] double combined_objective(const Candidate& candidate) noexcept;

/// Chooses the feed override step that keeps the contour error within its limit, by forecast.
///
/// Each candidate step is simulated along the path ahead (Forecast): the control's speed under dead
/// time, scan and slew, then the axes with the identified servo model, then the distance to the
/// path.
///
/// Strategies:
///   contour priority  the lowest predicted error, with all errors up to `target_mm` equal; then
///                     the fastest. Since ε grows with v it ends at the lowest step wherever no
///                     step reaches the target
///   feed priority     the largest admissible step
///   combined          the step with the smallest J, or the largest admissible one below it
///
/// Admissible: "go to the step, hold it for one decision, then fall to the lowest step as fast as
/// the slew permits" keeps |ε| ≤ ε_max·(1 − margin) − reserve all the way. The fall can thus always
/// wait until the next decision and no longer: neither late nor early. The search for the largest
/// admissible step starts from the highest and assumes nothing about the order of their errors; in
/// tables of more than 32 steps it starts from the step in force, in doubling strides and then by
/// halves (step_search.hpp). Where even the fall does not keep the limit, each place may have the
/// error that the fall alone gives there, also while the step is held for one time constant 1/k.
///
/// Steady state: a slow servo would permit too large a step for a moment, again and again. A rise
/// must therefore also be sustainable: held for `pause_s` it must not break the limit within the
/// present stretch of even curvature. A break in a later, tighter stretch does not count, since the
/// fall comes first.
///
/// The limit used, ε_max·(1 − margin) − reserve, is the Reserve's (estimate/reserve.hpp). Changes:
/// a rise needs 2 % room (15 % within `pause_s` after a fall); a fall is immediate. The governor
/// only plans with the slew limits; the kernel's envelope enforces them. The frame brings what the
/// envelope let pass: every plan starts there, and the words of the last cycles are those still
/// under way.
///
/// A text that corrects the path (Frame::original): the error shown is that against the original.
/// Where a segment is `by_text`, feed and offsets are the text's own, from so long before that the
/// override is back at 1 and settled, until the tool has left it; between, the governor works as
/// ever. With an original that is not known it shows no error and asks for nothing.
///
/// Withdraws (ratio 1): input not finite or stale, threading and tapping, no cutting within reach
/// ahead, a path that the text corrects. Bounded: a search stops once its forecasts have used
/// `work_share` of a control cycle, at kForecastStepCostS for each of their steps. The search for
/// the admissible step then takes the largest one known and the next decision continues from there;
/// the objective's search resumes with the next decision. One look, and the fall with one look
/// along it, are always made: most_forecast_steps() has the bound. See
/// bench/contour_decision_bench.
///
/// Source: Jin, Zhang, Ding (strategies, exhaustive search). The admissibility rule is this
/// project's.
class FeedGovernor {
 public:
  static constexpr std::size_t kHistory = 1024;

  /// How preview() has a step taken.
  enum class Look : std::uint8_t {
    change,  ///< as a decision tries it: go there, hold it for one decision, fall to the lowest
    held,    ///< in force from now on, whatever the panel says; judged once that has settled
  };

  struct Config {
    std::vector<kernel::machine::Axis> axes;  ///< X, Y, Z first
    kernel::machine::OverrideTable feed_override;
    kernel::machine::Contour contour;
    kernel::machine::Envelope envelope;  ///< of the feed, and the age limit of a frame
    kernel::machine::Control control;    ///< its limit along the path
    double cycle_s = 0.0;                ///< between two updates; 0 = the interpolator's period
    double decision_s = 0.0;             ///< 0 = the override's scan period, 4…10 ms
    double objective_s = 0.10;           ///< period of the full search of the other strategies
    double pause_s = 0.3;                ///< after a fall; rises then need more room
    double work_share = 0.1;             ///< share of a control cycle for one search
    std::size_t exhaustive_steps = 32;   ///< tables up to this size are searched in full
    double forecast_step_s = 0.0;        ///< 0 = 0.12/k of the stiffest axis, at most 4 ms
    double path_offset_delay_s = 0.0;    ///< of the port
    double path_offset_acceleration_mm_s2 = 0.0;  ///< likewise; 0: no limit
    double (*objective)(const Candidate&) noexcept = combined_objective;

    /// These sections of a passport, the rest with the defaults above.
    static Config of(const kernel::machine::Machine& machine);
  };

  struct Output {
    kernel::signal::FeedRequest request;
    kernel::signal::OffsetRequest path_offset;  ///< of the precompensator
    bool error_valid = false;                   ///< there is one, and it is the part's: no rapid's
    double error_mm = 0.0;                      ///< contour error now, signed as in ContourError;
                                                ///< against the original where the text corrects
    double nominal_error_mm = 0.0;              ///< Ed
    double predicted_error_mm = 0.0;            ///< largest with the chosen step, signed (+ inside)
    double predicted_at_mm = 0.0;               ///< path length where
    double limit_mm = 0.0;       ///< used by the decision: ε_max·(1 − margin) − reserve
    std::size_t step = 0;        ///< index in the override table
    double advised_ratio = 1.0;  ///< the request; where nothing is written, what would be in
                                 ///< force by now if it were
    double pace = 1.0;           ///< time of the decisions per time of the frames: Shadow
    bool path_known = false;
    bool decided = false;              ///< a decision was made in this cycle
    std::uint32_t forecasts = 0;       ///< used by the decision
    std::uint32_t forecast_steps = 0;  ///< of all of them
  };

  /// The course that the machine would take if the layer acted. Where nothing is written the
  /// decisions start from it, for an error that nobody holds down says nothing of them.
  struct Shadow {
    /// What the control would have been told `back` cycles ago, in the shadow's time.
    [[nodiscard]] double told(std::size_t back) const noexcept;

    bool on = false;
    double lead_s = 0.0;    ///< its time less the machine's: it takes longer for the same path
    double step_s = 0.0;    ///< of its time in the last cycle
    double ratio = 1.0;     ///< that the envelope would have let through
    double untold_s = 0.0;  ///< since its last word
    std::array<double, kHistory> word{};
    std::size_t at = 0;
    Outset outset;  ///< where it is, at the machine's place on the path
  };

  /// The course of the decisions.
  struct Course {
    Shadow shadow;
    bool started = false;
    double time_s = 0.0;
    double next_decision_s = 0.0;
    double next_objective_s = 0.0;
    double in_force_ratio = 1.0;  ///< what the envelope has let through
    bool offsets_act = false;     ///< what is asked for goes to the machine, or is shown
    bool offsets_follow = true;   ///< slow ones follow what cancels the error, else 0
    double fallen_s = -1e9;       ///< time of the last fall
    double hold_s = 0.0;          ///< that the last decision's step was tried with
    double wanted_ratio = 1.0;    ///< of the objective's last search
    ObjectiveSearch objective;
    double idle_effect_s = 0.0;  ///< how long the speed has ignored the override
    bool engaged = false;
    Output last;
    std::array<double, 3> velocity_mm_s{};  ///< observer of the axes' velocity
    bool observed = false;
    kernel::signal::Point table_mm{};  ///< behind the motors by the play of the backlash
    ServoState modelled;               ///< the model alone, never corrected
    std::array<double, 3> command_mm{};
    std::array<double, 3> command_mm_s{};
    double speed_mm_s = 0.0;
    std::size_t foot_cell = 0;
    std::size_t command_cell = 0;
  };

  /// Everything that update() changes, including the parts' own state.
  struct State : Course {
    ContourError::State contour;
    ContourError::State original;
    ServoModel::State servo;
    CommandedCurve::State curve;
    LookAhead::State ahead;
    Precompensator::State precompensator;
    Reserve::State reserve;
    std::array<AxisModel, 3> model{};  ///< that the forecast has been set to
    double cycle_s = 0.0;
    std::array<double, kHistory> history{};  ///< what the control was told, by cycle
    std::size_t history_at = 0;
  };

  static kernel::outcome::Result<FeedGovernor> make(const Config& given);
  static kernel::outcome::Result<FeedGovernor> make(const kernel::machine::Machine& machine);

  /// One cycle. The request remains in force until the next call. `unfit`: why the frame must not
  /// be acted on; nothing is learnt from it either.
  Output update(const kernel::signal::Frame& frame, const kernel::signal::InForce& in_force,
                kernel::outcome::Reason unfit = kernel::outcome::Reason::none) noexcept;

  /// The different ratios of the table's steps, Forecast::kMaxTable at most.
  [[nodiscard]] std::span<const double> steps() const noexcept { return table_ratio_; }
  /// A decision would be made from a known path: preview() has something to look at.
  [[nodiscard]] bool previews() const noexcept { return state_.engaged && state_.last.path_known; }
  /// The largest contour error ahead with this ratio, mm, signed as Output::predicted_error_mm; of
  /// the last update() and its frame. One forecast, in the cycle or not; it changes nothing, so
  /// decisions are the same with and without it. Empty: no previews(), or the path is not known far
  /// enough.
  [[nodiscard]] std::optional<double> preview(const kernel::signal::Frame& frame, double ratio,
                                              Look look) const noexcept;

  [[nodiscard]] const ContourError& contour_error() const noexcept { return contour_; }
  [[nodiscard]] const ServoModel& servo_model() const noexcept { return servo_; }
  [[nodiscard]] const Course& course() const noexcept { return state_; }
  [[nodiscard]] State state() const;
  /// From one made from the same config. The path's storage must be the same, or the path ahead is
  /// rebuilt.
  void restore(const State& state) noexcept;
  /// No decision takes more: what the share allows, the look in progress (two forecasts), the fall
  /// and one look along it; with an objective also its share and the look in progress there; with
  /// offsets of limited acceleration also the two forecasts that say whether they follow.
  [[nodiscard]] std::size_t most_forecast_steps() const noexcept;
  void reset() noexcept;

 private:
  static constexpr double kSameRatio = 1e-9;

  struct Choice {
    std::size_t candidate = 0;
    Forecast::Result forecast;
    double hold_s = 0.0;  ///< of that forecast
    bool floor = false;
    bool held_back = false;  ///< by the room that a rise needs
  };

  FeedGovernor(const Config& config, const ContourError& contour, const ServoModel& servo,
               Precompensator precompensator);
  [[nodiscard]] kernel::outcome::Result<void> check_reach() const;
  std::optional<kernel::signal::Point> run_model(const kernel::signal::Frame& frame,
                                                 double dt) noexcept;
  void observe(const kernel::signal::Frame& frame, const ContourError::Output& error,
               double dt) noexcept;
  void refresh_model(double dt) noexcept;
  void watch_effect(const kernel::signal::Frame& frame, double dt) noexcept;
  void remember(const kernel::signal::InForce& in_force) noexcept;
  [[nodiscard]] double acting_ratio() const noexcept;
  void begin_shadow(const kernel::signal::Frame& frame) noexcept;
  [[nodiscard]] double panel_limit(const kernel::signal::Frame& frame) const noexcept;
  double carry_shadow(const kernel::signal::Frame& frame, double dt) noexcept;
  void tell_shadow(const kernel::signal::Frame& frame, double step_s) noexcept;
  void follow_shadow(const kernel::signal::Frame& frame, const kernel::signal::InForce& in_force,
                     double dt) noexcept;
  [[nodiscard]] double shadow_share(const kernel::signal::Frame& frame) const noexcept;
  /// The time of the decisions.
  [[nodiscard]] double course_s() const noexcept { return state_.time_s + state_.shadow.lead_s; }
  /// Until the next decision.
  [[nodiscard]] double next_in_s() const noexcept {
    return std::max(decision_s_, state_.shadow.step_s);
  }
  bool look(const kernel::signal::Frame& frame, const ContourError::Output& error) noexcept;
  [[nodiscard]] bool is_by_text(const kernel::signal::Frame& frame) const noexcept;
  void measure(const kernel::signal::Frame& frame, const ContourError::Output& own,
               Output& output) noexcept;
  void cancel(const kernel::signal::Frame& frame, double dt, bool by_text, Output& output) noexcept;
  void extrapolate(const kernel::signal::Frame& frame) noexcept;
  [[nodiscard]] bool cutting_within_reach(const kernel::signal::Frame& frame) const noexcept;
  void fill_pending(const kernel::signal::Frame& frame, Forecast& into) const noexcept;
  [[nodiscard]] RatioPlan held_plan(double ratio, double known_s) const noexcept;
  [[nodiscard]] Outset outset(const kernel::signal::Frame& frame) const noexcept;
  [[nodiscard]] Outset machine(const kernel::signal::Frame& frame) const noexcept;
  void choose_offsets(Outset& outset, Output& output) noexcept;
  [[nodiscard]] double stretch_end_mm(const LookAhead& path, const Outset& outset) const noexcept;
  struct Search;
  Choice largest_admissible(const Outset& outset, std::size_t top, Output& output) noexcept;
  void look_for_objective(const Outset& outset, Output& output) noexcept;
  [[nodiscard]] std::size_t wanted_candidate(const Outset& outset, Output& output) noexcept;
  [[nodiscard]] std::size_t reachable_candidate(std::size_t wanted) const noexcept;
  [[nodiscard]] kernel::outcome::Reason reason(const Choice& choice, bool no_effect, bool falls,
                                               std::size_t wanted) const noexcept;
  void request(const kernel::signal::Frame& frame, bool by_text, Output& output) noexcept;
  void decide(const kernel::signal::Frame& frame, Output& output) noexcept;
  Output withdraw(kernel::outcome::Reason reason, Output output) noexcept;
  Output pause(kernel::outcome::Reason reason, const kernel::signal::Frame& frame,
               double dt) noexcept;
  /// Times within one movement; beyond, the machine may have done anything.
  [[nodiscard]] static bool is_step(double dt) noexcept { return dt > 0.0 && dt < 0.1; }

  Config config_;
  std::vector<double> candidate_;        ///< permitted ratios, ascending
  std::vector<std::size_t> table_step_;  ///< their steps in the table
  std::vector<double> table_ratio_;
  ContourError contour_;
  ContourError original_;  ///< the same against the path that the text corrects
  ServoModel servo_;
  CommandedCurve curve_;
  LookAhead ahead_;
  Precompensator precompensator_;
  Reserve reserve_;
  LookAhead guess_;  ///< the path extrapolated, where none is known
  Forecast forecast_;
  Forecast::Trace trace_;
  std::array<AxisModel, 3> model_{};      ///< the present model of forecast_
  std::array<AxisStep, 3> cycle_step_{};  ///< of one control cycle
  double cycle_s_ = 0.0;
  double softest_gain_1_s_ = 50.0;
  std::array<double, 3> half_backlash_mm_{};
  double decision_s_ = 0.01;
  std::size_t search_steps_ = 0;            ///< of the forecasts of one search, by `work_share`
  double reach_s_ = 0.1;                    ///< how far ahead in time the path must be known
  double back_s_ = 1.0;                     ///< until the override is back at 1 and settled
  std::array<double, kHistory> history_{};  ///< what the control was told, by cycle
  std::size_t history_at_ = 0;
  Course state_;
};

}  // namespace steadyrest::contour::online
