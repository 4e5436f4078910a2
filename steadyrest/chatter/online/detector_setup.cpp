// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <steadyrest/chatter/online/detector.hpp>
#include <steadyrest/chatter/online/orders/detector_refusal.hpp>

namespace steadyrest::chatter::online {
namespace {

constexpr std::size_t kGateOrders = 64;

}  // namespace

kernel::outcome::Result<Detector> Detector::make(const Config& config) {
  if (!(config.off_ratio >= 0.0 && config.on_ratio >= config.off_ratio &&
        config.sure_ratio >= config.on_ratio && config.sure_ratio <= 1.0 &&
        config.free_ratio >= 0.0 && config.free_ratio <= 1.0)) {
    return refuse_detector("energy ratios do not rise from off over on to sure, 0…1");
  }
  if (!(config.line_ratio >= 10.0 && config.margin >= 1.0 && config.confirm >= 1)) {
    return refuse_detector("line ratio below 10, margin or confirmations below 1");
  }
  if (!(config.least_energy >= 0.0 && config.learn_s >= 0.0 && config.settle_rev >= 0.0 &&
        config.speed_sd >= 0.0 && config.speed_sd <= 0.02)) {
    return refuse_detector("an energy or a time is negative, or speed_sd is not within 0…0.02");
  }
  auto filter = OrderFilter::make({.sample_rate_hz = config.sample_rate_hz,
                                   .teeth = config.teeth,
                                   .tooth_harmonics = config.tooth_harmonics,
                                   .spindle_harmonics = config.spindle_harmonics,
                                   .moving_memory_rev = config.moving_memory_rev,
                                   .folds = config.folds});
  if (!filter) {
    return std::unexpected(filter.error());
  }
  auto spectrum = LineSpectrum::make({.sample_rate_hz = config.sample_rate_hz,
                                      .window_s = config.window_s,
                                      .lowest_hz = config.lowest_hz});
  if (!spectrum) {
    return std::unexpected(spectrum.error());
  }
  auto share = FreeShare::make({.sample_rate_hz = config.sample_rate_hz, .teeth = config.teeth});
  if (!share) {
    return std::unexpected(share.error());
  }
  return Detector(config, std::move(*filter), std::move(*spectrum), std::move(*share));
}

Detector::Detector(const Config& config, OrderFilter filter, LineSpectrum spectrum, FreeShare share)
    : config_(config),
      filter_(std::move(filter)),
      spectrum_(std::move(spectrum)),
      share_(std::move(share)),
      sensor_(config.sample_rate_hz),
      track_(config.speed_sd, filter_.orders().size()),
      choice_({.sample_rate_hz = config.sample_rate_hz,
               .bin_hz = spectrum_.resolution_hz(),
               .teeth = config.teeth,
               .orders = std::max<std::size_t>(kGateOrders, config.spindle_harmonics),
               .tooth_orders = config.tooth_harmonics,
               .folds = config.folds}) {}

}  // namespace steadyrest::chatter::online
