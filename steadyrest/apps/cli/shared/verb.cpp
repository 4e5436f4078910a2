// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/shared/verb.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

// A verb declares which options name inputs and outputs. All file checks then happen in one place,
// for all outputs at once, before the work starts.
namespace steadyrest::apps::cli {
namespace {

using kernel::file::Place;
using kernel::outcome::bad_input;
using kernel::outcome::Refusal;

constexpr std::string_view kNoDate = "none";

/// The file itself; for a folder the files in it, sorted, so that provenance does not depend on the
/// order of the directory.
std::vector<std::string> files_in(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) {
    return {path};
  }
  std::vector<std::string> out;
  for (const auto& entry : std::filesystem::directory_iterator(path, error)) {
    if (entry.is_regular_file(error)) {
      out.push_back(entry.path().string());
    }
  }
  std::ranges::sort(out);
  return out;
}

/// The input's name in the refusal: its option, or its positional argument.
std::string role_of(const CLI::Option& option) {
  return option.get_positional() && option.get_lnames().empty()
             ? (option.get_name() == "FILE" ? "the input file itself"
                                            : "the " + option.get_name() + " itself")
             : "the file of " + option.get_name() + " itself";
}

/// A named pipe is read once, and holds up who opens it until somebody writes; a verb may read its
/// inputs twice. The pipes of a shell, `<(…)` and `|`, have their writer.
Refusals unreadable(const std::vector<std::string>& files) {
  Refusals out;
  for (const std::string& file : files) {
    const bool of_shell = file == "-" || file.starts_with("/dev/") || file.starts_with("/proc/");
    std::error_code error;
    const auto kind = std::filesystem::status(file, error).type();
    const bool pipe = kind == std::filesystem::file_type::fifo && !of_shell;
    if (pipe || kind == std::filesystem::file_type::socket) {
      out.push_back(bad_input(file, pipe ? "is a named pipe" : "is a socket",
                              "write it into a file first, and give that"));
    }
  }
  return out;
}

/// The existing content: 8 MB are enough to tell its kind, and a huge file is not read whole.
std::string text_of(const std::filesystem::path& file) {
  constexpr std::size_t kMost = std::size_t{8} << 20U;
  std::ifstream in(file, std::ios::binary);
  std::string text(kMost, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
  return text;
}

std::optional<Refusal> of_another_kind(const PlannedFile& planned, const Place& place) {
  if (place.kind != Place::Kind::file || !place.exists) {
    return std::nullopt;
  }
  const std::string text = text_of(place.path);
  // An empty file holds nothing worth keeping.
  if (text.empty() || planned.content.fits(text)) {
    return std::nullopt;
  }
  return bad_input(planned.file, fmt::format("exists and is not {}", planned.content.name),
                   "name another file, or give --force to replace this one");
}

/// By identity of the file, not by name: links and relative paths lead to the same place.
std::optional<Refusal> an_input(const PlannedFile& planned, const std::vector<Input>& inputs) {
  for (const Input& input : inputs) {
    if (kernel::file::same_place(planned.file, input.file)) {
      return bad_input(planned.file, "is " + input.role,
                       "name another file, or give --force to replace this one");
    }
  }
  return std::nullopt;
}

/// The first fault of one output. Two outputs in one file are never right; --force permits the
/// rest. "-" is refused even so: it would silently become a file of that name.
std::optional<Refusal> unfit(const PlannedFile& planned, std::span<const PlannedFile> before,
                             const std::vector<Input>& inputs, bool force) {
  for (const PlannedFile& other : before) {
    if (kernel::file::same_place(planned.file, other.file)) {
      return bad_input(planned.file, fmt::format("is the same file as the output {}", other.file),
                       "give each output a different name");
    }
  }
  const auto place = kernel::file::place_of(planned.file);
  if (!place) {
    return place.error();
  }
  if (planned.file == "-") {
    return bad_input(planned.file, "would be a file called -",
                     "write /dev/stdout for stdout, or ./- for that file");
  }
  if (force) {
    return std::nullopt;
  }
  auto fault = an_input(planned, inputs);
  return fault ? fault : of_another_kind(planned, *place);
}

}  // namespace

kernel::outcome::Result<kernel::file::OutputFile> table_output(const std::string& output,
                                                               bool json) {
  if (output.empty() && !json) {
    return kernel::file::OutputFile::standard_output();
  }
  // With --json and no -o the rows have nowhere to go; /dev/null keeps one code path.
  return kernel::file::OutputFile::open(output.empty() ? "/dev/null" : output);
}

std::vector<PlannedFile> report_files(const std::string& folder) {
  const std::filesystem::path in(folder);
  return {{(in / "report.html").string(), page_content()},
          {(in / "report.json").string(), page_data_content()}};
}

/// One option may name several files, which `files` lists.
CLI::Option* Verb::add_output(const std::string& flags, std::string& path,
                              const std::string& description, Files files, bool folder) {
  CLI::Option* const option =
      CLI::App::add_option(flags, path, description)->type_name(folder ? "DIR" : "OUT");
  // --force belongs to every verb that writes, once.
  if (outputs_.empty()) {
    add_flag("--force", force_, "Let an output replace an input or a file of another kind");
  }
  outputs_.push_back({.option = option, .files = std::move(files), .folder = folder});
  return option;
}

CLI::Option* Verb::writes(const std::string& flags, std::string& path,
                          const std::string& description, Content content) {
  return writes(flags, path, description, [content = std::move(content)](const std::string& given) {
    return std::vector<PlannedFile>{{given, content}};
  });
}

CLI::Option* Verb::writes(const std::string& flags, std::string& path,
                          const std::string& description, Files files) {
  return add_output(flags, path, description, std::move(files), false);
}

void Verb::reports(std::string& folder, Files files) {
  add_output("--report", folder, "Folder for report.html and report.json; created if missing",
             files ? std::move(files) : report_files, true);
  dates_last_output();
}

void Verb::writes_page(const std::string& flags, std::string& path,
                       const std::string& description) {
  writes(flags, path, description, page_content());
  dates_last_output();
}

/// A page says when it was made. A fixed date, or none, makes repeated runs byte-identical for
/// tests and archives.
void Verb::dates_last_output() {
  outputs_.back().page = true;
  add_option(
      "--report-date", date_,
      "Date in the report instead of now: ISO 8601, or none to make repeated runs byte-identical")
      ->check([](const std::string& given) {
        return given == kNoDate || page::is_iso_date(given)
                   ? std::string{}
                   : given + " is neither a date (2026-01-02T03:04:05Z) nor none";
      });
}

page::Provenance Verb::provenance(const std::string& command) const {
  page::Provenance out;
  // Hashing large inputs is worth its time only if a page will show it.
  if (std::ranges::none_of(outputs_,
                           [](const Output& o) { return o.page && o.option->count() > 0; })) {
    return out;
  }
  if (date_ != kNoDate) {
    out.date = date_.empty() ? page::now_utc() : date_;
  }
  out.command = command;
  for (const Input& input : inputs()) {
    for (const std::string& file : files_in(input.file)) {
      out.inputs.push_back({file, page::sha256_of_file(file)});
    }
  }
  return out;
}

/// An empty name is nearly always an unset shell variable, and "" would mean the current folder.
/// Also inputs that are no files.
Refusals Verb::empty_names() const {
  Refusals out;
  const auto look = [&out](const CLI::Option& option, const char* to_do) {
    if (std::ranges::find(option.results(), "") != option.results().end()) {
      out.push_back(bad_input(option.get_name() + " is empty", to_do));
    }
  };
  for (const CLI::Option* option : inputs_) {
    look(*option, "name a file");
    std::ranges::copy(unreadable(option->results()), std::back_inserter(out));
  }
  for (const Output& output : outputs_) {
    look(*output.option, output.folder ? "name a folder" : "name a file");
  }
  return out;
}

std::vector<Input> Verb::inputs() const {
  std::vector<Input> out;
  for (const CLI::Option* option : inputs_) {
    for (const std::string& file : option->results()) {
      out.push_back({file == "-" ? "/dev/stdin" : file, role_of(*option)});
    }
  }
  // A process file names its measured responses, a plan its machine: they count as inputs.
  for (const auto& named : named_) {
    for (std::string& file : named()) {
      out.push_back({std::move(file), "a file that an input names"});
    }
  }
  return out;
}

/// All files that the given options will produce.
std::expected<std::vector<PlannedFile>, Refusals> Verb::plan(Ready& ready) const {
  std::vector<PlannedFile> out;
  for (const Output& output : outputs_) {
    for (const std::string& given : output.option->results()) {
      for (PlannedFile& file : output.files(given)) {
        // The folder is made now, so that a report cannot fail after the work for lack of one.
        // `ready` removes it again if the verb is refused.
        if (output.folder) {
          auto made =
              kernel::file::MadeFolders::make(std::filesystem::path(file.file).parent_path());
          if (!made) {
            return std::unexpected(Refusals{std::move(made.error())});
          }
          ready.folders.push_back(std::move(*made));
        }
        out.push_back(std::move(file));
      }
    }
  }
  return out;
}

/// Empty names, planned files, then each file against inputs, other outputs and what it would
/// replace. All faults are reported at once.
std::expected<Ready, Refusals> Verb::ready(bool json) const {
  Refusals refusals = empty_names();
  if (!refusals.empty()) {
    return std::unexpected(std::move(refusals));
  }
  Ready out;
  auto planned = plan(out);
  if (!planned || planned->empty()) {
    return planned ? std::expected<Ready, Refusals>(std::move(out))
                   : std::unexpected(std::move(planned.error()));
  }
  const std::vector<Input> read = inputs();
  for (auto file = planned->begin(); file != planned->end(); ++file) {
    if (auto fault = unfit(*file, {planned->begin(), file}, read, force_)) {
      refusals.push_back(std::move(*fault));
    }
    const auto place = kernel::file::place_of(file->file);
    out.outputs.push_back(file->file);
    out.takes_stdout |= place && place->kind == Place::Kind::standard_output;
  }
  if (out.takes_stdout && json) {
    // stdout can belong to only one of the two.
    refusals.push_back(bad_input("an output goes to stdout, where --json prints its object",
                                 "name a file for the output, or leave out --json"));
  }
  if (!refusals.empty()) {
    return std::unexpected(std::move(refusals));
  }
  return out;
}

}  // namespace steadyrest::apps::cli
