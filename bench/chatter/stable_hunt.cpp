// SPDX-License-Identifier: Apache-2.0
// False alarms of the chatter detector on stable cuts with the faults of real recordings, and
// chatter that it finds in the same: steadyrest_stable_hunt [CUTS OF A KIND] [SEED].
#include <algorithm>
#include <array>
#include <cstdlib>
#include <ctime>
#include <random>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/chatter/online/detector.hpp>
#include <steadyrest/chatter/online/test/recorded_cut.hpp>

namespace steadyrest::chatter::online {
namespace {

using test::Recorded;
using test::RecordedCut;

struct Alarm {
  double t_s = 0.0;
  double frequency_hz = 0.0;
};

struct Cost {
  double seconds = 0.0;
  double samples = 0.0;
};

std::vector<Alarm> alarms(const RecordedCut& cut, const Recorded& recorded, Cost& cost) {
  std::vector<Alarm> out;
  auto detector = Detector::make({.sample_rate_hz = cut.rate_hz,
                                  .teeth = cut.teeth,
                                  .speed_sd = 0.003,
                                  .folds = Detector::folds_at(cut.rate_hz)});
  if (!detector) {
    return out;
  }
  bool before = false;
  const std::clock_t from = std::clock();
  for (std::size_t i = 0; i < recorded.value.size(); ++i) {
    const auto& heard =
        detector->update({.value = recorded.value[i], .speed_rev_s = recorded.speed_rev_s[i]});
    if (heard.chatter && !before) {
      out.push_back(
          {.t_s = static_cast<double>(i) / cut.rate_hz, .frequency_hz = heard.frequency_hz});
    }
    before = heard.chatter;
  }
  cost.seconds += static_cast<double>(std::clock() - from) / CLOCKS_PER_SEC;
  cost.samples += static_cast<double>(recorded.value.size());
  return out;
}

int hunt(int argc, char** argv) {
  const int each = argc > 1 ? std::atoi(argv[1]) : 100;
  const auto seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1ULL;
  const bool loud = argc > 3;
  Cost cost;
  for (const auto how : test::kSpoiled) {
    std::mt19937_64 rng(seed);
    int at_order = 0;
    int elsewhere = 0;
    int cuts_with = 0;
    double heard_s = 0.0;
    int found = 0;
    int late = 0;
    int missed = 0;
    int early = 0;
    for (int i = 0; i < each; ++i) {
      RecordedCut cut = test::spoiled_cut(how, rng);
      const auto of_seed = rng();
      const Recorded stable = test::record(cut, of_seed);
      heard_s += cut.seconds;
      const auto heard = alarms(cut, stable, cost);
      cuts_with += heard.empty() ? 0 : 1;
      for (const Alarm& alarm : heard) {
        const double off =
            test::from_order_hz(alarm.frequency_hz, cut.speed_rev_s * (1.0 - cut.droop),
                                cut.rate_hz, !cut.filtered, 130);
        (off < 5.0 ? at_order : elsewhere) += 1;
        if (loud) {
          fmt::print(
              "  {} {}: {:.3f} s {:.1f} Hz, {:.1f} Hz from an order; Ω {:.2f} N {} fs {:.0f} told "
              "{:.4f} droop {:.4f}\n",
              test::kSpoiledNames[static_cast<std::size_t>(how)], i, alarm.t_s, alarm.frequency_hz,
              off, cut.speed_rev_s, cut.teeth, cut.rate_hz, cut.told_ratio, cut.droop);
        }
      }
      // The same with chatter in it.
      std::mt19937_64 more(of_seed);
      const auto draw = [&](double a, double b) {
        return std::uniform_real_distribution<double>(a, b)(more);
      };
      cut.chatter_hz = draw(200.0, std::min(2000.0, 0.4 * cut.rate_hz));
      cut.chatter_size = draw(0.5, 2.0);
      cut.chatter_s = draw(0.0, 1.0) < 0.3 ? cut.entry_s : draw(3.0, 8.0);
      cut.chatter_ends_s = cut.chatter_s + draw(2.0, 4.0);
      cut.grows_1_s = draw(5.0, 100.0);
      const Recorded chatters = test::record(cut, of_seed);
      const auto again = alarms(cut, chatters, cost);
      const auto right = std::ranges::find_if(again, [&](const Alarm& a) {
        return a.t_s > cut.chatter_s && a.t_s < cut.chatter_ends_s + 0.1;
      });
      if (right == again.end()) {
        ++missed;
      } else {
        (right->t_s < chatters.stands_out_s + 0.3 ? found : late) += 1;
        early += right->t_s < chatters.stands_out_s - 0.3 ? 1 : 0;
      }
      if (loud && (right == again.end() || right->t_s >= chatters.stands_out_s + 0.3)) {
        fmt::print(
            "  {} {}: chatter of {:.2f} at {:.1f} Hz from {:.2f} s ({:.1f} Hz from an order) {}\n",
            test::kSpoiledNames[static_cast<std::size_t>(how)], i, cut.chatter_size, cut.chatter_hz,
            chatters.stands_out_s,
            test::from_order_hz(cut.chatter_hz, cut.speed_rev_s * (1.0 - cut.droop), cut.rate_hz,
                                !cut.filtered, 130),
            right == again.end() ? "missed" : "late");
      }
    }
    fmt::print(
        "{:9}: {} of {} stable cuts with alarms: {} at orders or folds, {} elsewhere in {:.0f} s; "
        "chatter: "
        "{} in 0.3 s, {} late, {} missed\n",
        test::kSpoiledNames[static_cast<std::size_t>(how)], cuts_with, each, at_order, elsewhere,
        heard_s, found, late, missed);
  }
  fmt::print("{:.3f} µs of processor time a sample\n", 1e6 * cost.seconds / cost.samples);
  return 0;
}

}  // namespace
}  // namespace steadyrest::chatter::online

int main(int argc, char** argv) {
  return steadyrest::chatter::online::hunt(argc, argv);
}
