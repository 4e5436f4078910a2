// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>

#include <steadyrest/adapters/linuxcnc/config/text_lines.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::linuxcnc::config {
namespace {

constexpr std::string_view kBlank = " \t\r\n\v\f";

}  // namespace

kernel::outcome::Result<std::string> read_text(const std::string& path) {
  using kernel::outcome::refuse;
  constexpr std::size_t kMost = std::size_t{4} << 20U;
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    return refuse(path, "is a folder", "name the file in it");
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    return refuse(path, "cannot be read", "check the name and the permissions");
  }
  std::string text(kMost + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > kMost) {
    return refuse(path, "is larger than 4 MB", "name a file of a LinuxCNC configuration");
  }
  if (text.find('\0') != std::string::npos) {
    return refuse(path, "is a binary file: it has a byte 0",
                  "name a text file of a LinuxCNC configuration");
  }
  return text;
}

std::string_view trimmed(std::string_view text) noexcept {
  const std::size_t first = text.find_first_not_of(kBlank);
  return first == std::string_view::npos
             ? std::string_view{}
             : text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> out;
  bool inside = false;
  bool quoted = false;
  for (const char c : text) {
    if (c == '"') {
      quoted = !quoted;
    }
    const bool blank = !quoted && kBlank.find(c) != std::string_view::npos;
    if (!blank && !inside) {
      out.emplace_back();
    }
    inside = !blank;
    if (!blank && c != '"') {
      out.back() += c;
    }
  }
  return out;
}

std::vector<LogicalLine> logical_lines(std::string_view text) {
  std::vector<LogicalLine> out;
  bool goes_on = false;
  std::size_t number = 0;
  for (const std::string& line : lines_of(text)) {
    ++number;
    std::string_view body(line);
    while (!body.empty() && (body.back() == '\n' || body.back() == '\r')) {
      body.remove_suffix(1);
    }
    if (!goes_on) {
      out.push_back({.first = number, .last = number, .text = {}});
    }
    goes_on = body.ends_with('\\');
    out.back().text += body.substr(0, body.size() - (goes_on ? 1 : 0));
    out.back().last = number;
  }
  return out;
}

}  // namespace steadyrest::adapters::linuxcnc::config
