// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <steadyrest/kernel/machine/chatter.hpp>
#include <steadyrest/passport/keys/choice.hpp>
#include <steadyrest/passport/keys/schema.hpp>

// What the layer may do: [contour], [chatter], [envelope]. One row per key: name with unit, field,
// range in the file's unit, meaning for docs/machine-file.md.
namespace steadyrest::passport {
namespace {

using kernel::machine::Chatter;
using kernel::machine::Contour;
using kernel::machine::ContourStrategy;
using kernel::machine::Envelope;
using kernel::machine::SpeedLaw;

using std::string_view;

constexpr std::array<string_view, 3> kStrategies = {"contour_priority", "feed_priority",
                                                    "combined"};

}  // namespace

std::span<const Key<Contour>> contour_keys() noexcept {
  static const std::array kKeys = {
      Key<Contour>{"enabled", &Contour::enabled, 0, 0, "Turns contour correction on."},
      Key<Contour>{"strategy", choice<Contour, &Contour::strategy>(kStrategies), 0, 0,
                   "What comes first: the smallest error, the highest feed within the limit, or a "
                   "weighted sum of both."},
      Key<Contour>{"limit_um", &Contour::limit_mm, 0.01, 1e5, "Largest contour error allowed."},
      // Below the target all feeds are equally good for contour priority, so it takes the fastest
      // of them; with 0 it creeps wherever the path is curved.
      Key<Contour>{"target_um", &Contour::target_mm, 0, 1e5,
                   "Contour priority: errors below this count as equal."},
      Key<Contour>{"min_percent", &Contour::min_ratio, 0.1, 1000,
                   "The layer never asks for less than this share of the programmed feed."},
      Key<Contour>{"max_percent", &Contour::max_ratio, 0.1, 1000,
                   "The layer never asks for more than this share of the programmed feed."},
      Key<Contour>{"weight_contour", &Contour::weight_contour, 0, 1000,
                   "Combined strategy: weight of the contour error."},
      Key<Contour>{"weight_feed", &Contour::weight_feed, 0, 1000,
                   "Combined strategy: weight of the feed."},
      Key<Contour>{"margin_percent", &Contour::margin, 0, 90,
                   "Share of the limit kept in reserve for what the model does not cover."},
  };
  return kKeys;
}

/// Amplitude, period and mean speed describe the law; the two bounds of the feed per tooth decide
/// how much of it the feed can follow without rubbing or overloading the tooth.
std::span<const Key<Chatter>> chatter_keys() noexcept {
  static const std::array kKeys = {
      Key<Chatter>{"enabled", &Chatter::enabled, 0, 0, "Allows spindle-speed modulation."},
      Key<Chatter>{"law", choice<Chatter, &Chatter::law>(kernel::machine::kSpeedLawNames), 0, 0,
                   "Shape of the modulation: square wave, pulse (up for a quarter of the period), "
                   "triangle, sine, random, a brief slow-down (`stop`), or `constant` for none."},
      Key<Chatter>{"amplitude_percent", &Chatter::amplitude_ratio, 0, 90,
                   "Swing to either side of the mean speed. Either this or `amplitude_rpm`."},
      Key<Chatter>{"amplitude_rpm", &Chatter::amplitude_rev_s, 0, 1e5,
                   "The same in rev/min; 0 = use `amplitude_percent`."},
      Key<Chatter>{"period_s", &Chatter::period_s, 0.02, 600, "Period of the modulation."},
      Key<Chatter>{"mean_percent", &Chatter::mean_ratio, 10, 200,
                   "Mean speed as a share of the programmed one."},
      Key<Chatter>{"feed_per_tooth_min_percent", &Chatter::min_feed_per_tooth_ratio, 1, 100,
                   "Smallest feed per tooth, as a share of the programmed one; limits how far the "
                   "speed may rise."},
      Key<Chatter>{"feed_per_tooth_max_percent", &Chatter::max_feed_per_tooth_ratio, 100, 1000,
                   "Largest feed per tooth, as a share of the programmed one; when the spindle "
                   "slows down, the feed follows."},
      Key<Chatter>{
          // Programs choose where to modulate: Haas lathes use M38 and M39 for it.
          "m_code_on", &Chatter::m_code_on, 0, 9999,
          "M word that turns the modulation on; 0 = always on, whatever the program says."},
      Key<Chatter>{"m_code_off", &Chatter::m_code_off, 0, 9999, "M word that turns it off."},
      Key<Chatter>{"seed", &Chatter::seed, 0, 9007199254740992.0, "Seed of the random law."},
  };
  return kKeys;
}

/// Fall and rise have separate rates: taking feed away is urgent, giving it back is not.
std::span<const Key<Envelope>> envelope_keys() noexcept {
  static const std::array kKeys = {
      Key<Envelope>{"min_feed_percent", &Envelope::min_feed_ratio, 0, 1000,
                    "Smallest feed override ever written."},
      Key<Envelope>{"max_feed_percent", &Envelope::max_feed_ratio, 1, 1000,
                    "Largest feed override ever written."},
      Key<Envelope>{"feed_fall_percent_s", &Envelope::feed_fall_1_s, 0.1, 1e6,
                    "How fast the feed override may fall."},
      Key<Envelope>{"feed_rise_percent_s", &Envelope::feed_rise_1_s, 0.1, 1e6,
                    "How fast the feed override may rise."},
      Key<Envelope>{"min_spindle_percent", &Envelope::min_spindle_ratio, 0, 1000,
                    "Smallest spindle override ever written."},
      Key<Envelope>{"max_spindle_percent", &Envelope::max_spindle_ratio, 1, 1000,
                    "Largest spindle override ever written."},
      Key<Envelope>{"spindle_slew_percent_s", &Envelope::spindle_slew_1_s, 0.1, 1e6,
                    "How fast the spindle override may change."},
      // A wrong sign or a broken sensor must not move an axis further than this.
      Key<Envelope>{"max_offset_um", &Envelope::max_offset_mm, 0, 10000,
                    "Largest axis offset ever written."},
      Key<Envelope>{"offset_slew_um_s", &Envelope::offset_slew_mm_s, 0.001, 1e6,
                    "How fast an axis offset may change."},
      Key<Envelope>{"max_path_offset_um", &Envelope::max_path_offset_mm, 0, 10000,
                    "Largest offset that takes the contour error away, thermal offset included; "
                    "0 = the control takes none."},
      Key<Envelope>{"path_offset_slew_um_s", &Envelope::path_offset_slew_mm_s, 1, 1e7,
                    "How fast that offset may change."},
      Key<Envelope>{"stale_after_ms", &Envelope::stale_after_s, 0.1, 60000,
                    "Input older than this is not acted on."},
      Key<Envelope>{"late_hold_ms", &Envelope::late_hold_s, 20, 10000,
                    "LinuxCNC keeps the layer's feed and spindle for this long after its last "
                    "heartbeat; only then do they return to the panel's, by the slower of "
                    "`feed_rise` and `spindle_slew`. Other ports have times of their own: "
                    "`dead_man_ms`, `dropped_after_ms`, `watchdog_ms`."},
  };
  return kKeys;
}

string_view word(ContourStrategy strategy) noexcept {
  return pick(kStrategies, strategy);
}
string_view word(SpeedLaw law) noexcept {
  return pick(kernel::machine::kSpeedLawNames, law);
}

}  // namespace steadyrest::passport
