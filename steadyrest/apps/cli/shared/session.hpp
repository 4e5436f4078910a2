// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <steadyrest/apps/cli/shared/progress.hpp>
#include <steadyrest/apps/cli/shared/verb.hpp>
#include <steadyrest/apps/page/shared/page.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

/// What all verbs of the command line have in common: options, printing, exit codes.
namespace steadyrest::apps::cli {

using kernel::outcome::bad_input;
using kernel::outcome::Refusal;
using kernel::outcome::refuse;
using kernel::outcome::Result;
using Json = nlohmann::ordered_json;  // keys in the order in which the verb wrote them

inline constexpr int kDone = 0;
inline constexpr int kFailed = 1;   ///< anything that is not the user's mistake
inline constexpr int kRefused = 2;  ///< bad usage, bad input

/// A report to be written when the work is done; the session adds how it was made.
struct Page {
  std::string folder;  ///< for report.html and report.json …
  std::string file;    ///< … or, where it is empty, the page alone
  page::Json data;
};

/// A verb's result. A verb with something to show despite refusals fills `refusals` and sets
/// `exit_code` itself.
struct Answer {
  Json json = Json::object();  ///< the one object of --json
  std::string text;            ///< for people; ends with a newline
  std::string notes;           ///< for people, on stderr: what the answer rests on; likewise
  std::vector<Page> pages;     ///< of reports; the session writes them
  Refusals refusals;           ///< go to stderr, each as `steadyrest: FILE:LINE: what; what to do`
  int exit_code = kDone;
};
using Outcome = std::expected<Answer, Refusals>;

/// The verb's work. Progress goes through `progress`; nothing else may print.
using Run = std::function<Outcome(Progress& progress)>;

/// One refusal as the error of an Outcome, or of anything else that may have several.
[[nodiscard]] std::unexpected<Refusals> refused(Refusal refusal);

/// Holds the verb tree, parses the command line, runs the chosen verb and prints its answer.
class Session {
 public:
  Session();

  /// A word that only leads to verbs: `steadyrest contour …`. Call before adding its verbs.
  void group(const std::string& name, const std::string& description);
  /// A verb by its path: `cut`, or `contour limit`. --help ends with the path and each of the
  /// `examples`; they must work as written in the project's folder.
  Verb& verb(const std::string& path, const std::string& description,
             const std::vector<std::string>& examples);
  void on(Verb& verb, Run run);

  /// --json was given: stdout belongs to the answer's one object.
  [[nodiscard]] bool json() const noexcept { return json_; }

  /// Parses, runs, prints; returns the exit code. Nothing throws.
  int main(int argc, const char* const* argv) noexcept;

 private:
  int parse_and_run(int argc, const char* const* argv);
  int run_verb();
  [[nodiscard]] Outcome work() const;
  [[nodiscard]] Result<void> write_pages(const std::vector<Page>& pages,
                                         const page::Provenance& provenance) const;
  int usage(const CLI::ParseError& error) const;

  CLI::App app_;
  const Verb* chosen_ = nullptr;
  Run run_;
  std::string command_;  ///< as it was given
  bool json_ = false;
};

}  // namespace steadyrest::apps::cli
