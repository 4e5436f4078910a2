// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/passport/edit/calibration_text.hpp>
#include <steadyrest/passport/edit/text_edit.hpp>
#include <steadyrest/passport/file/contradictions.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/passport/keys/section_reader.hpp>
#include <steadyrest/passport/text/text_check.hpp>
#include <steadyrest/passport/text/text_file.hpp>

// Puts a learnt calibration into a machine file by editing its text. Comments, order and line ends
// survive because the bytes outside the edited values are never touched. The result is parsed again
// and compared with the old tree plus the new keys; if anything else differs, nothing is written.
namespace steadyrest::passport {
namespace {

using kernel::machine::Axis;
using kernel::machine::Encoder;
using kernel::machine::Machine;
using kernel::outcome::refuse;

/// Relative difference up to which two counts are the same: what ten printed digits lose.
constexpr double kSameCount = 1e-6;
constexpr double kDigit = 1e-5;      // of a count, for the lines
constexpr double kFineDigit = 1e-8;  // for the phases, whose sum must be 0
constexpr std::size_t kInARow = 16;

struct KeyValue {
  std::string name;
  std::string value;
};

/// With as many decimals as the step needs and no trailing zeros: a table of a million lines is the
/// bulk of the file.
void put_number(std::string& out, double value, double step) {
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step))), 0, 15);
  std::array<char, 64> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                 std::chars_format::fixed, decimals);
  std::string_view shown(digits.data(), end.ptr);
  if (shown.find('.') != std::string_view::npos) {
    shown = shown.substr(0, shown.find_last_not_of('0') + 1);
    shown = shown.substr(0, shown.size() - (shown.back() == '.' ? 1 : 0));
  }
  // Otherwise a tiny negative value would be written as -0.
  out += shown == "-0" ? std::string_view("0") : shown;
}

std::string list(std::span<const double> values, const Unit& unit, double step_mm) {
  const double step = unit.from_inner(step_mm);
  const bool rows = values.size() > kInARow;
  std::string out = "[";
  for (std::size_t i = 0; i < values.size(); ++i) {
    out += rows && i % kInARow == 0 ? "\n  " : i > 0 ? " " : "";
    put_number(out, unit.from_inner(values[i]), step);
    out += i + 1 < values.size() ? "," : rows ? ",\n" : "";
  }
  return out + "]";
}

std::vector<KeyValue> key_values(const Encoder& encoder, bool rotary) {
  const Unit& unit = unit_of(rotary ? "deg" : "um");
  const std::string suffix = rotary ? "_deg" : "_um";
  // The order here is the order in the file.
  std::vector<KeyValue> out;
  if (!encoder.phase_error_au.empty()) {
    out.push_back({"phase_error" + suffix,
                   list(encoder.phase_error_au, unit, kFineDigit * encoder.count_au)});
  }
  out.push_back({"line_table_first", fmt::format("{}", encoder.line_table_first)});
  out.push_back({"line_table_periodic", encoder.line_table_periodic ? "true" : "false"});
  if (!encoder.line_table_au.empty()) {
    out.push_back(
        {"line_table" + suffix, list(encoder.line_table_au, unit, kDigit * encoder.count_au)});
  }
  return out;
}

/// Where a section's new keys go: after its last plain value, or after its head. After a subsection
/// they would belong to that one.
std::size_t end_of(const toml::table& section, const Places& places) {
  std::size_t out = places.line_end(places.at(section.source().begin));
  for (const auto& [key, node] : section) {
    if (!node.is_table() && !node.is_array_of_tables()) {
      const std::size_t end = places.at(node.source().end);
      out = std::max(out, places.line_end(end == 0 ? 0 : end - 1));
    }
  }
  return out;
}

std::vector<Edit> edits_for(std::string_view text, const toml::table& axis,
                            const toml::table* encoder, const std::vector<KeyValue>& values) {
  const Places places(text);
  std::vector<Edit> out;
  std::string added = encoder == nullptr ? "[axis.encoder]\n" : "";
  // An existing key is replaced in place; the others are added together.
  for (const KeyValue& key : values) {
    const toml::node* old = encoder == nullptr ? nullptr : encoder->get(key.name);
    if (old != nullptr) {
      out.push_back({places.at(old->source().begin), places.at(old->source().end),
                     with_line_ends(key.value, text)});
    } else {
      added += key.name + " = " + key.value + "\n";
    }
  }
  const std::size_t place = end_of(encoder == nullptr ? axis : *encoder, places);
  // The last line of a file may lack its line end.
  const bool open = place > 0 && text[place - 1] != '\n';
  out.push_back({place, place, with_line_ends((open ? "\n" : "") + added, text)});
  return out;
}

/// The proof: the new text must parse to the old tree with the keys of `fragment` in the axis's
/// encoder, and to nothing else.
bool says(std::string_view text, const toml::table& old_tree, std::string_view axis,
          std::string_view fragment) {
  toml::table tree = old_tree;  // NOLINT(performance-unnecessary-copy-initialization): see below
  const toml::table keys = toml::parse(fragment);
  // Ours: `tree` is a copy.
  auto* table = const_cast<toml::table*>(axis_of(tree, axis));
  if (table->get("encoder") == nullptr) {
    table->insert("encoder", toml::table{});
  }
  for (const auto& [key, node] : keys) {
    (*table)["encoder"].as_table()->insert_or_assign(key, node);
  }
  return toml::parse(text) == tree;
}

