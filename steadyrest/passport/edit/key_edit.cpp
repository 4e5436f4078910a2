// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <optional>

#include <fmt/core.h>
#include <toml++/toml.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/passport/edit/key_edit.hpp>
#include <steadyrest/passport/edit/text_edit.hpp>

namespace steadyrest::passport {
namespace {

using kernel::outcome::refuse;
using kernel::outcome::Result;

std::optional<toml::table> tree_of(std::string_view text) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error&) {
    return std::nullopt;
  }
}

/// What is asked for, read by TOML itself; empty where it is no single value.
toml::table asked_for(const NewValue& value) {
  auto tree = tree_of("value = " + value.value);
  return tree && tree->size() == 1 ? std::move(*tree) : toml::table();
}

class Editor {
 public:
  Editor(std::string_view text, const toml::table& tree)
      : text_(text), tree_(tree), places_(text) {}

  /// False: the section is not written as a table with a key in each line.
  bool set(const NewValue& value) {
    const toml::node* const section = tree_.at_path(value.section).node();
    const std::string line = value.key + " = " + value.value + "\n";
    if (section == nullptr) {
      missing_[value.section] += line;
      return true;
    }
    const toml::table* const table = section->as_table();
    if (table == nullptr || table->is_inline()) {
      return false;
    }
    if (const toml::node* const node = table->get(value.key); node != nullptr) {
      edits_.push_back(
          {places_.at(node->source().begin), places_.at(node->source().end), value.value});
      return true;
    }
    const std::size_t head = places_.at(table->source().begin);
    if (text_.substr(head, 1) != "[") {
      return false;
    }
    added_[places_.line_end(head)] += line;
    return true;
  }

  [[nodiscard]] std::string text() const {
    std::vector<Edit> edits = edits_;
    for (const auto& [at, lines] : added_) {
      const bool cut_off = at == text_.size() && !text_.ends_with('\n');
      edits.push_back({at, at, with_line_ends((cut_off ? "\n" : "") + lines, text_)});
    }
    std::string out = applied(text_, std::move(edits));
    for (const auto& [section, lines] : missing_) {
      out += with_line_ends(
          fmt::format("{}\n[{}]\n{}", out.ends_with('\n') ? "" : "\n", section, lines), text_);
    }
    return out;
  }

 private:
  std::string_view text_;
  const toml::table& tree_;
  Places places_;
  std::vector<Edit> edits_;
  std::map<std::size_t, std::string> added_;    ///< lines behind a section's head
  std::map<std::string, std::string> missing_;  ///< sections
};

/// The new tree has the values, and apart from them it is the old one.
bool changes_only(toml::table before, toml::table after, const std::vector<NewValue>& values) {
  for (const NewValue& value : values) {
    const auto path = value.section + "." + value.key;
    const toml::node* const seen = after.at_path(path).node();
    const toml::table wanted = asked_for(value);
    toml::table found;
    if (seen != nullptr) {
      found.insert("value", *seen);
    }
    if (found != wanted) {
      return false;
    }
    for (toml::table* const tree : {&before, &after}) {
      if (toml::table* const section = tree->at_path(value.section).as_table()) {
        section->erase(value.key);
      }
    }
    if (before.at_path(value.section).node() == nullptr) {
      before.insert_or_assign(value.section, toml::table());
    }
  }
  return before == after;
}

}  // namespace

Result<std::string> with_keys(std::string_view text, const std::string& file,
                              const std::vector<NewValue>& values) {
  const auto tree = tree_of(text);
  if (!tree) {
    return refuse(file, "is no TOML", "mend it by hand");
  }
  Editor editor(text, *tree);
  for (const NewValue& value : values) {
    if (asked_for(value).empty() || value.value.find_first_of("\r\n") != std::string::npos) {
      return refuse(file,
                    fmt::format("{} is no value for {}.{}", value.value, value.section, value.key),
                    "give a number, true, false, a word or a list");
    }
    if (!editor.set(value)) {
      return refuse(file,
                    fmt::format("[{}] is not a section with a key in each line", value.section),
                    fmt::format("write it as a section [{}], a key in each line", value.section));
    }
  }
  std::string out = editor.text();
  auto after = tree_of(out);
  if (!after || !changes_only(*tree, std::move(*after), values)) {
    return refuse(file, "cannot be changed in place", "change it by hand");
  }
  return out;
}

}  // namespace steadyrest::passport
