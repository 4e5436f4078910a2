// SPDX-License-Identifier: Apache-2.0
// Detection rates, delays and false alarms of the chatter detector on random cuts, at five noise
// levels, without and with modulation: steadyrest_detector_hunt [CASES] [SEED] [STABLE_SECONDS].
// CASES chattering cuts and as many stable ones of 1.7 s are tried at each level. Noise is white,
// its RMS relative to the forced vibration's. Each cut follows 0.2 s of air. With STABLE_SECONDS,
// stable cuts of 60 s follow until that many seconds are reached at each level. Cuts without a
// clear truth (they neither forget nor keep their start) are skipped and counted. In time: within
// 0.15 s after regeneration's part of the vibration first reaches a tenth of its final size.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <ctime>
#include <random>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/chatter/online/detector.hpp>
#include <steadyrest/chatter/online/test/cut_signal.hpp>

namespace steadyrest::chatter::online {
namespace {

using test::CutModel;
using test::CutSignal;

/// A microphone in a shop has 5 … 20 % of noise; 100 % is a hall at full work.
constexpr std::array kNoise{0.01, 0.05, 0.2, 0.5, 1.0};
constexpr double kInTimeS = 0.15;

struct Level {
  int in_time = 0, late = 0, missed = 0;
  int entries = 0;        ///< of the tool into a stable cut
  int entry_alarms = 0;   ///< false, within 0.5 s of the tool's entry
  int later_alarms = 0;   ///< false, after it
  double stable_s = 0.0;  ///< heard
  std::vector<double> delay_s;
};

struct Cost {
  double seconds = 0.0;
  double samples = 0.0;
};

/// Starts of all alarms, s. The noise is drawn afresh for each level, so that no level profits from
/// one draw; the cut is the same for all.
std::vector<double> alarms(const CutModel& model, const CutSignal& signal, double noise,
                           std::mt19937_64& rng, Cost& cost) {
  std::normal_distribution<double> gauss;
  std::vector<double> value = signal.value;
  for (double& v : value) {
    v += noise * gauss(rng);
  }
  std::vector<double> out;
  auto detector = Detector::make({.sample_rate_hz = signal.rate_hz, .teeth = model.teeth});
  if (!detector) {
    // A refused sample rate or number of teeth is this hunt's mistake; it shows as no alarm.
    return out;
  }
  bool before = false;
  const std::clock_t from = std::clock();
  for (std::size_t i = 0; i < value.size(); ++i) {
    const bool now =
        detector->update({.value = value[i], .speed_rev_s = signal.speed_rev_s[i]}).chatter;
    if (now && !before) {
      out.push_back(static_cast<double>(i) / signal.rate_hz);
    }
    before = now;
  }
  // Processor time, so that a busy computer does not make the detector look slow.
  cost.seconds += static_cast<double>(std::clock() - from) / CLOCKS_PER_SEC;
  cost.samples += static_cast<double>(value.size());
  return out;
}

/// Alarms within 0.5 s of the entry (after 0.2 s of air) count separately: an entry excites every
/// mode and is the hardest moment.
void count_stable(Level& level, const std::vector<double>& heard, double seconds) {
  level.stable_s += seconds;
  ++level.entries;
  for (const double at : heard) {
    (at < 0.7 ? level.entry_alarms : level.later_alarms) += 1;
  }
}

/// Only the first alarm counts, against the onset of regeneration in the clean signal.
void count_chatter(Level& level, const std::vector<double>& heard, double onset_s) {
  if (heard.empty()) {
    ++level.missed;
    return;
  }
  const double delay = heard.front() - onset_s;
  level.delay_s.push_back(delay);
  (delay <= kInTimeS ? level.in_time : level.late) += 1;
}

void print(bool modulated, const std::array<Level, kNoise.size()>& levels, int unclear) {
  fmt::print("{}: {} cuts left out\n", modulated ? "modulated" : "constant", unclear);
  for (std::size_t k = 0; k < kNoise.size(); ++k) {
    auto delays = levels[k].delay_s;
    std::ranges::sort(delays);
    const auto at = [&](double share) {
      return delays.empty()
                 ? 0.0
                 : delays[static_cast<std::size_t>(share * static_cast<double>(delays.size() - 1))];
    };
    fmt::print(
        "  noise {:4.2f}: in time {} late {} missed {}; delay median {:.3f} s p95 {:.3f} s; false "
        "alarms in {:.0f} s stable with {} entries: {} at entry, {} later\n",
        kNoise[k], levels[k].in_time, levels[k].late, levels[k].missed, at(0.5), at(0.95),
        levels[k].stable_s, levels[k].entries, levels[k].entry_alarms, levels[k].later_alarms);
  }
}

int hunt(int argc, char** argv) {
  const int cases = argc > 1 ? std::atoi(argv[1]) : 60;
  const auto seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 7ULL;
  const double stable_s = argc > 3 ? std::atof(argv[3]) : 0.0;
  Cost cost;
  for (const bool modulated : {false, true}) {
    std::mt19937_64 rng(seed + (modulated ? 1 : 0));
    std::array<Level, kNoise.size()> levels;
    int unclear = 0;
    int chattering = 0;
    int stable = 0;
    while (chattering < cases || stable < cases || levels.front().stable_s < stable_s) {
      CutModel model = test::random_cut(rng, modulated);
      model.air_s = 0.2;
      CutSignal signal = test::simulate(model, 1.7);
      const test::Truth truth = test::truth_of(model, signal);
      // An onset after 1.2 s leaves too little of the 1.7 s for a fair test of the detector.
      const bool too_late = truth.chatters && truth.onset_s > 1.2;
      if ((!truth.chatters && !truth.stable) || too_late) {
        ++unclear;
        continue;
      }
      const bool listen = truth.chatters ? chattering < cases
                                         : stable < cases || levels.front().stable_s < stable_s;
      if (!listen) {
        continue;
      }
      // Longer stable cuts for the false alarm rate: in 1.7 s pieces most of the time would be
      // entry.
      if (truth.stable && stable >= cases) {
        signal = test::simulate(model, 60.0);
      }
      (truth.chatters ? chattering : stable) += 1;
      for (std::size_t k = 0; k < kNoise.size(); ++k) {
        const auto heard = alarms(model, signal, kNoise[k] * truth.forced_rms, rng, cost);
        if (truth.stable) {
          count_stable(levels[k], heard,
                       static_cast<double>(signal.value.size()) / signal.rate_hz - model.air_s);
        } else {
          count_chatter(levels[k], heard, truth.onset_s);
        }
      }
    }
    print(modulated, levels, unclear);
  }
  fmt::print("{:.3f} µs of processor time a sample\n", 1e6 * cost.seconds / cost.samples);
  return 0;
}

}  // namespace
}  // namespace steadyrest::chatter::online

int main(int argc, char** argv) {
  return steadyrest::chatter::online::hunt(argc, argv);
}
