// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/cut/cut_against.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/nc/rewrite/text/mark.hpp>
#include <steadyrest/nc/rewrite/tube/permitted.hpp>

namespace steadyrest::apps::cli::cut {
namespace {

constexpr double kTube_mm = 1.0;

/// What is asked for; else 1 mm, or more where the changed program's mark says that it may be
/// farther away. The control rounds the corners of both.
double tube_of(const AgainstOptions& options, const std::string& changed) {
  if (options.tube_mm) {
    return *options.tube_mm;
  }
  constexpr double kRounding = 1.25;
  const auto mark = nc::rewrite::read_replaced_mark(changed);
  const kernel::outcome::Result<nc::rewrite::Permitted> permitted =
      mark && !mark->empty() ? nc::rewrite::permitted_of(changed, *mark, std::nullopt, nullptr)
                             : nc::rewrite::Permitted{};
  return permitted ? std::clamp(kRounding * permitted->tube_mm, kTube_mm,
                                trial::cut::Original::kWidestTube_mm)
                   : kTube_mm;
}

}  // namespace

void add_against_options(Verb& verb, AgainstOptions& options) {
  CLI::Option* const against = verb.reads(
      "--against", options.file,
      "The original of a changed FILE. Errors are the tool's distance from the original's path "
      "while both programs cut (G1 to G3); rapids, rotary axes and a rounding of corners by a "
      "tolerance of up to 0.5 mm do not count. Of the original the layer knows what FILE's marks "
      "hold. Default: the original in "
      "those marks, if any");
  verb.add_option(
          "--tube-mm", options.tube_mm,
          "Refuse programs farther apart than this where they cut, 0.01 … 5; default: 1, or "
          "as FILE says of itself")
      ->needs(against);
}

std::expected<std::shared_ptr<const trial::cut::Original>, Answer> read_original(
    const AgainstOptions& options, const ProgramOptions& changed, const PathPointer& path,
    const kernel::machine::Machine& machine) {
  PathPointer other = path->original;  // that its marks hold
  if (!options.file.empty()) {
    ProgramOptions program = changed;
    program.file = options.file;
    auto planned = plan(program, machine);
    if (!planned) {
      return std::unexpected(std::move(planned.error()));
    }
    other = planned->path;
  }
  if (!other) {
    return nullptr;
  }
  const double tube_mm = tube_of(options, changed.file);
  auto original = trial::cut::Original::make(*path, other, tube_mm);
  if (!original && options.file.empty()) {  // its marks are paired, in a wider tube than most
    original = trial::cut::Original::make(*path, other, trial::cut::Original::kWidestTube_mm);
  }
  if (!original) {
    Refusal refusal = std::move(original.error());
    refusal.file = refusal.line > 0 ? changed.file : "--tube-mm";
    Answer answer;
    answer.refusals.push_back(std::move(refusal));
    answer.exit_code = kRefused;
    return std::unexpected(std::move(answer));
  }
  return std::make_shared<const trial::cut::Original>(std::move(*original));
}

std::string put_against(Answer& answer, const AgainstOptions& options,
                        const trial::cut::Original& original) {
  const bool by_marks = options.file.empty();
  answer.json["against"] = {{"program", by_marks ? Json(nullptr) : Json(options.file)},
                            {"by_marks", by_marks},
                            {"tube_mm", original.tube_mm},
                            {"farthest_mm", original.farthest_mm},
                            {"line", original.changed_line},
                            {"original_line", original.original_line}};
  return fmt::format(
      "errors are against the path of {}, from which this program is up to {:.1f} µm away (line "
      "{}, there line {})\n",
      by_marks ? std::string(kByMarks) : options.file,
      kernel::units::um_from_mm(original.farthest_mm), original.changed_line,
      original.original_line);
}

}  // namespace steadyrest::apps::cli::cut
