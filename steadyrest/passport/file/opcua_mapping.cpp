// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/nearest.hpp>
#include <steadyrest/passport/file/opcua_section.hpp>

// A mapping names nodes once for every machine: placeholders are filled in here, so that the port
// has plain identifiers.
namespace steadyrest::passport {
namespace {

using kernel::machine::kQuantityWords;
using kernel::machine::Machine;
using kernel::machine::OpcUa;
using kernel::machine::OpcUaPlace;
using kernel::machine::Quantity;

constexpr std::size_t kMostEntries = 256;

void replace_all(std::string& text, std::string_view what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos;
       at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
}

/// The number in `#N]` at the end; 0: none.
std::uint32_t length_in(const std::string& node) {
  const std::size_t hash = node.rfind('#');
  if (hash == std::string::npos || !node.ends_with(']')) {
    return 0;
  }
  std::uint32_t out = 0;
  const char* const end = node.data() + node.size() - 1;
  const auto [rest, fault] = std::from_chars(node.data() + hash + 1, end, out);
  return fault == std::errc() && rest == end ? out : 0;
}

class MappingReader {
 public:
  MappingReader(const Machine& machine, OpcUa& out, Faults& faults) : out_(out), faults_(faults) {
    for (std::size_t i = 0; i < machine.axes.size(); ++i) {
      if (machine.axes[i].present) {
        present_.push_back(static_cast<std::uint8_t>(i));
      }
    }
  }

  void read(const toml::table& root) {
    for (const auto& [name, node] : root) {
      constexpr std::array<std::string_view, 5> kNames = {"name", "namespace", "read", "write",
                                                          "program_state"};
      if (std::ranges::find(kNames, name.str()) == kNames.end()) {
        faults_.add(line_of(name.source()), fmt::format("a mapping has no {}", cut(name.str())),
                    kernel::outcome::meant(name.str(), kNames,
                                           "use name, namespace, [[read]], [[write]], "
                                           "[program_state]"));
      }
    }
    if (const auto uri = root["namespace"].value<std::string>(); uri && !uri->empty()) {
      out_.uri = *uri;
    } else {
      faults_.add(0, "the mapping has no namespace",
                  "add namespace = the URI of the nodes' namespace, not its number");
    }
    list(root, "read", false, out_.reads);
    list(root, "write", true, out_.writes);
    states(root);
    if (faults_.list.empty()) {
      complete();
    }
  }

 private:
  void list(const toml::table& root, std::string_view name, bool written,
            std::vector<OpcUaPlace>& out) {
    const toml::node* node = root.get(name);
    if (node == nullptr) {
      return;
    }
    const toml::array* entries = node->as_array();
    if (entries == nullptr || entries->size() > kMostEntries) {
      faults_.add(line_of(node->source()), fmt::format("{} is no list of sections", name),
                  fmt::format("write [[{}]] with double brackets, {} at most", name, kMostEntries));
      return;
    }
    for (const toml::node& one : *entries) {
      if (const toml::table* table = one.as_table()) {
        entry(*table, fmt::format("[[{}]]", name), written, out);
      } else {
        faults_.add(line_of(one.source()), fmt::format("{} has an entry that is no section", name),
                    fmt::format("write [[{}]] with its keys below", name));
      }
    }
  }

  void entry(const toml::table& table, const std::string& head, bool written,
             std::vector<OpcUaPlace>& out) {
    const std::size_t before = faults_.list.size();
    MappingEntry read;
    SectionReader<MappingEntry> reader(faults_, mapping_keys(), head);
    const Given given = reader.read(table, read);
    if (faults_.list.size() != before) {
      return;
    }
    const auto* const found = std::ranges::find(kQuantityWords, read.quantity);
    const auto quantity = static_cast<Quantity>(found - kQuantityWords.begin());
    if (found == kQuantityWords.end() || kernel::machine::is_written(quantity) != written) {
      faults_.add(given.at({"quantity"}),
                  fmt::format("quantity = \"{}\" is none that is {}", cut(read.quantity),
                              written ? "written" : "read"),
                  kernel::outcome::meant(read.quantity, kQuantityWords,
                                         "docs/opcua.md lists the quantities"));
      return;
    }
    if (read.scale == 0.0) {
      faults_.add(given.at({"scale"}), "scale = 0", "give a factor other than 0");
      return;
    }
    if (kernel::machine::is_of_axis(quantity)) {
      for (std::size_t i = 0; i < present_.size(); ++i) {
        place(read, given, quantity, i, out);
      }
    } else {
      place(read, given, quantity, 0, out);
    }
  }

