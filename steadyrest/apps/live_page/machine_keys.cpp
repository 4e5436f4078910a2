// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include <fmt/core.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <steadyrest/apps/live_page/machine_keys.hpp>
#include <steadyrest/passport/keys/schema.hpp>
#include <steadyrest/passport/text/unit.hpp>

namespace steadyrest::apps::live_page {
namespace {

Json json_of(const toml::node& node) {
  if (const auto text = node.value_exact<std::string>()) {
    return *text;
  }
  if (const auto truth = node.value_exact<bool>()) {
    return *truth;
  }
  if (const auto whole = node.value_exact<std::int64_t>()) {
    return *whole;
  }
  if (const auto number = node.value_exact<double>()) {
    return *number;
  }
  Json out = Json::array();
  if (const auto* const list = node.as_array()) {
    for (const toml::node& entry : *list) {
      out.push_back(json_of(entry));
    }
  }
  return out;
}

/// The value in force, in the key's unit: the default where the file does not have the key.
template <class S>
Json value_of(const passport::Key<S>& key, const S& section) {
  const auto shown = [&key](double inner) {
    return std::stod(fmt::format("{:.9g}", passport::unit_of(key.name).from_inner(inner)));
  };
  return std::visit(
      [&](const auto& field) -> Json {
        using Field = std::remove_cvref_t<decltype(field)>;
        if constexpr (std::is_same_v<Field, passport::Choice<S>>) {
          return field.words[field.get(section)];
        } else if constexpr (std::is_same_v<Field, double S::*>) {
          return std::isfinite(section.*field) ? Json(shown(section.*field)) : Json();
        } else if constexpr (std::is_same_v<Field, std::vector<double> S::*>) {
          Json list = Json::array();
          for (const double inner : section.*field) {
            list.push_back(shown(inner));
          }
          return list;
        } else {
          return section.*field;
        }
      },
      key.field);
}

/// What is allowed: `0 … 90`, or the words of a choice.
template <class S>
std::string range_of(const passport::Key<S>& key) {
  if (const auto* const choice = std::get_if<passport::Choice<S>>(&key.field)) {
    return fmt::format("{}", fmt::join(choice->words, " | "));
  }
  const bool is_number = !std::holds_alternative<bool S::*>(key.field) &&
                         !std::holds_alternative<std::string S::*>(key.field);
  return is_number ? fmt::format("{:g} … {:g}", key.min, key.max) : "";
}

template <class S, class Keys>
Json section_json(const char* name, const char* title, const Keys& keys, const S& section,
                  const toml::table& root) {
  const toml::table* const given = root[name].as_table();
  Json list = Json::array();
  for (const auto& key : keys) {
    const toml::node* const node = given != nullptr ? given->get(key.name) : nullptr;
    list.push_back({{"key", fmt::format("{}.{}", name, key.name)},
                    {"value", node != nullptr ? json_of(*node) : value_of(key, section)},
                    {"default", node == nullptr},
                    {"unit", passport::unit_of(key.name).shown},
                    {"range", range_of(key)},
                    {"explanation", key.meaning},
                    {"live", true}});
  }
  return {{"name", name}, {"title", title}, {"keys", std::move(list)}};
}

}  // namespace

Json sections_json(std::string_view text, const kernel::machine::Machine& machine) {
  toml::table root;
  try {
    root = toml::parse(text);
  } catch (const toml::parse_error&) {
    return Json::array();  // shown as a text alone
  }
  return {section_json("contour", "Contour error", passport::contour_keys(), machine.contour, root),
          section_json("chatter", "Spindle modulation", passport::chatter_keys(), machine.chatter,
                       root),
          section_json("thermal", "Heat", passport::thermal_keys(), machine.thermal, root),
          section_json("envelope", "Envelope", passport::envelope_keys(), machine.envelope, root)};
}

}  // namespace steadyrest::apps::live_page
