// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "nc_corrected.hpp"

#include <steadyrest/nc/rewrite/correct/compensate.hpp>
#include <steadyrest/nc/rewrite/text/tag.hpp>

// Compensate and strip are inverse: original → corrected → original, byte for byte, or nothing was
// written at all.
namespace {

namespace fuzz = steadyrest::fuzz;
namespace rewrite = steadyrest::nc::rewrite;

constexpr std::uint8_t kChoices = 5;  // four controls, and the reader of plans

/// strip restores a corrected program byte for byte; for a program that cannot be corrected nothing
/// is written.
void play(std::string_view text, rewrite::Method method, std::uint8_t choice) {
  fuzz::Job job(text, method, choice);
  if (!job.plan_it(choice)) {
    return;
  }
  const fuzz::Files& files = fuzz::files();
  // A refusal must leave an older file unchanged.
  constexpr std::string_view kOld = "what was there";
  fuzz::write_file(files.original, text);
  fuzz::write_file(files.changed, kOld);
  const auto done = rewrite::compensate(files.original, files.changed, job.plan, job.config,
                                        fuzz::mill(), job.settings);
  if (!done) {
    if (fuzz::read_file(files.changed) != kOld) {
      std::abort();
    }
    return;
  }
  if (!rewrite::strip(files.changed, files.changed).has_value() ||
      fuzz::read_file(files.changed) != text || fuzz::read_file(files.original) != text) {
    std::abort();
  }
}

}  // namespace

// '0' to '3', a byte and a program: that control. '4', a byte and a text: a plan. Everything else
// is a plan, and a program for every control.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text{reinterpret_cast<const char*>(data), size};
  const std::size_t chosen =
      size < fuzz::kHead ? kChoices : static_cast<std::size_t>(data[0]) - '0';
  if (chosen < fuzz::kMethods.size()) {
    play(text.substr(fuzz::kHead), fuzz::kMethods[chosen], data[1]);
  } else if (chosen < kChoices) {
    static_cast<void>(rewrite::parse_plan(text.substr(fuzz::kHead), "plan.json"));
  } else {
    static_cast<void>(rewrite::parse_plan(text, "plan.json"));
    for (const rewrite::Method method : fuzz::kMethods) {
      play(text, method, 0);
    }
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  if (size > 0 && data[0] == '0' + kChoices - 1) {
    return LLVMFuzzerMutate(data, size, most);
  }
  return fuzz::mutate_program(
      data, size, most, seed,
      {.head = fuzz::kHead, .dialects = 4, .dialect_of = fuzz::kDialectOf.data(), .edits = false});
}
