// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <sstream>
#include <string>
#include <type_traits>
#include <variant>

#include <fmt/core.h>
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

template <class S>
Json key_json(const passport::Key<S>& key, const toml::table* section) {
  const toml::node* const node = section != nullptr ? section->get(key.name) : nullptr;
  Json out = {{"key", key.name},
              {"value", node != nullptr ? json_of(*node) : Json()},
              {"unit", passport::unit_of(key.name).shown},
              {"range", ""},
              {"words", Json::array()},
              {"explanation", key.meaning},
              {"live", true}};
  if (const auto* const choice = std::get_if<passport::Choice<S>>(&key.field)) {
    for (const std::string_view word : choice->words) {
      out["words"].push_back(word);
    }
  } else if (std::holds_alternative<bool S::*>(key.field)) {
    out["words"] = {true, false};
  } else if (!std::holds_alternative<std::string S::*>(key.field)) {
    out["range"] = fmt::format("{:g} … {:g}", key.min, key.max);
  }
  return out;
}

template <class Keys>
Json section_json(const char* name, const char* title, const Keys& keys, const toml::table& root) {
  const toml::table* const section = root[name].as_table();
  Json list = Json::array();
  for (const auto& key : keys) {
    list.push_back(key_json(key, section));
  }
  return {{"name", name}, {"title", title}, {"keys", std::move(list)}};
}

}  // namespace

Json sections_json(std::string_view text) {
  toml::table root;
  try {
    root = toml::parse(text);
  } catch (const toml::parse_error&) {
    return Json::array();  // shown as a text alone
  }
  return {section_json("contour", "Contour error", passport::contour_keys(), root),
          section_json("chatter", "Spindle modulation", passport::chatter_keys(), root),
          section_json("thermal", "Heat", passport::thermal_keys(), root),
          section_json("envelope", "Envelope", passport::envelope_keys(), root)};
}

}  // namespace steadyrest::apps::live_page
