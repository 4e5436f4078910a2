// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <steadyrest/adapters/lines/encoders/encoder_source.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::lines {

using kernel::outcome::Result;
using kernel::outcome::unavailable;

namespace {

constexpr double kLongestGap_s = 2.0;  ///< between two samples that belong together
constexpr std::uint32_t kMostTicks = 0xFFFFFFFFU;
constexpr std::uint32_t kHalfRange = 0x80000000U;

double seconds(std::uint32_t ticks, std::uint32_t clock_hz) noexcept {
  return static_cast<double>(ticks) / static_cast<double>(clock_hz);
}

}  // namespace

Result<void> RecorderTrack::check(const RecorderSample& sample) const {
  if (seconds(kMostTicks, sample.clock_hz) < 2.0 * kLongestGap_s) {
    return unavailable(fmt::format("the recorder's clock of {} Hz goes round too soon: a gap of "
                                   "{:g} s would not be seen",
                                   sample.clock_hz, kLongestGap_s),
                       "let it send ticks of a slower clock, 1 GHz at most");
  }
  if (!started_) {
    return {};
  }
  if (sample.counters != last_.counters || sample.clock_hz != last_.clock_hz) {
    return unavailable("another recorder answers: the number of encoders or the clock differs",
                       kReference);
  }
  const auto messages = static_cast<std::int16_t>(sample.sequence - last_.sequence);
  if (messages < 0 || seconds(sample.ticks - last_.ticks, sample.clock_hz) > kLongestGap_s) {
    return unavailable(
        "the recorder began again or was silent for more than 2 s: its counts are no positions",
        kReference);
  }
  for (std::size_t i = 0; i < sample.counters; ++i) {
    if (sample.counter.at(i).lost) {
      return unavailable(
          fmt::format("encoder {} moved too fast for the recorder: counts are lost", i + 1),
          kReference);
    }
  }
  return {};
}

Result<EncoderReading> RecorderTrack::take(const RecorderSample& sample) {
  if (fault_.what.empty()) {
    if (auto fits = check(sample); !fits) {
      fault_ = fits.error();
    }
  }
  if (!fault_.what.empty()) {
    return std::unexpected(fault_);
  }
  if (started_) {
    now_.time_s += seconds(sample.ticks - last_.ticks, sample.clock_hz);
  }
  now_.counters = sample.counters;
  for (std::size_t i = 0; i < sample.counters; ++i) {
    const CounterSample& counter = sample.counter.at(i);
    const CounterSample& before = last_.counter.at(i);
    if (started_) {
      // Wraps as the counter does.
      now_.count.at(i) += static_cast<std::int32_t>(static_cast<std::uint32_t>(counter.count) -
                                                    static_cast<std::uint32_t>(before.count));
    }
    // An edge of long ago would wrap: only a new one has a time.
    const bool moved = !started_ || counter.edge_ticks != before.edge_ticks ||
                       counter.direction != before.direction;
    // An edge while the message was made is later than its ticks.
    const std::uint32_t after = sample.ticks - counter.edge_ticks;
    const std::uint32_t age = after < kHalfRange ? after : 0;
    if (counter.direction != 0 && moved) {
      now_.edge_s.at(i) = now_.time_s - seconds(age, sample.clock_hz);
    }
    now_.direction.at(i) = counter.direction;
  }
  started_ = true;
  last_ = sample;
  return now_;
}

}  // namespace steadyrest::adapters::lines
