// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <utility>

#include <nlohmann/json.hpp>
#include <toml++/toml.h>

#include <steadyrest/apps/cli/shared/content.hpp>

// Judges a file by its content, never by its name: what would be lost by overwriting it?
namespace steadyrest::apps::cli {
namespace {

bool among(std::string_view key, const std::vector<std::string>& keys) {
  return std::ranges::find(keys, key) != keys.end();
}

/// Keys and sections of the top level; none if the text is not TOML. A file may be cut off at the
/// reader's limit, and half a table parses as nothing.
std::vector<std::string> top_of(std::string_view text) {
  std::vector<std::string> out;
  try {
    for (const auto& [key, value] : toml::parse(text)) {
      out.emplace_back(key.str());
    }
  } catch (const toml::parse_error&) {
    out.clear();
  }
  return out;
}

/// A line that could be a block of some dialect: `N10 G1 X1`, `/G0`, `X=R1`, `#1=2`, `o<a> call`,
/// `%`, `(…)`, `;…`. Prose lacks a letter followed by a digit, a sign or an assignment.
bool is_block(std::string_view line) {
  const auto is = [&line](std::size_t at, std::string_view set) {
    return at < line.size() && set.find(line[at]) != std::string_view::npos;
  };
  if (is(0, "%(;#/:")) {
    return true;
  }
  const auto letter = [&line](std::size_t at) {
    return at < line.size() && std::isalpha(static_cast<unsigned char>(line[at])) != 0;
  };
  const std::size_t next = line.find_first_not_of(" \t", 1);
  return letter(0) && (line.size() == 1 || is(next, "0123456789+-.#[=<"));
}

std::string_view trimmed(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  return first == std::string_view::npos
             ? std::string_view{}
             : line.substr(first, line.find_last_not_of(" \t\r") - first + 1);
}

/// Half of the first 200 lines that are not empty: programs have headers of free text, and texts
/// have a line or two that look like blocks.
bool is_program(std::string_view text) {
  constexpr std::size_t kLooked = 200;
  std::size_t lines = 0;
  std::size_t blocks = 0;
  while (!text.empty() && lines < kLooked) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    lines += line.empty() ? 0U : 1U;
    blocks += !line.empty() && is_block(line) ? 1U : 0U;
  }
  return blocks > 0 && 2 * blocks >= lines;
}

}  // namespace

Content csv_content(std::string name, std::vector<std::string> heads) {
  return {std::move(name), [heads = std::move(heads)](std::string_view text) {
            return std::ranges::any_of(
                heads, [text](const std::string& head) { return text.starts_with(head); });
          }};
}

/// TOML of one kind has only its own keys; one foreign section and it is somebody else's file.
Content toml_content(std::string name, std::vector<std::string> only) {
  return {std::move(name), [only = std::move(only)](std::string_view text) {
            const auto top = top_of(text);
            return !top.empty() && std::ranges::all_of(top, [&only](const std::string& key) {
              return among(key, only);
            });
          }};
}

Content machine_content() {
  return {"a machine file or a thermal passport", [](std::string_view text) {
            const auto top = top_of(text);
            return among("axis", top) || among("thermal", top);
          }};
}

/// One axis has `transitions` on the top level, several have `axes`.
Content plan_content() {
  return {"a plan of corrections", [](std::string_view text) {
            const auto json = nlohmann::json::parse(text, nullptr, false);
            return json.is_object() && (json.contains("transitions") || json.contains("axes"));
          }};
}

/// A page is known by its title; the data element lies megabytes further down.
Content page_content() {
  return {"a page of Steadyrest", [](std::string_view text) {
            constexpr std::size_t kHead = 1024;
            return text.starts_with("<!doctype html>") &&
                   text.substr(0, kHead).find("<title>Steadyrest") != std::string_view::npos;
          }};
}

/// Data begin with their schema, `steadyrest-…/1`.
Content page_data_content() {
  return {"the data of a report of Steadyrest", [](std::string_view text) {
            constexpr std::size_t kHead = 64;
            return text.starts_with('{') &&
                   text.substr(0, kHead).find("\"steadyrest-") != std::string_view::npos;
          }};
}

Content program_content() {
  return {"an NC program", is_program};
}

Content either(Content one, Content other) {
  std::string name = one.name + " or " + other.name;
  return {std::move(name), [one = std::move(one), other = std::move(other)](std::string_view text) {
            return one.fits(text) || other.fits(text);
          }};
}

}  // namespace steadyrest::apps::cli
