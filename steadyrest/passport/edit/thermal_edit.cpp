// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/passport/edit/thermal_edit.hpp>
#include <steadyrest/passport/edit/thermal_text.hpp>
#include <steadyrest/passport/file/thermal_passport.hpp>

// Replaces the [thermal] sections of a machine file and keeps every other byte. It works on lines,
// since this program writes those sections and they hold nothing of the user's.
namespace steadyrest::passport {
namespace {

using kernel::machine::Thermal;

std::string_view trimmed(std::string_view line) {
  const std::size_t from = line.find_first_not_of(" \t\r\n");
  return from == std::string_view::npos ? std::string_view{} : line.substr(from);
}

/// [thermal], [[thermal.axis]], …
/// The name must end there: [thermalx] is another section, [thermal.axis] is not.
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
  // Comments behind the last thermal section may be the header of the next one. They wait in `kept`
  // and are dropped only if another thermal key follows.
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
      // The new sections go in place of the first thermal head; the rest of the old ones vanish.
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
  // A file without [thermal] gets it at its end, after a blank line.
  if (!put) {
    out += (out.empty() || out.ends_with('\n') ? "" : "\n");
    out += (out.empty() ? "" : "\n") + sections;
  }
  // The result must read back as a passport; inline tables and other notations that the line scan
  // does not know are refused here.
  const auto again = parse_thermal_passport(out, file);
  if (!again) {
    return std::unexpected(again.error());
  }
  return out;
}

}  // namespace steadyrest::passport
