// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/motion/online/edges/latched_decoder.hpp>

/// How common machine inputs feed the `LatchedDecoder`. Freestanding like the recorder.
///
/// - Mesa hostmot2: count of 16 bits; stamp of 16 bits at 2 MHz (10 MHz at high resolution), range
///   33 ms (6.6 ms); the last edge of a cycle.
/// - TI eQEP: count of 32 bits; age of the last edge, 16 bits; unit events of one edge (UPPS = 0).
/// - Linux counter device: count as wide as the device; the kernel's stamp of 64 bits, ns; every
///   edge.
/// - EtherCAT terminal: count of up to 32 bits, with micro increments; stamp of the distributed
///   clock, ns, or none; the last edge.
namespace steadyrest::motion::online {

/// The clock register is read before the counters, so a stamp may be later than it by the bus
/// delay: `ahead_ticks`.
[[nodiscard]] constexpr LatchedDecoder::Config hostmot2_config(
    std::uint64_t ticks_per_cycle, std::uint64_t ahead_ticks = 500) noexcept {
  return {.count_bits = 16,
          .clock_bits = 16,
          .cycle_ticks = ticks_per_cycle,
          .ahead_ticks = ahead_ticks};
}

/// Counter register: count in the low half, stamp in the high half; the module's clock register.
[[nodiscard]] constexpr LatchedRead hostmot2_read(std::uint32_t counter, std::uint32_t clock,
                                                  std::uint64_t cycle) noexcept {
  return {.count = counter & 0xFFFFU,
          .stamp = counter >> 16U,
          .clock = clock & 0xFFFFU,
          .cycle = cycle};
}

/// Registers latched on the unit time-out (QCLM = 1), prescaler of the position events UPPS = 0.
struct EqepLatch {
  std::uint32_t position = 0;    ///< QPOSLAT
  std::uint16_t timer = 0;       ///< QCTMRLAT: capture ticks since the last edge
  bool overflow = false;         ///< QEPSTS.COEF since the last latch
  bool direction_error = false;  ///< QEPSTS.CDEF since the last latch
  std::int8_t direction = 0;     ///< QEPSTS.QDF as ±1; 0 if an edge may have come since the latch
  std::uint64_t clock = 0;       ///< the latch's time in capture ticks: cycle · QUPRD / 2^CCPS
};

/// The age is rounded to capture ticks, so a stamp made from it varies by one.
[[nodiscard]] constexpr LatchedDecoder::Config eqep_config() noexcept {
  return {.count_bits = 32, .clock_bits = 64, .stamp_bits = 17, .fuzz_ticks = 2};
}

/// COEF says that the timer overflowed: either before this cycle's last edge, whose age is then
/// right, or, if there was none, since the previous edge, and the timer means nothing. So after
/// COEF the age is trusted only where the count changed; a full timer never is.
[[nodiscard]] constexpr LatchedRead eqep_read(const EqepLatch& latch) noexcept {
  return {.count = latch.position,
          .stamp = latch.clock - latch.timer,
          .clock = latch.clock,
          .direction = latch.direction,
          .stamp_invalid = latch.timer == 0xFFFFU,
          .overflowed = latch.overflow,
          .turned = latch.direction_error};
}

/// `count_bits` as the device's ceiling says; one read for each `struct counter_event`.
[[nodiscard]] constexpr LatchedDecoder::Config linux_counter_config(unsigned count_bits) noexcept {
  return {.count_bits = count_bits, .clock_bits = 64};
}

/// status ≠ 0: the kernel could not read the value; the caller must skip such an event.
[[nodiscard]] constexpr LatchedRead linux_counter_read(std::uint64_t value,
                                                       std::uint64_t timestamp_ns) noexcept {
  return {.count = value, .stamp = timestamp_ns, .clock = timestamp_ns};
}

/// `stamp_bits` = 32 or 64 of the distributed clock; `micro_bits` = 8 with micro increments, which
/// are the terminal's own interpolation, not edges, else 0.
[[nodiscard]] constexpr LatchedDecoder::Config ethercat_config(unsigned stamp_bits,
                                                               unsigned micro_bits,
                                                               std::uint64_t cycle_ns) noexcept {
  return {.count_bits = 32,
          .fraction_bits = micro_bits,
          .clock_bits = stamp_bits,
          .cycle_ticks = cycle_ns};
}

/// `stamped`: the terminal gives the time of the last edge. Without it every event has
/// kTimeUnknown.
[[nodiscard]] constexpr LatchedRead ethercat_read(std::uint32_t count, std::uint64_t stamp_ns,
                                                  std::uint64_t clock_ns, std::uint64_t cycle,
                                                  bool stamped) noexcept {
  return {.count = count,
          .stamp = stamp_ns,
          .clock = clock_ns,
          .cycle = cycle,
          .stamp_invalid = !stamped};
}

}  // namespace steadyrest::motion::online
