// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <steadyrest/chatter/online/recent_words.hpp>
#include <steadyrest/chatter/online/speed_law.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/override/table.hpp>
#include <steadyrest/kernel/signal/frame.hpp>
#include <steadyrest/kernel/signal/in_force.hpp>
#include <steadyrest/kernel/signal/request.hpp>

namespace steadyrest::chatter::online {

/// What may change while the modulator runs.
struct Modulation {
  Law law = Law::triangle;
  double amplitude_ratio = 0.1;  ///< RVA, of the mean speed, 0 … 0.9
  double amplitude_rev_s = 0.0;  ///< the same as a speed, rev/s ≥ 0; 0 = use `amplitude_ratio`
  double period_s = 2.0;         ///< s, 0.02 … 600
  double mean_ratio = 1.0;       ///< of the programmed speed, 0.1 … 2
  std::uint64_t seed = 1;        ///< of the random law

  friend bool operator==(const Modulation&, const Modulation&) = default;
};

/// Modulates the spindle speed by a law, through the steps of its override switch.
///
/// Law, S the shape with mean 0 (SpeedLaw), n the programmed speed, m the mean ratio, A the
/// amplitude (RVA·m, or amplitude/n), g the fade, r what was in force when it began (1 on its way
/// out):
///   φ̇ = 1/period while it is active: a change of anything never makes the phase jump
///   goal = r + g·(m + A·S(φ) − r), ġ = ±1/fade;  m is moved, then A narrowed, to fit the limits
///   ratio follows the goal by at most (a/n)·Δt, a the drive's acceleration
///   step: the nearest one within the limits, held until another is nearer by `hysteresis` of the
///   way between them
/// Limits: [min_ratio, max_ratio], the speeds of the spindle, the operator's switch unless the
/// layer may exceed it, and (largest feed)/min_feed_per_tooth.
///
/// Requests are wishes: the envelope decides how fast they take effect, and the frame reports the
/// result so far.
///
/// Feed per tooth q = feed ratio ÷ speed ratio, of the programmed one; band [q₁, q₂].
///   feed ≤ q₂·min(goal from now to one feed delay ahead, actual speed, the step requested of the
///   spindle, the words sent to its control within the last 1.5 delays), a step of the feed's
///   table: the feed falls before the spindle and rises after it, and does not rise while a lower
///   speed is still on its way;
///   speed ≥ (feed that the machine shows, that is requested, or that was sent and is still to
///   come)/q₂: the spindle waits for the feed, and where the feed cannot follow (M49, no override)
///   the swing ends there; where the layer may exceed the panel the feed is also raised to
///   q₁·(actual speed).
/// Where the operator or another room lowers the feed, q falls below q₁: their decision. Feed per
/// revolution follows the spindle by itself and is left alone.
///
/// Active while the tool cuts, the spindle turns and the program (or the setting) asks for it; a
/// constant speed also between cuts, so that the tool enters with it. Otherwise it fades and is
/// then neutral; in threads and taps and on unfit input it is neutral at once and the envelope
/// returns the override. O(log steps) per cycle, noexcept, without allocation.
///
/// Accuracy: the swing has the steps of the table; a step acts a scan and a dead time late. Stale
/// control data (`age`) is not checked here: the supervisor withdraws the request. Sources:
/// Zelinskiy, Natalchishin 2014 (override switch, laws); Seguy et al. 2010 (RVA, RVF).
class Modulator {
 public:
  struct Config {
    Modulation modulation;
    kernel::machine::OverrideTable spindle_table;  ///< at least two steps within the limits
    kernel::machine::OverrideTable feed_table;     ///< empty: the feed cannot follow
    double min_ratio = 0.5;                        ///< > 0; of the programmed speed
    double max_ratio = 1.2;
    double min_rev_s = 0.0;  ///< of the spindle
    double max_rev_s = kernel::machine::kUnlimited;
    double acceleration_rev_s2 = kernel::machine::kUnlimited;  ///< of the drive, > 0
    double min_feed_per_tooth_ratio = 0.8;                     ///< (0, 1]
    double max_feed_per_tooth_ratio = 1.2;                     ///< ≥ 1
    double min_feed_ratio = 0.0;  ///< of the envelope; the feed request never goes below it
    double max_feed_ratio = 1.2;
    double fade_s = 0.5;      ///< s, > 0
    double hysteresis = 0.1;  ///< 0 … 0.5 of the way between two steps
    double max_step_s = 0.1;  ///< s, > 0: longer gaps between two cycles count as this
    bool always = false;      ///< whatever the program says
  };

