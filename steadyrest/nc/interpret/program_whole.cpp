// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/interpret/program.hpp>

// Programs from their first line to their last.
namespace steadyrest::nc::interpret {

using read::LineSource;

kernel::outcome::Result<Report> run_lines(LineSource& source, const Config& config, Sink& sink) {
  auto run = ProgramRun::make(source, config, sink);
  if (!run) {
    return std::unexpected(run.error());
  }
  while (run->step()) {
  }
  return run->take();
}

kernel::outcome::Result<Report> run_file(const std::string& path, const Config& config,
                                         Sink& sink) {
  auto source = LineSource::open(path);
  if (!source) {
    return std::unexpected(source.error());
  }
  return run_lines(*source, config, sink);
}

kernel::outcome::Result<Report> run_text(std::string_view text, const Config& config, Sink& sink) {
  LineSource source = LineSource::from_text(text);
  return run_lines(source, config, sink);
}

namespace {

/// A fault that neither another dialect nor another word would fix has its own remedy.
std::string remedy_of(const read::Refused& refused) {
  struct Remedy {
    std::string_view reason;
    const char* to_do;
  };
  constexpr std::array kRemedies = {
      Remedy{"byte_order_mark", "editors call that UTF-8 without BOM"},
      Remedy{"line_too_long", "give the text of an NC program, one block a line"},
      Remedy{"control_character", "copy the program from its source once more"},
      Remedy{"read_failed", "copy the program from its source once more"},
      Remedy{"parameter_of_the_control", "give it a value in the program before it is read"},
      Remedy{"parameter_of_the_machine",
             "write the value into the program; what the control computes cannot be planned ahead"},
      Remedy{"no_program_end", "check that the file is whole"},
  };
  const auto* const found = std::ranges::find(kRemedies, refused.reason, &Remedy::reason);
  if (found != kRemedies.end()) {
    return found->to_do;
  }
  // Both byte order marks of UTF-16, raw or as the reader shows them.
  for (const std::string_view mark : {"\xff", "\xfe", "\\xff", "\\xfe"}) {
    if (refused.reason == "not_ascii" && refused.line == 1 && refused.word.starts_with(mark)) {
      return "this is UTF-16: save the program as plain text, ASCII or UTF-8";
    }
  }
  return refused.reason == "not_ascii"
             ? "write it in ASCII; other characters may stand in comments"
             : "change this line, or choose the dialect that the program was written for";
}

}  // namespace

// A verb shows only the first refusal, since later ones may follow from it.
kernel::outcome::Refusal first_refusal(const Report& report, const std::string& path) {
  if (report.refused.empty()) {
    return {};
  }
  const read::Refused& first = report.refused.front();
  return kernel::outcome::bad_input(
      first.file.empty() ? path : first.file, first.line,
      first.word.empty() ? first.text : "`" + first.word + "`: " + first.text, remedy_of(first));
}

}  // namespace steadyrest::nc::interpret
