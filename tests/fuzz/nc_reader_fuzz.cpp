// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "nc_mutator.hpp"

#include <steadyrest/nc/interpret/program.hpp>

namespace {

namespace interpret = steadyrest::nc::interpret;

// Catches what no text may cause: a move that is not finite, or that does not start where the
// previous one ended although no offset changed.
class Watch final : public interpret::Sink {
 public:
  void on_move(const interpret::Move& move) override {
    for (std::size_t i = 0; i < move.end.size(); ++i) {
      if (!std::isfinite(move.end[i]) || !std::isfinite(move.offset[i])) {
        std::abort();
      }
    }
    if (!std::isfinite(move.feed_mm_s) || move.dwell_s < 0.0) {
      std::abort();
    }
  }
  void on_event(const interpret::Event& /*event*/) override {}
};

}  // namespace

// The first byte chooses the dialect, the rest is the program.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  interpret::Config config;
  config.dialect = static_cast<steadyrest::nc::read::Dialect>(data[0] % 4U);
  config.most_repeated_lines = 2000;
  Watch watch;
  const std::string_view text{reinterpret_cast<const char*>(data) + 1, size - 1};
  const auto report = interpret::run_text(text, config, watch);
  if (!report.has_value()) {
    std::abort();
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  static constexpr std::uint8_t kDialects[] = {0, 1, 2, 3};
  return steadyrest::fuzz::mutate_program(
      data, size, most, seed, {.head = 1, .dialects = 4, .dialect_of = kDialects, .edits = false});
}
