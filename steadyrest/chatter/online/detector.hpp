// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include <steadyrest/chatter/online/cut_levels.hpp>
#include <steadyrest/chatter/online/free_share.hpp>
#include <steadyrest/chatter/online/lines/line_choice.hpp>
#include <steadyrest/chatter/online/lines/line_spectrum.hpp>
#include <steadyrest/chatter/online/orders/order_filter.hpp>
#include <steadyrest/chatter/online/orders/spindle_track.hpp>
#include <steadyrest/chatter/online/revolution_spread.hpp>
#include <steadyrest/chatter/online/sensor_faults.hpp>
#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::chatter::online {

/// Detects chatter in vibration, sound, spindle power or a motion estimate, at constant and
/// modulated speed.
///
/// Law. The signal minus OrderFilter's forced part is the residual; LineSpectrum finds its lines,
/// and FreeShare gives the share φ of the strongest that neither an order nor a damped mode
/// explains. With C the energy of the lines and P that of the forced vibration,
///   energy ratio R = C/(C + P),  free ratio F = φ·R.
/// Only a spectrum whose strongest line is `line_ratio` above the noise counts. Two ways:
///   E += F − b, held within −0.1…0.2, never below 0; chatter at E ≥ 0.25. The bound b is
///   `free_ratio` while the speed moves, else 0.25, and at least 1.2 times the F that this cut has
///   shown before. (R alone means nothing there: a tooth order that sweeps over a resonance gives
///   0.9 in stable cuts.) From 0.17 s after the entry on, E ≥ 0.45 and 1.5 times the bound are
///   required: chatter mostly comes with the tool's entry, and a cut near its border lets vibration
///   grow for a while in each period of the modulation. At constant speed also: R above
///   `sure_ratio`, or above `on_ratio` with C above `margin` times the level of the present cut
///   (learnt while nothing is suspect, from `learn_s` on), in `confirm` spectra, minus those in
///   between that were not; unless F is below 0.05, the last revolution has less than 70 % of the
///   line (it dies away), or the revolution's spread is below a quarter of what a line of this
///   order and energy gives; a line whose phase has shown for 0.2 s that it is not an order does
///   not need F.
/// Vibration at an order of the spindle is forced: at constant speed the line that LineChoice
/// judges is not chatter where OrderGate cannot tell it from an order, or from the fold of one.
/// There are two exceptions. A line that alone has nine tenths of the energy, and could be an order
/// of runout only because the speed is uncertain, does not count as that order. Period doubling, at
/// half tooth orders, is claimed where the line is `margin` times as strong as all that the cut has
/// shown and R is above `sure_ratio`, while the energy of the tooth orders is what it was lately
/// (within a factor of 1.3): runout grows with the engagement, and so do they. The speed is that of
/// SpindleTrack where it is not exact (`speed_sd`). Chatter is over once R (while the speed moves,
/// F) has been below `off_ratio` (half of `free_ratio`) for a whole window. For `settle_rev`
/// revolutions after a jump of the signal's energy (the tool enters; from air, a jump of seven
/// times the spread of the noise energy counts, so that noise as loud as the cut does not hide it)
/// nothing is judged, and below 300 Hz for 30 periods of the line: what the entry has struck rings.
///
/// The frequency is that of the residual's strongest line; see LineSpectrum for its accuracy. Flip:
/// within a line's width of a half-odd tooth order; lines there are learnt as forced only in
/// OrderFilter's long memory. Otherwise Hopf. With an even number of teeth, flip chatter present
/// from the first tooth cannot be told from runout and counts as runout.
///
/// Source: Caliskan, Kilic, Altintas 2018 (Kalman filter, energy ratio); Zhao 2019 (once a
/// revolution).
class Detector {
 public:
  struct Config {
    double sample_rate_hz = 10e3;        ///< 1e3 … 50e3
    std::size_t teeth = 2;               ///< 1 … 64; 1 in turning
    std::size_t tooth_harmonics = 24;    ///< 1 … 64
    std::size_t spindle_harmonics = 40;  ///< 0 … 64
    double lowest_hz = 40.0;             ///< chatter below is not searched
    double window_s = 0.1;               ///< of the spectrum, 0.02 … 1
    double on_ratio = 0.15;              ///< off_ratio … sure_ratio
    double sure_ratio = 0.25;            ///< on_ratio … 1
    double free_ratio = 0.1;             ///< of the free vibration while the speed moves, 0 … 1
    double off_ratio = 0.07;             ///< 0 … on_ratio
    double line_ratio = 25.0;            ///< ≥ 10
    double margin = 4.0;                 ///< ≥ 1
    double least_energy = 0.0;           ///< unit²; less vibration than this is not a cut
    double learn_s = 0.25;               ///< ≥ 0
    double settle_rev = 3.0;             ///< ≥ 0
    unsigned confirm = 2;                ///< ≥ 1
    double moving_memory_rev = 0.7;      ///< of the tooth orders while the speed moves, OrderFilter
    double speed_sd = 0.0;  ///< of the speed that is told, relative, 0 … 0.02; 0: it is exact
    bool folds = false;     ///< the sensor has no filter before the samples: orders fold
  };

