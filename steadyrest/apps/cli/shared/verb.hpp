// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <steadyrest/apps/cli/shared/content.hpp>
#include <steadyrest/apps/cli/shared/value_check.hpp>
#include <steadyrest/apps/page/shared/provenance.hpp>
#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/kernel/file/place.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::apps::cli {

using Refusals = std::vector<kernel::outcome::Refusal>;

/// A file that will be written.
struct PlannedFile {
  std::string file;
  Content content;
};

/// A file that is read, and how the user gave it.
struct Input {
  std::string file;
  std::string role;  ///< `the log itself`, `the file of --plan itself`
};

/// What is known before the work.
struct Ready {
  std::vector<std::string> outputs;
  std::vector<kernel::file::MadeFolders> folders;  ///< of reports; an empty one is removed again
  bool takes_stdout = false;                       ///< an output is the same file as stdout
};

/// A verb with the files that it reads and writes, so that one place checks them before the work.
///
/// Refused are an empty name; an output that cannot be written; two outputs that are one file; an
/// output on stdout together with --json; and without --force an output that is an input, or that
/// replaces a file of another kind.
class Verb : public CLI::App {
 public:
  using Files = std::function<std::vector<PlannedFile>(const std::string& given)>;

  Verb(std::string description, std::string name, CLI::App& parent)
      : CLI::App(std::move(description), std::move(name), &parent) {}

  /// An option or argument with a value; see check_value().
  template <class Value>
  CLI::Option* add_option(const std::string& flags, Value& value, const std::string& description) {
    CLI::Option* const option = CLI::App::add_option(flags, value, description);
    check_value(*option);
    return option;
  }

  /// An option or argument that names a file to read (`-` is stdin), a folder, or several. An empty
  /// name is refused by ready().
  template <class Path>
  CLI::Option* reads(const std::string& flags, Path& path, const std::string& description) {
    CLI::Option* const option = CLI::App::add_option(flags, path, description);
    inputs_.push_back(option->type_name("FILE"));
    return option;
  }
  /// Files that an input names; requested before the work.
  void also_reads(std::function<std::vector<std::string>()> files) {
    named_.push_back(std::move(files));
  }

  CLI::Option* writes(const std::string& flags, std::string& path, const std::string& description,
                      Content content);
  /// The same for an option that leads to several files.
  CLI::Option* writes(const std::string& flags, std::string& path, const std::string& description,
                      Files files);
  /// An option for a single page.
  void writes_page(const std::string& flags, std::string& path, const std::string& description);
  /// --report DIR for report.html and report.json, or what `files` says.
  void reports(std::string& folder, Files files = {});

  /// How the requested reports are made; empty if there are none.
  [[nodiscard]] page::Provenance provenance(const std::string& command) const;

  [[nodiscard]] bool has_outputs() const noexcept { return !outputs_.empty(); }
  [[nodiscard]] std::expected<Ready, Refusals> ready(bool json) const;

 private:
  struct Output {
    CLI::Option* option = nullptr;
    Files files;
    bool folder = false;
    bool page = false;  ///< a report, which says how it was made
  };
  CLI::Option* add_output(const std::string& flags, std::string& path,
                          const std::string& description, Files files, bool folder);
  void dates_last_output();
  [[nodiscard]] Refusals empty_names() const;
  [[nodiscard]] std::vector<Input> inputs() const;
  /// The files to be written; makes the folders of reports.
  [[nodiscard]] std::expected<std::vector<PlannedFile>, Refusals> plan(Ready& ready) const;

  std::vector<CLI::Option*> inputs_;
  std::vector<std::function<std::vector<std::string>()>> named_;
  std::vector<Output> outputs_;
  std::string date_;  ///< --report-date
  bool force_ = false;
};

/// Where a table goes: to its file, else to stdout, unless that belongs to the JSON object.
[[nodiscard]] kernel::outcome::Result<kernel::file::OutputFile> table_output(
    const std::string& output, bool json);

/// report.html and report.json in this folder.
[[nodiscard]] std::vector<PlannedFile> report_files(const std::string& folder);

}  // namespace steadyrest::apps::cli
