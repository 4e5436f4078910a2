// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include <steadyrest/apps/cli/chatter/chatter_events.hpp>
#include <steadyrest/chatter/online/line_evidence.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::apps::cli {
namespace {

namespace online = chatter::online;

/// Gathers the spectra of one stretch of chatter: from the spectrum that raised the alarm to the
/// first one that is quiet again.
class Stretch {
 public:
  explicit Stretch(double start_s) : start_s_(start_s) {}

  void add(const online::Detector::Output& heard, double told_rev_s) {
    frequency_hz_.push_back(heard.frequency_hz);
    const bool flip = heard.kind == online::Detector::Kind::flip;
    flips_ += flip ? 1 : 0;
    speeds_rev_s_ += told_rev_s;
    spindle_rev_s_ += heard.speed_rev_s;
    confidence_.add(heard);
    line_energy_ += heard.line_energy;
    lines_.push_back(heard.line);
  }

  // The median frequency, because a spectrum now and then locks onto a side line of the chatter (fc
  // ± k tooth frequencies) and one such reading would pull a mean off. The kind goes by majority
  // for the same reason: flip is judged within one line width and flickers near its edge.
  [[nodiscard]] ChatterEvent finished(double end_s, std::size_t channel) {
    const auto half = static_cast<std::ptrdiff_t>(frequency_hz_.size() / 2);
    std::ranges::nth_element(frequency_hz_, frequency_hz_.begin() + half);
    const auto count = static_cast<double>(frequency_hz_.size());
    ChatterEvent event;
    event.start_s = start_s_;
    event.end_s = end_s;
    event.frequency_hz = frequency_hz_[static_cast<std::size_t>(half)];
    event.speed_rev_s = speeds_rev_s_ / count;
    event.spindle_rev_s = spindle_rev_s_ / count;
    event.line_energy = line_energy_ / count;
    event.flip = 2 * flips_ > frequency_hz_.size();
    event.channels = {channel};
    // Of the spectra the one whose line is nearest to the median.
    const auto& line = *std::ranges::min_element(
        lines_, {}, [&](const auto& of) { return std::abs(of.frequency_hz - event.frequency_hz); });
    event.evidence = {{.channel = channel,
                       .start_s = start_s_,
                       .frequency_hz = event.frequency_hz,
                       .from_order_hz = line.off_hz,
                       .from_order_sd_hz = line.sd_hz,
                       .order = static_cast<std::size_t>(line.order),
                       .folded = line.folded,
                       .confidence = confidence_.value()}};
    return event;
  }

 private:
  double start_s_;
  std::vector<double> frequency_hz_;
  std::vector<online::OrderGate::Output> lines_;
  std::size_t flips_ = 0;
  double speeds_rev_s_ = 0.0;
  double spindle_rev_s_ = 0.0;
  double line_energy_ = 0.0;
  online::LineConfidence confidence_;
};

/// The speed by the orders, as long as they show it.
class FoundSpeed {
 public:
  void add(const online::Detector::Output& heard, double told_rev_s) {
    if (online::shows_speed(heard)) {
      told_ += told_rev_s;
      found_ += heard.speed_rev_s;
      variance_ += heard.speed_sd * heard.speed_sd;
      ++shown_;
    }
  }
  void put(HeardChannel& out) const {
    if (shown_ > 0.0) {
      out.told_rev_s = told_ / shown_;
      out.found_rev_s = found_ / shown_;
      out.found_sd_rev_s = out.found_rev_s * std::sqrt(variance_ / shown_);
    }
  }

 private:
  double told_ = 0.0;
  double found_ = 0.0;
  double variance_ = 0.0;
  double shown_ = 0.0;
};

}  // namespace

HeardChannel hear_channel(chatter::offline::RecordedSignal& signal,
                          chatter::online::Detector& detector, Progress& progress) {
  // Samples between two updates of the bar: a few seconds of signal, microseconds of bookkeeping.
  constexpr std::size_t kBetweenUpdates = 65536;
  const std::size_t samples = signal.value.size();
  HeardChannel out;
  FoundSpeed found;
  std::optional<Stretch> open;
  double t_s = signal.start_s;
  double told_rev_s = 0.0;
  for (std::size_t i = 0; i < samples; ++i) {
    t_s = signal.start_s + static_cast<double>(i) / signal.rate_hz;
    told_rev_s = std::isfinite(signal.speed_rev_s[i]) ? signal.speed_rev_s[i] : told_rev_s;
    // The detector judges one spectrum per hop of samples. Only `fresh` outputs are new readings;
    // the samples between them repeat the last verdict and must not be counted again.
    const auto& heard = detector.update({.value = signal.value[i], .speed_rev_s = told_rev_s});
    if (heard.fresh) {
      found.add(heard, told_rev_s);
      out.levels.push_back(
          {.t_s = t_s, .energy = heard.forced_energy, .speed_rev_s = heard.speed_rev_s});
    }
    signal.speed_rev_s[i] = heard.speed_rev_s > 0.0 ? heard.speed_rev_s : told_rev_s;
    if (heard.fresh && heard.chatter) {
      if (!open) {
        open.emplace(t_s);
      }
      open->add(heard, told_rev_s);
    } else if (heard.fresh && open) {
      out.events.push_back(open->finished(t_s, signal.channel));
      open.reset();
    }
    if (i % kBetweenUpdates == 0) {
      progress.update(static_cast<double>(i) / static_cast<double>(samples), "listening");
    }
  }
  // A recording may end while the cut still chatters.
  if (open) {
    out.events.push_back(open->finished(t_s, signal.channel));
  }
  found.put(out);
  out.clips = detector.clips();
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
