// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/math/geometry/path_pairing.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>
#include <steadyrest/nc/plan/path/plan_program.hpp>
#include <steadyrest/nc/rewrite/original/original_path.hpp>
#include <steadyrest/nc/rewrite/text/mark.hpp>
#include <steadyrest/nc/rewrite/text/put_back.hpp>
#include <steadyrest/nc/rewrite/text/source_lines.hpp>
#include <steadyrest/nc/rewrite/tube/permitted.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using kernel::signal::PathSegment;
using math::geometry::PathPairing;
using plan::PlannedPath;

constexpr double kRounding = 1.25;
/// A block in several at other feeds has its corners rounded otherwise, with G64 of LinuxCNC by
/// millimetres. Blocks that are proved whole need no tube that finds edits.
constexpr double kOtherRounding_mm = 5.0;
constexpr double kWrittenDigits_mm = 5e-4;

/// The segments' places on the original, and which of them the text moves.
void put_places(const PathPairing& pairing, double tube_mm, PlannedPath& path) {
  namespace geometry = math::geometry;
  for (PathSegment& segment : path.segments) {
    const double end_mm = segment.position_mm + segment.length_mm;
    segment.original_start_mm = pairing.original_mm(segment.position_mm);
    segment.original_end_mm = pairing.original_mm(end_mm);
    constexpr std::array kPlaces = {0.0, 0.25, 0.5, 0.75, 1.0};
    segment.by_text =
        segment.motion == kernel::signal::Motion::feed &&
        std::ranges::any_of(kPlaces, [&](double u) {
          return geometry::distance_to(path.original->segments, geometry::point_at(segment, u),
                                       segment.original_start_mm - tube_mm,
                                       segment.original_end_mm + tube_mm) > kWrittenDigits_mm;
        });
  }
}

/// Empty, or why the paths cannot be paired.
std::string pair_with(PlannedPath original, const TextMarks& marks, PlannedPath& path) {
  const double tube_mm = marks.tube_mm;
  auto pairing =
      PathPairing::make(path.segments, original.segments, {.tube_mm = kRounding * tube_mm});
  if (!pairing && marks.whole && kRounding * tube_mm < kOtherRounding_mm) {
    pairing = PathPairing::make(path.segments, original.segments, {.tube_mm = kOtherRounding_mm});
  }
  if (!pairing) {
    const PathPairing::Parting& parting = pairing.error();
    return fmt::format(
        "line {} is {:.3g} mm from the original that its marks hold; they allow {:g} mm",
        path.segments[parting.changed_segment].line, parting.distance_mm, tube_mm);
  }
  path.original = std::make_shared<const PlannedPath>(std::move(original));
  put_places(*pairing, tube_mm, path);
  return {};
}

}  // namespace

TextMarks read_text_marks(const std::string& file) {
  TextMarks marks;
  if (!SourceLines::open(file)) {
    return marks;
  }
  // An altered record still says that something is inserted.
  const auto inserted = read_mark(file);
  marks.heat = !inserted || !inserted->empty();
  const auto replaced = read_replaced_mark(file);
  if (replaced && replaced->empty()) {
    return marks;
  }
  const auto permitted = replaced ? permitted_of(file, *replaced, std::nullopt, nullptr)
                                  : std::unexpected(replaced.error());
  if (permitted && !permitted->path) {
    return marks;  // feeds and speeds alone: on the same path
  }
  marks.path = true;
  auto back = permitted ? put_back(file) : std::unexpected(permitted.error());
  if (!back) {
    marks.unknown = kernel::outcome::text(back.error());
    return marks;
  }
  const auto blocks = compare_blocks(file, *replaced);
  if (!blocks || *blocks == Blocks::edited) {
    marks.unknown = file + ": its replaced blocks were edited after it was made";
    return marks;
  }
  marks.whole = *blocks == Blocks::whole;
  marks.tube_mm = permitted->tube_mm;
  marks.original = std::move(back->text);
  return marks;
}

TextMarks read_text_marks(const std::string& file, const std::vector<std::string>& called) {
  TextMarks marks = read_text_marks(file);
  for (const std::string& name : called) {
    const TextMarks of_called = read_text_marks(name);
    marks.heat = marks.heat || of_called.heat;
    marks.path = marks.path || of_called.path;
    if (of_called.path && marks.unknown.empty()) {
      marks.unknown = name + ", which it calls, has blocks replaced";
    }
  }
  return marks;
}

void hold_against_original(const TextMarks& marks, const std::string& file,
                           const interpret::Config& config, const kernel::machine::Machine& machine,
                           PlannedPath& path) {
  path.heat_in_text = marks.heat;
  path.original_unknown = marks.unknown;
  if (!marks.path || !marks.unknown.empty() || path.segments.empty()) {
    return;
  }
  interpret::Config beside = config;  // a text finds no subprograms beside itself
  beside.subprogram_folders.push_back(std::filesystem::path(file).parent_path().string());
  const std::string name = "the original of " + file;
  auto original = plan::plan_text(marks.original, beside, machine, name);
  if (original && original->tolerant) {
    auto programmed = plan::plan_programmed(machine, name, [&](interpret::Sink& sink) {
      return interpret::run_text(marks.original, beside, sink);
    });
    if (programmed) {  // what the planner has just taken
      original->programmed = std::make_shared<const PlannedPath>(std::move(*programmed));
    }
  }
  if (!original) {
    path.original_unknown = kernel::outcome::text(original.error());
  } else if (original->segments.empty()) {
    path.original_unknown = "the original that its marks hold moves no axis";
  } else {
    path.original_unknown = pair_with(std::move(*original), marks, path);
  }
}

std::vector<std::string> words_of(const PlannedPath& path) {
  std::vector<std::string> words;
  if (!path.original_unknown.empty()) {
    words.push_back(
        fmt::format("the program's text corrects its path, but the original is not known ({}); "
                    "the layer stays out of the contour",
                    path.original_unknown));
  }
  if (path.heat_in_text) {
    words.emplace_back(
        "the program has corrections of a thermal plan inserted; the layer adds no thermal offset");
  }
  return words;
}

}  // namespace steadyrest::nc::rewrite
