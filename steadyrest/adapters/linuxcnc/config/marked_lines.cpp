// SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include <fmt/core.h>

#include <steadyrest/adapters/linuxcnc/config/marked_lines.hpp>
#include <steadyrest/adapters/linuxcnc/config/text_lines.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::linuxcnc::config {
namespace {

using kernel::outcome::refuse;
using kernel::outcome::Result;

constexpr std::string_view kBegin = "# steadyrest begin ";
constexpr std::string_view kEnd = "# steadyrest end";
constexpr std::string_view kWas = "# was: ";
constexpr std::string_view kOwn = "# Written by `steadyrest linuxcnc setup";
constexpr std::string_view kSum = " Checksum ";
constexpr std::size_t kDigits = 8;

/// FNV-1a, 32 bits: against edits by mistake, not against intent.
std::string checksum(std::string_view text) {
  std::uint32_t hash = 2166136261U;
  for (const char c : text) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 16777619U;
  }
  return fmt::format("{:08x}", hash);
}

std::string begin_line(std::string_view inside, const std::string& ini_name) {
  return fmt::format("{}{}: `steadyrest linuxcnc setup {} --undo` takes this out", kBegin,
                     checksum(inside), ini_name);
}

std::string_view body(std::string_view line) {
  line.remove_suffix(line.ends_with('\n') ? 1 : 0);
  line.remove_suffix(line.ends_with('\r') ? 1 : 0);
  return line;
}

std::string_view without_newline(std::string_view line) {
  line.remove_suffix(line.ends_with('\n') ? 1 : 0);
  return line;
}

}  // namespace

std::string with_blocks(std::string_view text, const std::vector<Edit>& edits,
                        const std::string& ini_name) {
  const auto lines = lines_of(text);
  const std::string ending = !lines.empty() && lines.front().ends_with("\r\n") ? "\r\n" : "\n";
  std::string out;
  std::size_t at = 0;
  for (const Edit& edit : edits) {
    for (; at + 1 < edit.first && at < lines.size(); ++at) {
      out += lines[at];
    }
    // A last line without its end: the block brings one, and has none itself.
    bool open = !out.empty() && !out.ends_with('\n');
    out += open ? ending : "";
    std::string inside;
    for (std::size_t i = 0; i < edit.removed && at < lines.size(); ++i, ++at) {
      open |= !lines[at].ends_with('\n');
      inside += fmt::format("{}{}\n", kWas, without_newline(lines[at]));
    }
    for (const std::string& line : edit.added) {
      inside += line + ending;
    }
    out += begin_line(inside, ini_name) + ending + inside;
    out += kEnd;
    out += open ? "" : ending;
  }
  for (; at < lines.size(); ++at) {
    out += lines[at];
  }
  return out;
}

Result<Unmarked> without_blocks(std::string_view text, const std::string& file,
                                const std::string& ini_name) {
  constexpr const char* kRestore = "put the block back as setup wrote it, or take it out by hand";
  const auto lines = lines_of(text);
  Unmarked out;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (body(lines[i]) == kEnd) {
      return refuse(file, i + 1, "a block of steadyrest ends that has no beginning", kRestore);
    }
    if (!lines[i].starts_with(kBegin)) {
      out.text += lines[i];
      continue;
    }
    const std::size_t begin = i;
    std::string inside;
    std::string restored;
    std::vector<std::string> added;
    for (++i; i < lines.size() && body(lines[i]) != kEnd; ++i) {
      inside += lines[i];
      if (lines[i].starts_with(kWas)) {
        restored += lines[i].substr(kWas.size());
      } else {
        added.emplace_back(body(lines[i]));
      }
    }
    if (i == lines.size()) {
      return refuse(file, begin + 1, "this block of steadyrest has no end", kRestore);
    }
    if (checksum(inside) != lines[begin].substr(kBegin.size(), kDigits)) {
      return refuse(file, begin + 1,
                    "this block of steadyrest was edited since setup, so it cannot be undone "
                    "exactly",
                    kRestore);
    }
    if (body(lines[begin]) != begin_line(inside, ini_name)) {
      for (std::size_t j = begin; j <= i; ++j) {
        out.text += lines[j];
      }
      continue;
    }
    out.added.insert(out.added.end(), added.begin(), added.end());
    out.text += restored;
    if (!lines[i].ends_with('\n') && out.text.ends_with('\n')) {
      out.text.pop_back();
      // The end that the block brought; one that was replaced keeps its own.
      if (restored.empty() && out.text.ends_with('\r')) {
        out.text.pop_back();
      }
    }
    ++out.blocks;
  }
  return out;
}

std::size_t first_block(std::string_view text) {
  const auto lines = lines_of(text);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].starts_with(kBegin) || body(lines[i]) == kEnd) {
      return i + 1;
    }
  }
  return 0;
}

std::string own_file(std::string_view text, const std::string& ini_name) {
  return fmt::format("{} {}`; with --undo it is removed.{}{}\n{}", kOwn, ini_name, kSum,
                     checksum(text), text);
}

Own is_own_file(std::string_view text) {
  const std::string_view first = body(text.substr(0, std::min(text.find('\n'), text.size())));
  const std::size_t sum = first.rfind(kSum);
  if (!first.starts_with(kOwn) || sum == std::string_view::npos) {
    return Own::no;
  }
  const std::string_view rest = text.substr(std::min(text.find('\n') + 1, text.size()));
  return first.substr(sum + kSum.size()) == checksum(rest) ? Own::yes : Own::edited;
}

}  // namespace steadyrest::adapters::linuxcnc::config