kernel::outcome::Result<std::string> edited(std::string_view text, const std::string& file,
                                            std::string_view axis, const Encoder& encoder,
                                            bool rotary) {
  const toml::table root = toml::parse(text);
  const toml::table* section = axis_of(root, axis);
  const toml::table* old = (*section)["encoder"].as_table();
  const Places places(text);
  for (const toml::table* table : {section, old}) {
    // After inline tables and dotted keys there is no place for a new line.
    if (table != nullptr && (table->is_inline() || text[places.at(table->source().begin)] != '[')) {
      return refuse(file, line_of(table->source()),
                    "the axis or its encoder is written inline or with dotted keys",
                    "write [[axis]] and [axis.encoder] as separate sections");
    }
  }
  std::string out = applied(text, edits_for(text, *section, old, key_values(encoder, rotary)));
  if (!says(out, root, axis, calibration_text(encoder, rotary))) {
    return refuse(file, "inserting the calibration would change something else",
                  "write the calibration to a separate file and paste it in by hand");
  }
  // It must also be a valid machine file, ranges included.
  if (const auto machine = parse(out, file); !machine) {
    return std::unexpected(machine.error());
  }
  return out;
}

/// A calibration belongs to one count length. With another one its table would be scaled wrongly
/// and shift every edge.
kernel::outcome::Result<const Axis*> axis_in(const Machine& machine, const std::string& file,
                                             std::string_view name, double count_mm) {
  const auto found = std::ranges::find_if(
      machine.axes, [&](const Axis& axis) { return axis.present && axis.name == name; });
  if (found == machine.axes.end()) {
    return refuse(file, fmt::format("has no axis {}", cut(name)),
                  "give --axis with the name of one of its axes");
  }
  if (!(std::abs(found->encoder.count_au - count_mm) <= kSameCount * count_mm)) {
    return refuse(file,
                  fmt::format("axis {} has a count of {} mm (rad), not of {}", found->name,
                              shown(found->encoder.count_au), shown(count_mm)),
                  "give the count from the machine file");
  }
  return &*found;
}

kernel::outcome::Result<Encoder> fragment(std::string_view text, const std::string& file,
                                          double count_mm) {
  Faults faults{file, {}};
  Encoder out;
  out.count_au = count_mm;
  try {
    const toml::table root = toml::parse(text);
    // The keys alone carry their unit; it tells a rotary axis from a linear one.
    const bool rotary = root.contains("phase_error_deg") || root.contains("line_table_deg");
    SectionReader<Encoder> reader(faults, encoder_keys(), "the calibration",
                                  rotary ? For::rotary : For::linear);
    const Given given = reader.read(root, out);
    if (faults.list.empty()) {
      contradictions(out, given, faults);
    }
  } catch (const toml::parse_error& error) {
    return refuse(file, line_of(error.source()), std::string(error.description()),
                  "correct the TOML text at this place");
  }
  if (!faults.list.empty()) {
    return std::unexpected(std::move(faults.list.front()));
  }
  if (std::abs(out.count_au - count_mm) > kSameCount * count_mm) {
    return refuse(file, "is for another count", "give the count it was learnt with");
  }
  return out;
}

/// A fragment has no [[axis]], a machine file must have one.
bool is_machine_file(std::string_view text) {
  return text.starts_with("[[axis]]") || text.find("\n[[axis]]") != std::string_view::npos;
}

}  // namespace

std::string calibration_text(const Encoder& encoder, bool rotary) {
  std::string out;
  for (const KeyValue& key : key_values(encoder, rotary)) {
    out += key.name + " = " + key.value + "\n";
  }
  return out;
}

kernel::outcome::Result<std::string> with_calibration(std::string_view text,
                                                      const std::string& file,
                                                      std::string_view axis,
                                                      const Encoder& encoder) {
  const auto machine = parse(text, file);
  if (!machine) {
    return std::unexpected(machine.error());
  }
  const auto found = axis_in(*machine, file, axis, encoder.count_au);
  if (!found) {
    return std::unexpected(found.error());
  }
  // toml++ and its iterators throw; that ends here.
  try {
    return edited(text, file, axis, encoder, (*found)->rotary);
  } catch (const std::exception& error) {
    return refuse(file, fmt::format("not editable: {}", error.what()),
                  "write the calibration to a separate file and paste it in by hand");
  }
}

kernel::outcome::Result<Encoder> parse_calibration(std::string_view text, const std::string& file,
                                                   std::string_view axis, double count_mm) {
  if (auto unfit = unfit_text(text)) {
    unfit->file = file;
    return std::unexpected(std::move(*unfit));
  }
  if (!is_machine_file(text)) {
    return fragment(text, file, count_mm);
  }
  const auto machine = parse(text, file);
  if (!machine) {
    return std::unexpected(machine.error());
  }
  const auto found = axis_in(*machine, file, axis, count_mm);
  if (!found) {
    return std::unexpected(found.error());
  }
  return (*found)->encoder;
}

kernel::outcome::Result<Encoder> read_calibration(const std::string& path, std::string_view axis,
                                                  double count_mm) {
  const auto text = read_text(path);
  if (!text) {
    return std::unexpected(text.error());
  }
  return parse_calibration(*text, path, axis, count_mm);
}

}  // namespace steadyrest::passport