  struct Output {
    kernel::signal::SpindleRequest spindle;
    kernel::signal::FeedRequest feed{.room = kernel::signal::Room::chatter};
    double phase = 0.0;       ///< in periods, [0, 1)
    double fade = 0.0;        ///< g
    double goal_ratio = 1.0;  ///< before drive and steps
    double ratio = 1.0;       ///< before the steps
    double mean_ratio = 1.0;  ///< as it fits into the limits
    double amplitude_ratio = 0.0;
    double feed_per_tooth_ratio = 1.0;  ///< feed in force ÷ actual speed, as far as shown
    bool active = false;
  };

  /// Plain values, for logging and restoring.
  struct State {
    Modulation modulation;
    bool started = false;
    double time_s = 0.0;
    double phase = 0.0;
    double fade = 0.0;
    double fades_from = 1.0;  ///< r
    double ratio = 1.0;
    std::size_t step = 0;
    std::size_t feed_step = 0;
    RecentWords coming_feed;     ///< sent to the control, may not act yet
    RecentWords coming_spindle;  ///< the same for the spindle
    bool stepped = false;        ///< `step` is requested
    bool fed = false;            ///< `feed_step` is requested
  };

  /// Refuses invalid tables, fewer than two steps within the limits, and values outside the ranges
  /// above.
  [[nodiscard]] static kernel::outcome::Result<Modulator> make(const Config& config);
  /// From the sections [chatter], [spindle], [envelope] and the override tables.
  [[nodiscard]] static kernel::outcome::Result<Modulator> make(
      const kernel::machine::Machine& machine);

  /// One cycle.
  Output update(const kernel::signal::Frame& frame,
                const kernel::signal::InForce& in_force) noexcept;

  /// New settings from now on; false, and nothing changes, when one is out of range.
  [[nodiscard]] bool change(const Modulation& modulation) noexcept;

  void reset() noexcept;
  [[nodiscard]] const State& state() const noexcept { return state_; }
  /// An unfit state is ignored: the modulator starts over.
  void restore(const State& state) noexcept;

 private:
  using Table = kernel::override::Table;

  struct Limits {
    double low = 0.5;
    double high = 1.2;
  };
  struct Swing {
    double mean = 1.0;
    double amplitude = 0.0;
    bool narrowed = false;
  };

  Modulator(const Config& config, Table spindle, std::optional<Table> feed);
  [[nodiscard]] kernel::outcome::Reason fault_of(const kernel::signal::Frame& frame) const noexcept;
  [[nodiscard]] bool wanted(const kernel::signal::Frame& frame) const noexcept;
  [[nodiscard]] Limits limits(const kernel::signal::Frame& frame) const noexcept;
  [[nodiscard]] Swing swing(const Limits& limits, double speed_rev_s) const noexcept;
  void begin_to_leave(const Swing& swing) noexcept;
  [[nodiscard]] double goal(const Swing& swing, double phase) const noexcept;
  [[nodiscard]] double lowest_goal_ahead(const Swing& swing) const noexcept;
  [[nodiscard]] double feed_in_force(const kernel::signal::Frame& frame) const noexcept;
  void note_words(const kernel::signal::InForce& in_force) noexcept;
  void choose_step(double ratio, const Limits& limits, double floor) noexcept;
  void ask_spindle(const kernel::signal::Frame& frame, const Limits& limits, const Swing& swing,
                   bool late, Output& output) noexcept;
  void ask_feed(const kernel::signal::Frame& frame, double ahead, Output& output) noexcept;
  Output withdraw(kernel::outcome::Reason reason) noexcept;

  Config config_;
  Table spindle_;
  std::optional<Table> feed_;
  SpeedLaw law_;
  std::size_t lowest_ = 0;  ///< steps of the spindle's table within the limits
  std::size_t highest_ = 0;
  double feed_top_ratio_ = 1.0;  ///< the feed can go as high as this
  double feed_delay_s_ = 0.0;    ///< scan and dead time
  double spindle_delay_s_ = 0.0;
  State state_;
};

}  // namespace steadyrest::chatter::online