  void place(const MappingEntry& read, const Given& given, Quantity quantity, std::size_t rank,
             std::vector<OpcUaPlace>& out) {
    const bool of_axis = kernel::machine::is_of_axis(quantity);
    const std::size_t axes = present_.size();
    std::string node = read.node;
    const std::array<std::pair<std::string_view, std::size_t>, 8> filled = {
        {{"{channel}", out_.channel},
         {"{channel_db}", out_.channel_db()},
         {"{plc_block}", out_.plc_block},
         {"{axis}", rank + 1},
         {"{sample}", out_.first_sample},
         {"{sample_count}", kernel::machine::sample_count(axes)},
         {"{order}", out_.first_order},
         {"{order_count}", kernel::machine::order_count(axes)}}};
    for (const auto& [name, value] : filled) {
      replace_all(node, name, std::to_string(value));
    }
    const std::uint32_t length = read.length > 0 ? read.length : length_in(node);
    const std::int64_t last = static_cast<std::int64_t>(length) - 1;
    const std::int64_t index =
        read.index < 0 ? last
                       : read.index + static_cast<std::int64_t>(of_axis ? read.step * rank : 0);
    if (node.find('{') != std::string::npos || node.size() < 3 || node[1] != '=') {
      faults_.add(
          given.at({"node"}), fmt::format("node = \"{}\"", cut(node)),
          "write s=NAME or i=NUMBER, and no other placeholders than docs/machine-file.md has");
      return;
    }
    if (index < 0 || (index > 0 && index > last)) {
      faults_.add(given.at({"index", "step"}),
                  length == 0 ? fmt::format("index {} of {}, a single value", index, cut(node))
                              : fmt::format("index {} is beyond the {} values of {}", index, length,
                                            cut(node)),
                  "give the array's length, by #N] in the node or by length");
      return;
    }
    add({.quantity = quantity,
         .axis = of_axis ? present_[rank] : std::uint8_t{0},
         .node = std::move(node),
         .index = static_cast<std::uint32_t>(index),
         .length = length,
         .scale = read.scale,
         .offset = read.offset},
        given, out);
  }

  /// Quantities that are written, and those of axes, must not share a place; others may be read
  /// from the same place.
  void add(OpcUaPlace place, const Given& given, std::vector<OpcUaPlace>& out) {
    const bool of_axis = kernel::machine::is_of_axis(place.quantity);
    const bool written = kernel::machine::is_written(place.quantity);
    const auto word = [](const OpcUaPlace& of) {
      return kQuantityWords[static_cast<std::size_t>(of.quantity)];
    };
    const auto taken = std::ranges::find_if(out, [&](const OpcUaPlace& other) {
      return other.node == place.node && other.index == place.index &&
             (other.quantity != place.quantity || other.axis != place.axis) &&
             (written || (of_axis && kernel::machine::is_of_axis(other.quantity)));
    });
    if (taken != out.end()) {
      faults_.add(given.at({"index", "node"}),
                  fmt::format("{} has the place of {}: {} entry {}", word(place), word(*taken),
                              cut(place.node), place.index),
                  of_axis ? "give each axis a separate place: {axis} in the node, or index and step"
                          : "give each written quantity a separate place");
    } else if (std::ranges::any_of(out, [&](const OpcUaPlace& other) {
                 return other.quantity == place.quantity && other.axis == place.axis;
               })) {
      faults_.add(given.at({"quantity"}), fmt::format("{} is mapped twice", word(place)),
                  "keep one of them");
    } else {
      out.push_back(std::move(place));
    }
  }

  void states(const toml::table& root) {
    const toml::node* node = root.get("program_state");
    const toml::table* table = node != nullptr ? node->as_table() : nullptr;
    if (node != nullptr && table == nullptr) {
      faults_.add(line_of(node->source()), "program_state is no section",
                  "write [program_state] with stopped, paused and running");
    }
    if (table == nullptr) {
      return;
    }
    constexpr std::array<std::string_view, 3> kNames = {"stopped", "paused", "running"};
    for (const auto& [name, value] : *table) {
      const auto* const found = std::ranges::find(kNames, name.str());
      if (found == kNames.end()) {
        faults_.add(line_of(name.source()),
                    fmt::format("[program_state] has no {}", cut(name.str())),
                    "use stopped, paused, running");
        continue;
      }
      const ValueReader read(faults_, name.str(), -1e6, 1e6, 32);
      static_cast<void>(
          read.numbers(value, out_.states[static_cast<std::size_t>(found - kNames.begin())]));
    }
  }

