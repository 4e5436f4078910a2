// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/trial/cut/original.hpp>

// Segments become lines of the programs here: who reads a refusal has a text before him.
namespace steadyrest::trial::cut {

using kernel::outcome::refuse;
using math::geometry::PathPairing;

kernel::outcome::Result<Original> Original::make(
    const nc::plan::PlannedPath& changed, std::shared_ptr<const nc::plan::PlannedPath> original,
    double tube_mm) {
  if (!(tube_mm >= 0.01 && tube_mm <= kWidestTube_mm)) {
    return refuse(fmt::format("the tube of {} mm is out of range; allowed: 0.01 … {} mm", tube_mm,
                              kWidestTube_mm),
                  "give the largest distance that a correction may have");
  }
  auto part = original->programmed ? original->programmed : original;
  auto pairing = PathPairing::make(changed.segments, part->segments, {.tube_mm = tube_mm});
  if (!pairing) {
    const PathPairing::Parting& parting = pairing.error();
    const std::uint32_t line = part->segments[parting.original_segment].line;
    const std::string what =
        parting.ended
            ? fmt::format("the cut ends here, but the original goes on in its line {}", line)
            : fmt::format(
                  "the programs part here: line {} of the original is {:.3g} mm "
                  "away; allowed: up to {:g} mm",
                  line, parting.distance_mm, tube_mm);
    return refuse("", changed.segments[parting.changed_segment].line, what,
                  "give two programs for one part, or a wider tube");
  }
  const PathPairing::Farthest farthest = pairing->farthest();
  const std::uint32_t original_line = part->segments[farthest.original_segment].line;
  return Original{.path = std::move(part),
                  .as_cut = std::move(original),
                  .pairing = std::move(*pairing),
                  .tube_mm = tube_mm,
                  .farthest_mm = farthest.distance_mm,
                  .changed_line = changed.segments[farthest.changed_segment].line,
                  .original_line = original_line};
}

std::shared_ptr<const Original> Original::of_itself(
    const std::shared_ptr<const nc::plan::PlannedPath>& path) {
  if (!path->programmed) {
    return nullptr;
  }
  auto own = make(*path, path, kWidestTube_mm);
  return own ? std::make_shared<const Original>(std::move(*own)) : nullptr;
}

}  // namespace steadyrest::trial::cut
