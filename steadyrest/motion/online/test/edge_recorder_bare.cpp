// SPDX-License-Identifier: Apache-2.0
// The recorder as built for a microcontroller: see edge_recorder_bare.sh.
#include <steadyrest/motion/online/edges/edge_inputs.hpp>
#include <steadyrest/motion/online/edges/edge_ring.hpp>
#include <steadyrest/motion/online/edges/quadrature_decoder.hpp>

namespace motion = steadyrest::motion::online;

extern "C" {

motion::EdgeRing<64> steadyrest_ring;
motion::QuadratureDecoder steadyrest_sampled;
motion::LatchedDecoder steadyrest_latched;

void steadyrest_start(std::uint16_t hold_samples) {
  steadyrest_sampled = motion::QuadratureDecoder({.clock_bits = 32, .hold_samples = hold_samples});
  steadyrest_latched = motion::LatchedDecoder(motion::hostmot2_config(2000));
}

void steadyrest_sample(bool a, bool b, std::uint32_t clock) {
  motion::EdgeEvent event;
  if (steadyrest_sampled.update(a, b, clock, event)) {
    steadyrest_ring.push(event);
  }
}

void steadyrest_cycle(std::uint32_t counter, std::uint32_t clock, std::uint64_t cycle) {
  motion::EdgeEvent event;
  if (steadyrest_latched.update(motion::hostmot2_read(counter, clock, cycle), event)) {
    steadyrest_ring.push(event);
  }
}

bool steadyrest_take(motion::EdgeEvent& event) {
  return steadyrest_ring.pop(event);
}

}  // extern "C"
