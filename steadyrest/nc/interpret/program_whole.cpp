// SPDX-License-Identifier: Apache-2.0
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

// A verb has one refusal to show: the first, since those behind it may follow from it.
kernel::outcome::Refusal first_refusal(const Report& report, const std::string& path) {
  if (report.refused.empty()) {
    return {};
  }
  const read::Refused& first = report.refused.front();
  return kernel::outcome::bad_input(
      first.file.empty() ? path : first.file, first.line,
      first.word.empty() ? first.text : "`" + first.word + "`: " + first.text,
      "change this line, or choose the dialect that the program was written for");
}

}  // namespace steadyrest::nc::interpret
