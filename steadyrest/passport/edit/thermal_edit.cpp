// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/passport/edit/thermal_edit.hpp>
#include <steadyrest/passport/edit/thermal_text.hpp>
#include <steadyrest/passport/file/thermal_passport.hpp>

namespace steadyrest::passport {
namespace {

using kernel::machine::Thermal;

std::string_view trimmed(std::string_view line) {
  const std::size_t from = line.find_first_not_of(" \t\r\n");
  return from == std::string_view::npos ? std::string_view{} : line.substr(from);
}

/// [thermal], [[thermal.axis]], …
bool heads_thermal(std::string_view line) {
  line.remove_prefix(std::min(line.find_first_not_of("[ \t"), line.size()));
  constexpr std::string_view kName = "thermal";
  return line.starts_with(kName) && line.size() > kName.size() &&
         (line[kName.size()] == '.' || line[kName.size()] == ']' || line[kName.size()] == ' ');
}

}  // namespace

kernel::outcome::Result<std::string> with_thermal(std::string_view text, const std::string& file,
                                                  const Thermal& thermal) {
  const std::string sections = thermal_text(thermal);
  std::string out;
  std::string kept;  // blank and comment lines that may belong to the next section
  bool inside = false;
  bool put = false;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end);
    const std::string_view content = trimmed(line);
    const bool head = content.starts_with('[');
    if (head && heads_thermal(content)) {
      out += put ? "" : sections;
      put = true;
      inside = true;
      kept.clear();
    } else if (head && inside) {
      inside = false;
      out += kept.empty() ? "\n" : kept;
      out += line;
    } else if (!inside) {
      out += line;
    } else if (content.empty() || content.starts_with('#')) {
      kept += line;
    } else {
      kept.clear();
    }
  }
  if (!put) {
    out += (out.empty() || out.ends_with('\n') ? "" : "\n");
    out += (out.empty() ? "" : "\n") + sections;
  }
  const auto again = parse_thermal_passport(out, file);
  if (!again) {
    return std::unexpected(again.error());
  }
  return out;
}

}  // namespace steadyrest::passport
