// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <steadyrest/apps/page/chatter/detect_page.hpp>
#include <steadyrest/apps/page/chatter/spectrogram.hpp>
#include <steadyrest/apps/page/shared/json_numbers.hpp>
#include <steadyrest/kernel/units/convert.hpp>

// Spectrogram and course of a recording.
namespace steadyrest::apps::page {
namespace {

using chatter::offline::RecordedSignal;
using kernel::units::rpm_from_rev_s;

constexpr std::size_t kCourseStretches = 1500;
/// The tooth orders that a machinist looks for, the chatter with its first multiple, and never less
/// than 1 kHz.
constexpr double kTeethShown = 12.0;   ///< orders of the teeth in the picture …
constexpr double kChatterShown = 2.2;  ///< … and times the chatter's frequency
constexpr double kLeastShown_hz = 1000.0;

double shown_hz(const DetectPage& page, const RecordedSignal& signal) {
  const double tooth_hz =
      static_cast<double>(page.teeth) * chatter::offline::finite_range(signal.speed_rev_s).most;
  return std::min(
      0.5 * signal.rate_hz,
      std::max({kTeethShown * tooth_hz, kChatterShown * page.chatter_hz, kLeastShown_hz}));
}

struct Stretch {
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
  double speed_rev_s = std::numeric_limits<double>::quiet_NaN();
};

/// What was recorded between two samples; NaN where nothing was.
Stretch stretch_of(const RecordedSignal& signal, std::size_t begin, std::size_t end) {
  Stretch out;
  double speeds = 0.0;
  double known = 0.0;
  for (std::size_t i = begin; i < end; ++i) {
    out.low = std::fmin(out.low, signal.value[i]);
    out.high = std::fmax(out.high, signal.value[i]);
    if (std::isfinite(signal.speed_rev_s[i])) {
      speeds += signal.speed_rev_s[i];
      known += 1.0;
    }
  }
  if (known > 0.0) {
    out.speed_rev_s = speeds / known;
  }
  return out;
}

/// The signal's extremes and its mean speed within even stretches, of any length of recording.
Json course_json(const RecordedSignal& signal) {
  std::vector<double> t_s;
  std::vector<double> low;
  std::vector<double> high;
  std::vector<double> speed_rpm;
  const std::size_t samples = signal.value.size();
  const std::size_t stretch = std::max<std::size_t>(1, samples / kCourseStretches);
  for (std::size_t begin = 0; begin < samples; begin += stretch) {
    const std::size_t end = std::min(begin + stretch, samples);
    const Stretch all = stretch_of(signal, begin, end);
    t_s.push_back(signal.start_s + 0.5 * static_cast<double>(begin + end - 1) / signal.rate_hz);
    low.push_back(all.low);
    high.push_back(all.high);
    speed_rpm.push_back(rpm_from_rev_s(all.speed_rev_s));
  }
  return {{"t_s", short_numbers(t_s)},
          {"low", short_numbers(low)},
          {"high", short_numbers(high)},
          {"speed_rpm", short_numbers(speed_rpm)}};
}

Json to_object(const Spectrogram& s) {
  return {{"start_s", s.start_s}, {"column_s", s.column_s}, {"row_hz", s.row_hz},
          {"columns", s.columns}, {"rows", s.rows},         {"level_db", s.level_db}};
}

}  // namespace

Json detect_page(const Json& answer, const DetectPage& page, const RecordedSignal& signal) {
  Json out = chatter_head("detect", page.signal_name, answer);
  out["machine"] = page.machine;
  out["teeth"] = page.teeth;
  // The spectrum's resolution, for the reader: one over the window.
  out["bin_hz"] = signal.rate_hz / static_cast<double>(page.window);
  out["start_s"] = signal.start_s;
  out["course"] = course_json(signal);
  out["spectrogram"] = to_object(spectrogram(signal.value, {.rate_hz = signal.rate_hz,
                                                            .start_s = signal.start_s,
                                                            .window = page.window,
                                                            .most_hz = shown_hz(page, signal)}));
  return out;
}

}  // namespace steadyrest::apps::page