  [[nodiscard]] static bool has(const std::vector<OpcUaPlace>& places, Quantity quantity) {
    return std::ranges::any_of(places, [=](const auto& one) { return one.quantity == quantity; });
  }

  /// An array is written whole.
  void gaps() {
    for (auto place = out_.writes.begin(); place != out_.writes.end(); ++place) {
      const auto mapped =
          static_cast<std::size_t>(std::ranges::count(out_.writes, place->node, &OpcUaPlace::node));
      const bool first = std::ranges::find(out_.writes, place->node, &OpcUaPlace::node) == place;
      if (first && place->length > mapped) {
        faults_.add(0,
                    fmt::format("{} of the {} values of {} are mapped: the others would be written "
                                "as 0",
                                mapped, place->length, cut(place->node)),
                    "give each value of a written array its [[write]], or write single values");
      }
    }
  }

  /// A panel's override that is read where the layer's own shows would sink with it.
  void panels() {
    for (const OpcUaPlace& place : out_.reads) {
      if (place.quantity != Quantity::feed_panel_percent &&
          place.quantity != Quantity::spindle_panel_percent) {
        continue;
      }
      const auto same = [&](const OpcUaPlace& other) {
        return other.node == place.node && other.index == place.index &&
               (kernel::machine::is_written(other.quantity) ||
                other.quantity == Quantity::feed_effective_percent ||
                other.quantity == Quantity::spindle_effective_percent);
      };
      if (std::ranges::any_of(out_.reads, same) || std::ranges::any_of(out_.writes, same)) {
        faults_.add(0,
                    fmt::format("{} is read at {} entry {}, where the override in force or an "
                                "order is",
                                kQuantityWords[static_cast<std::size_t>(place.quantity)],
                                cut(place.node), place.index),
                    "read what the operator's switch shows");
      }
    }
  }

  /// A state that is two.
  void twice() {
    constexpr std::array<std::string_view, 3> kNames = {"stopped", "paused", "running"};
    for (std::size_t i = 0; i < kNames.size(); ++i) {
      for (std::size_t k = i + 1; k < kNames.size(); ++k) {
        const auto both = std::ranges::find_first_of(out_.states[i], out_.states[k]);
        if (both != out_.states[i].end()) {
          faults_.add(
              0, fmt::format("program_state {:g} is both {} and {}", *both, kNames[i], kNames[k]),
              "keep it in one of them");
        }
      }
    }
  }

  void complete() {
    for (const Quantity needed :
         {Quantity::command_mm, Quantity::actual_mm, Quantity::feed_panel_percent}) {
      if (!has(out_.reads, needed)) {
        faults_.add(
            0,
            fmt::format("the mapping has no {}", kQuantityWords[static_cast<std::size_t>(needed)]),
            "add a [[read]] for it: without it there is nothing to correct");
      }
    }
    if (!out_.writes.empty() && !has(out_.writes, Quantity::heartbeat) &&
        !has(out_.writes, Quantity::heartbeat_byte)) {
      faults_.add(0, "the mapping writes, but has no heartbeat",
                  "add a [[write]] for it: the control's dead man needs it");
    }
    if (has(out_.writes, Quantity::heartbeat) && has(out_.writes, Quantity::heartbeat_byte)) {
      faults_.add(0, "the mapping writes both heartbeat and heartbeat_byte", "keep one of them");
    }
    panels();
    gaps();
    twice();
    if (has(out_.reads, Quantity::program_state) && out_.states[2].empty()) {
      faults_.add(0, "the mapping reads program_state, but does not say what running is",
                  "add [program_state] with stopped, paused and running");
    }
  }

  OpcUa& out_;
  Faults& faults_;
  std::vector<std::uint8_t> present_;
};

}  // namespace

void read_mapping(std::string_view text, const Machine& machine, OpcUa& out, Faults& faults) {
  try {
    MappingReader(machine, out, faults).read(toml::parse(text));
  } catch (const toml::parse_error& error) {
    faults.add(line_of(error.source()), std::string(error.description().substr(0, 200)),
               "correct the TOML text at this place");
  } catch (const std::exception& error) {
    faults.add(0, fmt::format("cannot be read: {}", error.what()), "give a valid mapping");
  }
}

}  // namespace steadyrest::passport
