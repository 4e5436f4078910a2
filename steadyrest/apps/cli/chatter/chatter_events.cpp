// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include <steadyrest/apps/cli/chatter/chatter_events.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::apps::cli {
namespace {

namespace online = chatter::online;

/// Gathers the spectra of one stretch of chatter: from the spectrum that raised the alarm to the
/// first one that is quiet again.
class Stretch {
 public:
  explicit Stretch(double start_s) : start_s_(start_s) {}

  void add(const online::Detector::Output& heard, double speed_rev_s) {
    frequency_hz_.push_back(heard.frequency_hz);
    flips_ += heard.kind == online::Detector::Kind::flip ? 1 : 0;
    speeds_rev_s_ += speed_rev_s;
  }

  // The median frequency, because a spectrum now and then locks onto a side line of the chatter (fc
  // ± k tooth frequencies) and one such reading would pull a mean off. The kind goes by majority
  // for the same reason: flip is judged within one line width and flickers near its edge.
  [[nodiscard]] ChatterEvent finished(double end_s) {
    const auto half = static_cast<std::ptrdiff_t>(frequency_hz_.size() / 2);
    std::ranges::nth_element(frequency_hz_, frequency_hz_.begin() + half);
    ChatterEvent event;
    event.start_s = start_s_;
    event.end_s = end_s;
    event.frequency_hz = frequency_hz_[static_cast<std::size_t>(half)];
    event.speed_rev_s = speeds_rev_s_ / static_cast<double>(frequency_hz_.size());
    event.flip = 2 * flips_ > frequency_hz_.size();
    return event;
  }

 private:
  double start_s_;
  std::vector<double> frequency_hz_;
  std::size_t flips_ = 0;
  double speeds_rev_s_ = 0.0;
};

/// The spindle turns on where samples are missing. The detector passes over those and would not see
/// it turn, so the angle comes from here; without gaps it counts for itself.
class GapAngle {
 public:
  explicit GapAngle(const chatter::offline::RecordedSignal& signal)
      : signal_(signal),
        gaps_(std::ranges::any_of(signal.value, unknown) ||
              std::ranges::any_of(signal.speed_rev_s, unknown)) {}

  /// Once for each sample, in order; NaN: the detector's own.
  double at(std::size_t i) {
    const double speed = signal_.speed_rev_s[i];
    speed_rev_s_ = std::isfinite(speed) ? speed : speed_rev_s_;
    angle_rev_ += i == 0 ? 0.0 : speed_rev_s_ / signal_.rate_hz;
    return gaps_ ? angle_rev_ : std::numeric_limits<double>::quiet_NaN();
  }

 private:
  static bool unknown(double value) { return !std::isfinite(value); }

  const chatter::offline::RecordedSignal& signal_;
  bool gaps_;
  double speed_rev_s_ = 0.0;
  double angle_rev_ = 0.0;
};

}  // namespace

std::vector<ChatterEvent> chatter_events(const chatter::offline::RecordedSignal& signal,
                                         chatter::online::Detector& detector, Progress& progress) {
  // Samples between two updates of the bar: a few seconds of signal, microseconds of bookkeeping.
  constexpr std::size_t kBetweenUpdates = 65536;
  const std::size_t samples = signal.value.size();
  GapAngle angle(signal);
  std::vector<ChatterEvent> out;
  std::optional<Stretch> open;
  double t_s = signal.start_s;
  for (std::size_t i = 0; i < samples; ++i) {
    t_s = signal.start_s + static_cast<double>(i) / signal.rate_hz;
    // The detector judges one spectrum per hop of samples. Only `fresh` outputs are new readings;
    // the samples between them repeat the last verdict and must not be counted again.
    const auto& heard = detector.update(
        {.value = signal.value[i], .speed_rev_s = signal.speed_rev_s[i], .angle_rev = angle.at(i)});
    if (heard.fresh && heard.chatter) {
      if (!open) {
        open.emplace(t_s);
      }
      open->add(heard, signal.speed_rev_s[i]);
    } else if (heard.fresh && open) {
      out.push_back(open->finished(t_s));
      open.reset();
    }
    if (i % kBetweenUpdates == 0) {
      progress.update(static_cast<double>(i) / static_cast<double>(samples), "listening");
    }
  }
  // A recording may end while the cut still chatters.
  if (open) {
    out.push_back(open->finished(t_s));
  }
  for (ChatterEvent& event : out) {
    event.channels = {signal.channel};
  }
  return out;
}

std::vector<double> lobes_rpm(const online::SpeedTable::Config& reach, double programmed_rev_s,
                              double frequency_hz) {
  const double least = std::max(reach.min_rev_s, reach.min_ratio * programmed_rev_s);
  const double most = std::min(reach.max_rev_s, reach.max_ratio * programmed_rev_s);
  const double first = frequency_hz / static_cast<double>(reach.teeth);
  std::vector<double> out;
  for (double k = std::max(1.0, std::ceil(first / most)); first / k >= least && least > 0.0; ++k) {
    out.push_back(kernel::units::rpm_from_rev_s(first / k));
  }
  return out;
}

}  // namespace steadyrest::apps::cli
