// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <toml++/toml.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/outcome/nearest.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/passport/keys/schema.hpp>
#include <steadyrest/passport/text/unit.hpp>

/// Reads one section of the machine file by its table of keys. Internal to the reader.
namespace steadyrest::passport {

/// Everything wrong with one file, in the order of its lines.
struct Faults {
  std::string file;
  std::vector<kernel::outcome::Refusal> list;

  void add(std::size_t line, std::string what, std::string to_do) {
    const auto later = std::upper_bound(
        list.begin(), list.end(), line,
        [](std::size_t at, const kernel::outcome::Refusal& fault) { return at < fault.line; });
    list.insert(later, kernel::outcome::bad_input(file, line, std::move(what), std::move(to_do)));
  }
};

/// The line of each given key.
struct Given {
  std::string section;   ///< as shown to people: `[control]`, `[[axis]] X`
  std::size_t line = 0;  ///< of the section's head
  std::vector<std::pair<std::string_view, std::size_t>> keys;

  [[nodiscard]] bool has(std::string_view key) const { return line_of_key(key) != 0; }
  /// The first of `names` that was given, else the section's head.
  [[nodiscard]] std::size_t at(std::initializer_list<std::string_view> names) const {
    for (const std::string_view name : names) {
      if (const std::size_t found = line_of_key(name); found != 0) {
        return found;
      }
    }
    return line;
  }

 private:
  [[nodiscard]] std::size_t line_of_key(std::string_view key) const {
    for (const auto& [name, at_line] : keys) {
      if (name == key) {
        return at_line;
      }
    }
    return 0;
  }
};

/// `text`, or its beginning if it is too long for a message.
[[nodiscard]] std::string cut(std::string_view text);
/// A value as written in the file, short enough for a message.
[[nodiscard]] std::string shown(const toml::node& node);
/// A number as people write it.
[[nodiscard]] std::string shown(double value);
[[nodiscard]] std::size_t line_of(const toml::source_region& source);

/// The table below `name`; null when absent, a fault when it is something else.
[[nodiscard]] const toml::table* table_below(Faults& faults, const toml::table& parent,
                                             std::string_view name, std::string_view shown_name);

/// Reads plain values and reports what is wrong with them.
class ValueReader {
 public:
  ValueReader(Faults& faults, std::string_view key, double min, double max, std::size_t max_entries)
      : faults_(faults), key_(key), min_(min), max_(max), max_entries_(max_entries) {}

  bool number(const toml::node& node, double& out) const;
  bool integer(const toml::node& node, std::int64_t& out) const;
  bool boolean(const toml::node& node, bool& out) const;
  bool text(const toml::node& node, std::string& out) const;
  bool choice(const toml::node& node, std::span<const std::string_view> words,
              std::size_t& out) const;
  bool numbers(const toml::node& node, std::vector<double>& out) const;
  bool integers(const toml::node& node, std::vector<std::uint32_t>& out) const;

 private:
  bool in_range(const toml::node& node, double value) const;
  void wrong_type(const toml::node& node, std::string_view needed, std::string_view way) const;
  const toml::array* list(const toml::node& node, std::string_view of) const;

  Faults& faults_;
  std::string_view key_;
  double min_;
  double max_;
  std::size_t max_entries_;
};

/// Reads the keys of one section into its struct.
template <class S>
class SectionReader {
 public:
  SectionReader(Faults& faults, std::span<const Key<S>> keys, std::string section,
                For axes = For::any)
      : faults_(faults), keys_(keys), section_(std::move(section)), axes_(axes) {}

  /// `children` are names of sub-sections, which the caller reads.
  Given read(const toml::table& table, S& out,
             std::initializer_list<std::string_view> children = {}) {
    given_.section = section_;
    given_.line = line_of(table.source());
    children_ = children;
    for (const auto& [name, node] : table) {
      if (std::find(children.begin(), children.end(), name.str()) != children.end()) {
        continue;
      }
      read_one(name, node, out);
    }
    missing();
    return given_;
  }

 private:
  [[nodiscard]] bool fits(const Key<S>& key) const {
    return key.axes == For::any || axes_ == For::any || key.axes == axes_;
  }

  void read_one(const toml::key& name, const toml::node& node, S& out) {
    const std::size_t line = line_of(name.source());
    for (const Key<S>& key : keys_) {
      if (key.name == name.str() && fits(key)) {
        if (already(key, line)) {
          return;
        }
        given_.keys.emplace_back(key.name, line);
        put(key, node, out);
        return;
      }
    }
    unknown(name.str(), line, node);
  }

  /// Two units of one quantity must not both be given.
  bool already(const Key<S>& key, std::size_t line) {
    // NOLINTNEXTLINE(readability-use-anyofallof): it reports as it finds
    for (const Key<S>& other : keys_) {
      if (other.name != key.name && other.field == key.field && given_.has(other.name)) {
        faults_.add(line,
                    fmt::format("{} has both {} and {}, which are the same quantity", section_,
                                other.name, key.name),
                    "keep one of them");
        return true;
      }
    }
    return false;
  }

  void put(const Key<S>& key, const toml::node& node, S& out) {
    const ValueReader read(faults_, key.name, key.min, key.max, key.max_entries);
    std::visit([&](const auto& field) { put_field(key, field, read, node, out); }, key.field);
  }

