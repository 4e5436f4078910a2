// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>

#include <fmt/core.h>

#include <steadyrest/adapters/linuxcnc/config/ini_file.hpp>
#include <steadyrest/adapters/linuxcnc/config/text_lines.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

// As LinuxCNC's own reader takes it; what that skips (a line without `=`) is skipped here too.
namespace steadyrest::adapters::linuxcnc::config {

using kernel::outcome::refuse;
using kernel::outcome::Result;

std::string IniEntry::text() const {
  return fmt::format("[{}] {} = {}", section, key, value);
}

/// Takes in the lines of the INI file and of what it includes, in order.
class IniReader {
 public:
  explicit IniReader(IniFile& out) : out_(out) {}

  Result<void> top(std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf")) {
      text.remove_prefix(3);
    }
    for (const LogicalLine& line : logical_lines(text)) {
      const auto words = words_of(line.text);
      if (!words.empty() && words.front() == "#INCLUDE") {
        if (auto done = include(words, line); !done) {
          return done;
        }
      } else {
        take(line, out_.path_, line.last, false);
      }
      out_.section_after_.resize(line.last + 1, now());
    }
    if (out_.sections_.empty()) {
      return refuse(out_.path_, std::size_t{1}, "is not an INI file: no line is a [SECTION]",
                    "name the INI file that LinuxCNC is started with");
    }
    return {};
  }

 private:
  [[nodiscard]] int now() const { return static_cast<int>(out_.sections_.size()) - 1; }

  /// A file beside the INI file; `~` is the home folder. LinuxCNC goes on without a file that is
  /// missing, and what then runs is not the configuration that was meant.
  Result<void> include(const std::vector<std::string>& words, const LogicalLine& line) {
    if (words.size() != 2) {
      return refuse(out_.path_, line.first, "#INCLUDE needs one file name",
                    "write #INCLUDE FILE, or delete the line");
    }
    std::string name = words[1];
    const char* const home = std::getenv("HOME");
    if (name.starts_with("~/") && home != nullptr) {
      name = home + name.substr(1);
    }
    const auto path = std::filesystem::path(out_.path_).parent_path() / name;
    const auto text = read_text(path.string());
    if (!text) {
      return refuse(out_.path_, line.first,
                    fmt::format("#INCLUDE {}: {}", words[1], text.error().what),
                    "give the file, or delete the line");
    }
    out_.included_.push_back(path.string());
    // A further #INCLUDE in there is a comment to LinuxCNC.
    for (const LogicalLine& inner : logical_lines(*text)) {
      take(inner, path.string(), line.last, true);
    }
    return {};
  }

  void take(const LogicalLine& line, const std::string& file, std::size_t top_line, bool included) {
    const std::string_view text = trimmed(line.text);
    if (text.empty() || text.front() == '#' || text.front() == ';') {
      return;
    }
    if (text.front() == '[') {
      const std::size_t end = text.find(']');
      if (end != std::string_view::npos) {
        const std::string name(text.substr(1, end - 1));
        out_.sections_.push_back({name, top_line, seen_.insert(name).second});
      }
      return;
    }
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos || now() < 0 || !out_.sections_.back().first) {
      return;
    }
    out_.entries_.push_back({.section = out_.sections_.back().name,
                             .key = std::string(trimmed(text.substr(0, equals))),
                             .value = std::string(trimmed(text.substr(equals + 1))),
                             .file = file,
                             .line = line.first,
                             .top_line = top_line,
                             .included = included});
  }

  IniFile& out_;
  std::set<std::string> seen_;
};

Result<IniFile> IniFile::read(const std::string& path) {
  const auto text = read_text(path);
  return text ? parse(*text, path) : std::unexpected(text.error());
}

Result<IniFile> IniFile::parse(std::string_view text, const std::string& path) {
  IniFile out;
  out.path_ = path;
  if (auto read = IniReader(out).top(text); !read) {
    return std::unexpected(read.error());
  }
  return out;
}

const IniEntry* IniFile::find(std::string_view section, std::string_view key) const noexcept {
  const auto found = std::ranges::find_if(entries_, [&](const IniEntry& entry) {
    return entry.section == section && entry.key == key;
  });
  return found == entries_.end() ? nullptr : &*found;
}

std::vector<const IniEntry*> IniFile::all(std::string_view section, std::string_view key) const {
  std::vector<const IniEntry*> out;
  for (const IniEntry& entry : entries_) {
    if (entry.section == section && entry.key == key) {
      out.push_back(&entry);
    }
  }
  return out;
}

bool IniFile::has_section(std::string_view section) const noexcept {
  return section_line(section) != 0;
}

std::size_t IniFile::section_line(std::string_view section) const noexcept {
  const auto found = std::ranges::find(sections_, section, &Section::name);
  return found == sections_.end() ? 0 : found->top_line;
}

bool IniFile::in_section_after(std::size_t line, std::string_view section) const noexcept {
  if (line >= section_after_.size() || section_after_[line] < 0) {
    return false;
  }
  const Section& at = sections_[static_cast<std::size_t>(section_after_[line])];
  return at.first && at.name == section;
}

Result<std::optional<IniNumber>> IniFile::number(std::string_view section,
                                                 std::string_view key) const {
  const IniEntry* const entry = find(section, key);
  if (entry == nullptr) {
    return std::nullopt;
  }
  std::string_view text = entry->value;
  text.remove_prefix(text.starts_with('+') ? 1 : 0);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string_view rest = trimmed({end, text.data() + text.size()});
  if (error != std::errc{} || !std::isfinite(value) ||
      !(rest.empty() || rest.front() == '#' || rest.front() == ';')) {
    return refuse(entry->file, entry->line, fmt::format("{} is not a number", entry->text()),
                  fmt::format("write {} as a decimal number, such as 1.5", key));
  }
  return IniNumber{value, entry};
}

}  // namespace steadyrest::adapters::linuxcnc::config
