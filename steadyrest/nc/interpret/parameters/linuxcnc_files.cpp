// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <string_view>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/interpret/parameters/linuxcnc_files.hpp>
#include <steadyrest/nc/interpret/state/step.hpp>
#include <steadyrest/nc/read/text/line_source.hpp>
#include <steadyrest/nc/read/text/number.hpp>
#include <steadyrest/nc/read/text/refused.hpp>

namespace steadyrest::nc::interpret {
namespace {

using kernel::outcome::refuse;
using kernel::outcome::Result;
using read::LineSource;

std::string_view without_comment(std::string_view line) noexcept {
  return line.substr(0, line.find(';'));
}

void skip_blanks(std::string_view& text) noexcept {
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
}

// Takes one `T1`-like word off the head of a line. False when there is none.
bool take_word(std::string_view& text, char& letter, double& value) noexcept {
  if (text.empty()) {
    return false;
  }
  // Clearing one bit capitalises a letter; LinuxCNC reads both.
  letter = static_cast<char>(static_cast<unsigned char>(text.front()) & 0xdfU);
  text.remove_prefix(1);
  const read::Number number = read::read_number(text);
  text.remove_prefix(number.length);
  value = number.value;
  return number.length != 0;
}

// One tool per line: words in any order, lengths in the units of the machine's files, angles in
// degrees. I, J and Q are a lathe tool's: front angle, back angle, orientation of its edge. The
// pocket (P) moves nothing.
Result<Tool> tool_from(const std::string& path, std::size_t line, std::string_view text,
                       double unit_mm) {
  Tool tool;
  bool numbered = false;
  for (skip_blanks(text); !text.empty(); skip_blanks(text)) {
    char letter = 0;
    double value = 0.0;
    const std::string_view before = text;
    if (!take_word(text, letter, value)) {
      return refuse(path, line, "`" + read::printable(before) + "` is not a word of a tool table",
                    "write letters with numbers, like T1 P1 Z12.5 D6");
    }
    const auto axis = kAxisLetters.find(letter);
    const bool edge = value == std::floor(value) && value >= 0.0 && value <= 9.0;
    if (letter == 'Q' && !edge) {
      return refuse(path, line, "`" + read::printable(before) + "` is no orientation of a tool",
                    "write Q0 to Q9");
    }
    if (letter == 'T' && value == std::floor(value) && value >= 0.0 && value < 1e9) {
      tool.number = static_cast<std::int32_t>(value);
      numbered = true;
    } else if (letter == 'D') {
      tool.diameter_mm = value * unit_mm;
    } else if (axis != std::string_view::npos) {
      tool.offset[axis] = is_rotary(axis) ? value : value * unit_mm;
    } else if (letter == 'I' || letter == 'J') {
      (letter == 'I' ? tool.front_angle_deg : tool.back_angle_deg) = value;
    } else if (letter == 'Q') {
      tool.orientation = static_cast<std::int32_t>(value);
    } else if (letter != 'P') {
      return refuse(path, line, "`" + read::printable(before) + "` is not a word of a tool table",
                    "T (a whole number), P, X Y Z A B C U V W, D, I, J and Q are allowed");
    }
  }
  if (!numbered) {
    return refuse(path, line, "a tool without its number", "begin the line with T and the number");
  }
  return tool;
}

}  // namespace

// `;` begins a comment; a tool without a number is refused, since every line depends on the number.
Result<std::vector<Tool>> read_tool_table(const std::string& path, double unit_mm) {
  auto source = LineSource::open(path);
  if (!source) {
    return std::unexpected(source.error());
  }
  std::vector<Tool> tools;
  for (;;) {
    const auto status = source->next();
    if (status == LineSource::Status::end) {
      return tools;
    }
    if (status != LineSource::Status::line) {
      return refuse(path, source->number(), "a line that cannot be read", "name a tool table");
    }
    std::string_view text = without_comment(source->line());
    skip_blanks(text);
    // Comments and blank lines.
    if (text.empty()) {
      continue;
    }
    auto tool = tool_from(path, source->number(), text, unit_mm);
    if (!tool) {
      return std::unexpected(tool.error());
    }
    tools.push_back(*tool);
  }
}

namespace {

// LinuxCNC's numbering: nine values from 5161 (G28), 5181 (G30) and 5211 (G92); work offset n from
// 5221 + 20·(n − 1), its rotation after the nine values.
bool put_variable(Config& config, int number, double value, double unit_mm) {
  // 5161 and so on are absolute numbers; a slot is the place within its group of nine or twenty.
  const auto slot = [&](int first) { return static_cast<std::size_t>(number - first); };
  const auto scaled = [&](std::size_t axis) { return is_rotary(axis) ? value : value * unit_mm; };
  const auto in = [&](int first) { return number >= first && number < first + 9; };
  if (in(5161)) {
    config.home[0][slot(5161)] = scaled(slot(5161));
  } else if (in(5181)) {
    config.home[1][slot(5181)] = scaled(slot(5181));
  } else if (in(5211)) {
    config.g92[slot(5211)] = scaled(slot(5211));
  } else if (number == 5220) {
    // The file counts the systems from 1 (G54).
    if (!(value >= 1.0 && value <= 9.0)) {
      return false;
    }
    config.active_offset = static_cast<std::size_t>(value) - 1;
  } else if (number >= 5221 && number < 5221 + 9 * 20) {
    const auto set = slot(5221) / 20;
    const auto axis = slot(5221) % 20;
    if (axis < kAxisLetters.size()) {
      config.work_offset[set][axis] = scaled(axis);
    } else if (axis == kAxisLetters.size()) {
      config.rotation_deg[set] = value;
    }
  } else {
    config.numbers.emplace_back(number, value);
  }
  return true;
}

}  // namespace

// `number value` per line, as LinuxCNC writes it. With this file the control's start is known.
Result<void> read_variables(const std::string& path, double unit_mm, Config& config) {
  auto source = LineSource::open(path);
  if (!source) {
    return std::unexpected(source.error());
  }
  for (;;) {
    const auto status = source->next();
    if (status == LineSource::Status::end) {
      break;
    }
    // A line that could not be read is not `number value` either: it is refused below.
    std::string_view text = status == LineSource::Status::line ? source->line() : "?";
    skip_blanks(text);
    if (text.empty()) {
      continue;
    }
    const read::Number number = read::read_number(text);
    text.remove_prefix(number.length);
    skip_blanks(text);
    const read::Number value = read::read_number(text);
    if (number.length == 0 || value.length == 0 || number.decimal_point) {
      return refuse(path, source->number(), "a line that is not `number value`",
                    "name LinuxCNC's variable file");
    }
    // Numbers that no parameter has are skipped.
    if (number.value < 1.0 || number.value > 1e5) {
      continue;
    }
    const int index = static_cast<int>(number.value);
    // 5210 tells whether the G92 after it is in force or only stored.
    config.g92_on = config.g92_on || (index == 5210 && value.value != 0.0);
    if (!put_variable(config, index, value.value, unit_mm)) {
      return refuse(path, source->number(), "an active coordinate system that does not exist",
                    "set number 5220 to 1–9");
    }
  }
  config.start_known = true;
  return {};
}

}  // namespace steadyrest::nc::interpret