  void put_field(const Key<S>& key, double S::* field, const ValueReader& read,
                 const toml::node& node, S& out) {
    double value = 0.0;
    if (read.number(node, value)) {
      out.*field = unit_of(key.name).to_inner(value);
    }
  }
  void put_field(const Key<S>& /*key*/, bool S::* field, const ValueReader& read,
                 const toml::node& node, S& out) {
    read.boolean(node, out.*field);
  }
  template <class Integer>
    requires std::is_integral_v<Integer> && (!std::is_same_v<Integer, bool>)
  void put_field(const Key<S>& /*key*/, Integer S::* field, const ValueReader& read,
                 const toml::node& node, S& out) {
    std::int64_t value = 0;
    if (read.integer(node, value)) {
      out.*field = static_cast<Integer>(value);
    }
  }
  void put_field(const Key<S>& /*key*/, std::string S::* field, const ValueReader& read,
                 const toml::node& node, S& out) {
    read.text(node, out.*field);
  }
  void put_field(const Key<S>& key, std::vector<double> S::* field, const ValueReader& read,
                 const toml::node& node, S& out) {
    std::vector<double> values;
    if (read.numbers(node, values)) {
      const Unit& unit = unit_of(key.name);
      for (double& value : values) {
        value = unit.to_inner(value);
      }
      out.*field = std::move(values);
    }
  }
  void put_field(const Key<S>& /*key*/, std::vector<std::uint32_t> S::* field,
                 const ValueReader& read, const toml::node& node, S& out) {
    std::vector<std::uint32_t> values;
    if (read.integers(node, values)) {
      out.*field = std::move(values);
    }
  }
  void put_field(const Key<S>& /*key*/, const Choice<S>& field, const ValueReader& read,
                 const toml::node& node, S& out) {
    std::size_t i = 0;
    if (read.choice(node, field.words, i)) {
      field.set(out, i);
    }
  }

  void missing() {
    for (const Key<S>& key : keys_) {
      if (key.need == Need::mandatory && fits(key) && !any_unit_given(key) && first_unit(key)) {
        faults_.add(given_.line,
                    fmt::format("{} has no {}, which is mandatory", section_, key.name),
                    fmt::format("add {} = …{}; {}", key.name, other_units(key), key.meaning));
      }
    }
  }
  [[nodiscard]] bool any_unit_given(const Key<S>& key) const {
    return std::any_of(keys_.begin(), keys_.end(), [&](const Key<S>& other) {
      return other.field == key.field && given_.has(other.name);
    });
  }
  /// The alternative keys for the same quantity.
  [[nodiscard]] std::string other_units(const Key<S>& key) const {
    std::string out;
    for (const Key<S>& other : keys_) {
      if (fits(other) && other.field == key.field && other.name != key.name) {
        out += fmt::format(" or {} = …", other.name);
      }
    }
    return out;
  }
  /// A quantity with several units is requested only once.
  [[nodiscard]] bool first_unit(const Key<S>& key) const {
    for (const Key<S>& other : keys_) {
      if (fits(other) && other.field == key.field) {
        return other.name == key.name;
      }
    }
    return true;
  }

  void unknown(std::string_view name, std::size_t line, const toml::node& node) {
    if (other_kind_of_axis(name, line) || other_unit(name, line, node)) {
      return;
    }
    std::vector<std::string_view> names = children_;
    for (const Key<S>& key : keys_) {
      if (fits(key)) {
        names.push_back(key.name);
      }
    }
    faults_.add(line, fmt::format("{} has no key {}", section_, cut(name)),
                kernel::outcome::meant(
                    name, names, fmt::format("remove it; {} has {}", section_, joined(names))));
  }

  /// A key for linear axes on a rotary one, or vice versa.
  bool other_kind_of_axis(std::string_view name, std::size_t line) {
    for (const Key<S>& key : keys_) {
      if (key.name != name) {
        continue;
      }
      for (const Key<S>& right : keys_) {
        if (right.field == key.field && fits(right)) {
          faults_.add(line,
                      fmt::format("{} of {} is for a {} axis", name, section_,
                                  key.axes == For::linear ? "linear" : "rotary"),
                      fmt::format("write {} here", right.name));
          return true;
        }
      }
    }
    return false;
  }

  /// The right quantity in a unit that the machine file does not offer for it.
  bool other_unit(std::string_view name, std::size_t line, const toml::node& node) {
    // NOLINTNEXTLINE(readability-use-anyofallof): it reports as it finds
    for (const Key<S>& key : keys_) {
      if (fits(key) && stem_of(key.name) == stem_of(name)) {
        const std::string_view unit = unit_of(key.name).shown;
        faults_.add(line,
                    fmt::format("{} = {}: {} has this quantity in {}, as the key's name says",
                                cut(name), shown(node), section_, unit.empty() ? "no unit" : unit),
                    fmt::format("write {} = …", key.name));
        return true;
      }
    }
    return false;
  }

  static std::string joined(const std::vector<std::string_view>& names) {
    std::string out;
    for (const std::string_view name : names) {
      out += out.empty() ? "" : ", ";
      out += name;
    }
    return out;
  }

  Faults& faults_;
  std::span<const Key<S>> keys_;
  std::string section_;
  For axes_;
  Given given_;
  std::vector<std::string_view> children_;
};

}  // namespace steadyrest::passport
