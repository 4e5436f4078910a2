// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>
#include <iostream>

#include <fmt/core.h>

#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/apps/cli/shared/usage.hpp>
#include <steadyrest/apps/page/shared/write_files.hpp>
#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/kernel/file/temporary.hpp>
#include <steadyrest/kernel/outcome/shown.hpp>

// One place for everything that all verbs do alike: parsing, checking files, provenance, running,
// putting all outputs in place together, printing, exit code.
namespace steadyrest::apps::cli {
namespace {

using kernel::outcome::Kind;

constexpr std::string_view kName = "steadyrest";

void print_refusals(const Refusals& refusals) {
  for (const Refusal& refusal : refusals) {
    fmt::print(stderr, "{}: {}\n", kName, kernel::outcome::text(refusal));
  }
}

Json as_json(const Refusals& refusals) {
  Json list = Json::array();
  for (const Refusal& refusal : refusals) {
    list.push_back({{"file", refusal.file},
                    {"line", refusal.line},
                    {"what", refusal.what},
                    {"to_do", refusal.to_do}});
  }
  return list;
}

/// 2 if any refusal concerns the input; a full disk alone is 1.
int exit_code_of(const Refusals& refusals) {
  for (const Refusal& refusal : refusals) {
    if (refusal.kind == Kind::bad_input) {
      return kRefused;
    }
  }
  return kFailed;
}

/// False when stdout did not take all of it (a full disk, a closed pipe). fflush shows what fwrite
/// only buffered.
bool print_out(std::string_view text) {
  return std::fwrite(text.data(), 1, text.size(), stdout) == text.size() &&
         std::fflush(stdout) == 0;
}

/// Indented by two: people read it too.
bool print_json(const Json& json) {
  // A file name need not be UTF-8; JSON must.
  return print_out(
      kernel::outcome::shown_json(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"));
}

int unwritten() {
  fmt::print(stderr,
             "{}: failed to write the answer to stdout; check the disk space and the pipe\n",
             kName);
  return kFailed;
}

}  // namespace

/// One refusal as the list that an Outcome carries.
std::unexpected<Refusals> refused(Refusal refusal) {
  Refusals list;
  list.push_back(std::move(refusal));
  return std::unexpected(std::move(list));
}

Session::Session() : app_("Steadyrest: the corrective layer for CNC machines", std::string(kName)) {
  app_.set_version_flag("--version", std::string(kName) + " " + STEADYREST_VERSION);
  // `steadyrest` alone is refused in one line that points to --help.
  app_.require_subcommand(1);
  app_.footer(
      "`steadyrest VERB --help` says more and ends with an example.\nExit codes: 0 done, 2 refused "
      "(bad usage, bad input), 1 anything else.");
}

/// A group is made by the first verb that asks for it.
void Session::group(const std::string& name, const std::string& description) {
  app_.add_subcommand(name, description)->require_subcommand(1);
}

Verb& Session::verb(const std::string& path, const std::string& description,
                    const std::vector<std::string>& examples) {
  const std::size_t blank = path.find(' ');
  CLI::App& parent =
      blank == std::string::npos ? app_ : *app_.get_subcommand(path.substr(0, blank));
  const auto owned = std::make_shared<Verb>(
      description, path.substr(blank == std::string::npos ? 0 : blank + 1), parent);
  parent.add_subcommand(owned);
  Verb& made = *owned;
  made.add_flag("--json", json_, "Print one JSON object, and nothing else, on stdout");
  std::string footer = "Example:";
  for (const std::string& example : examples) {
    footer += "\n  steadyrest " + path + " " + example;
  }
  made.footer(footer);
  return made;
}

/// CLI11 calls back while it still parses; the work waits until the whole line is known to be good.
void Session::on(Verb& verb, Run run) {
  verb.callback([this, &verb, run = std::move(run)] {
    chosen_ = &verb;
    run_ = run;
  });
}

/// The last net. Refusals travel as values; an exception here is a bug, and the message says so.
/// fprintf, because fmt may be what threw.
int Session::main(int argc, const char* const* argv) noexcept {
  try {
    // Ctrl-C must not leave temporary files next to the targets.
    kernel::file::remove_temporaries_on_signals();
    return parse_and_run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "steadyrest: internal error: %s; please report it\n", error.what());
  } catch (...) {
    std::fputs("steadyrest: internal error; please report it\n", stderr);
  }
  return kFailed;
}

int Session::parse_and_run(int argc, const char* const* argv) {
  // The command line for the report, before the parser takes it apart.
  command_ = page::command_of(argc, argv);
  try {
    app_.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return usage(error);
  }
  return run_verb();
}

int Session::usage(const CLI::ParseError& error) const {
  if (error.get_exit_code() == 0) {  // --help, --version
    app_.exit(error, std::cout, std::cerr);
    return std::cout.flush() ? kDone : unwritten();
  }
  const Refusal refusal = usage_refusal(app_, error);
  // With --json even a usage error is one object on stdout, if the parser got as far as --json.
  if (json_) {
    print_json({{"refused", as_json({refusal})}});
  }
  print_refusals({refusal});
  return kRefused;
}

/// Pages are written last, with their provenance. A single page (--page) has no data file.
Result<void> Session::write_pages(const std::vector<Page>& pages,
                                  const page::Provenance& provenance) const {
  for (const Page& page : pages) {
    page::Json data = page.data;
    page::put_provenance(data, provenance);
    const std::string json = page::text_of(data);
    if (page.folder.empty()) {
      if (auto done = kernel::file::write_file(page.file, page::to_html(json)); !done) {
        return done;
      }
    } else if (auto done = page::write_files(page::to_html(json), json, page.folder); !done) {
      return std::unexpected(std::move(done.error()));
    }
  }
  return {};
}

Outcome Session::work() const {
  // Outputs are checked before the work: an hour of computing must not end at a missing folder.
  const auto ready = chosen_->ready(json_);
  if (!ready) {
    return std::unexpected(ready.error());
  }
  // From here on commit() keeps each finished file next to its target. The last step renames all of
  // them or none, so a run that fails half-way leaves the old results intact.
  kernel::file::declare_outputs(ready->outputs);
  // Hashes are those of the inputs as read, not as they are after the work.
  const page::Provenance provenance = chosen_->provenance(command_);  // before the work
  Progress progress;
  Outcome outcome = run_(progress);
  progress.clear();
  if (outcome) {
    auto done = write_pages(outcome->pages, provenance);
    if (done) {
      done = kernel::file::put_outputs_in_place();
    }
    if (!done) {
      return refused(std::move(done.error()));
    }
  }
  if (!outcome || !chosen_->has_outputs()) {
    return outcome;
  }
  // When the result itself goes to stdout, a summary would corrupt it.
  if (ready->takes_stdout) {
    outcome->text.clear();
    return outcome;
  }
  Json& written = outcome->json["written"] = Json::array();
  for (const kernel::file::Written& one : kernel::file::written_files()) {
    written.push_back({{"file", one.file}, {"bytes", one.bytes}, {"lines", one.lines}});
    outcome->text += fmt::format("wrote {}: {} lines, {} bytes\n", one.file, one.lines, one.bytes);
  }
  return outcome;
}

/// Refusals to stderr, the answer to stdout; with --json one object on stdout in either case.
int Session::run_verb() {
  const Outcome outcome = work();
  if (!outcome) {
    print_refusals(outcome.error());
    if (json_ && !print_json({{"refused", as_json(outcome.error())}})) {
      return unwritten();
    }
    return exit_code_of(outcome.error());
  }
  if (!json_) {
    fmt::print(stderr, "{}", outcome->notes);
  }
  print_refusals(outcome->refusals);
  const bool written =
      json_ ? print_json(outcome->json) : print_out(kernel::outcome::shown_lines(outcome->text));
  return written ? outcome->exit_code : unwritten();
}

}  // namespace steadyrest::apps::cli