  struct Input {
    double value = 0.0;                                           ///< any unit
    double speed_rev_s = 0.0;                                     ///< of the spindle, now
    double angle_rev = std::numeric_limits<double>::quiet_NaN();  ///< of the spindle, rising; NaN:
                                                                  ///< the speed is integrated
  };

  enum class Kind : std::uint8_t {
    none,    ///< nothing found
    forced,  ///< repeats with the teeth
    hopf,    ///< regenerative, quasi-periodic
    flip,    ///< regenerative, period doubling
  };

  struct Output {
    bool chatter = false;
    bool fresh = false;  ///< a spectrum was judged with this sample
    Kind kind = Kind::none;
    double frequency_hz = 0.0;   ///< of the residual's line that is judged; 0 = none
    double energy_ratio = 0.0;   ///< 0 … 1
    double free_ratio = 0.0;     ///< 0 … 1, the free share of it; 0 while not known
    double spread_ratio = 0.0;   ///< 0 … 2, RevolutionSpread; 0 while not known
    double residual = 0.0;       ///< the signal minus the forced vibration
    OrderGate::Output line;      ///< the line that is judged and the order nearest to it
    double line_energy = 0.0;    ///< of all lines that can be chatter, unit²
    double forced_energy = 0.0;  ///< P, mean over about a revolution, unit²
    double speed_rev_s = 0.0;    ///< of the spindle, as its orders say
    double speed_sd = 0.0;       ///< the standard deviation of that, relative
    kernel::outcome::Reason reason = kernel::outcome::Reason::none;
  };

  [[nodiscard]] static kernel::outcome::Result<Detector> make(const Config& config);
  /// Recorders of such a rate mostly have no filter before their samples: Config::folds.
  [[nodiscard]] static constexpr bool folds_at(double sample_rate_hz) noexcept {
    return sample_rate_hz < 5e3;
  }

  /// One sample. A value that is not finite, or repeated again and again, is a gap of the sensor:
  /// the spindle turns on and the forced vibration is taken to go on. A sample with a speed or
  /// angle that is not finite, or a speed not above 0, is skipped: the output stays, with its
  /// reason, until the next good sample.
  const Output& update(const Input& input) noexcept;
  void reset() noexcept;

  [[nodiscard]] double resolution_hz() const noexcept { return spectrum_.resolution_hz(); }
  /// The sensor's largest values are cut off.
  [[nodiscard]] bool clips() const noexcept { return sensor_.clips(); }
  /// Samples in the spectrum's window.
  [[nodiscard]] std::size_t window() const noexcept { return spectrum_.length(); }

 private:
  struct State {
    double angle_rev = 0.0;
    double mean_speed_rev_s = 0.0;
    double told_rev_s = 0.0;       ///< the same of the speed that is told
    double speed_spread = 0.0;     ///< mean |Ω − mean|/mean
    double forced_energy = 0.0;    ///< P, mean over about a revolution
    double residual_energy = 0.0;  ///< the same of e²
    double tooth_energy = 0.0;     ///< of the tooth orders, the same
    double energy = 0.0;           ///< of the whole signal, mean over about a revolution
    double slow_all = 0.0;         ///< the same over some ten revolutions
    double slow_energy = 0.0;      ///< the same over some ten revolutions
    double seen_rev = 0.0;         ///< since the start, up to the memory of those
    double settled_rev = 0.0;      ///< since the cut began
    double evidence = 0.0;         ///< sum of the free ratio's excess over its bound
    std::size_t settled = 0;       ///< samples since the cut began
    double held_s = 0.0;           ///< how long the slow orders have been held
    kernel::outcome::Reason reason = kernel::outcome::Reason::none;  ///< of the last judgement
    unsigned suspects = 0;
    unsigned quiet = 0;
    bool hold = false;
    bool forced = false;  ///< the strongest line is an order
    bool opened = false;  ///< the filter, for a cut that began
    bool started = false;
  };

  Detector(const Config& config, OrderFilter filter, LineSpectrum spectrum, FreeShare share);
  [[nodiscard]] double speed_of(const Input& input) const noexcept;
  void follow_speed(const Input& input) noexcept;
  void follow_energy(const OrderFilter::Output& forced, double moving, double turn_share) noexcept;
  void judge(const FreeShare::Output& share) noexcept;
  void decide(bool steady) noexcept;
  void name(bool line, bool cuts) noexcept;
  [[nodiscard]] bool lasts() const noexcept;
  [[nodiscard]] bool suspect_steady(const FreeShare::Output& share) const noexcept;
  [[nodiscard]] double free_bound() const noexcept;
  [[nodiscard]] bool later() const noexcept;
  [[nodiscard]] double enough() const noexcept;
  [[nodiscard]] bool doubles() const noexcept;
  [[nodiscard]] bool outweighs() const noexcept;
  [[nodiscard]] bool witnessed(double line_energy, double order) const noexcept;
  [[nodiscard]] Kind kind_of(double frequency_hz) const noexcept;

  Config config_;
  OrderFilter filter_;
  LineSpectrum spectrum_;
  FreeShare share_;
  LineChoice::Output line_;  ///< for which share_ was queried
  SensorFaults sensor_;
  SpindleTrack track_;
  LineChoice choice_;
  RevolutionSpread spread_;
  RevolutionSpread::Output revolution_;
  CutLevels levels_;
  State state_;
  Output out_;
};

}  // namespace steadyrest::chatter::online
