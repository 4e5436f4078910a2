// SPDX-License-Identifier: Apache-2.0
#include <string_view>
#include <utility>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/rewrite/text/mark.hpp>
#include <steadyrest/nc/rewrite/text/put_back.hpp>
#include <steadyrest/nc/rewrite/text/replaced_text.hpp>
#include <steadyrest/nc/rewrite/text/source_lines.hpp>

namespace steadyrest::nc::rewrite {

kernel::outcome::Result<PutBack> put_back(const std::string& changed) {
  auto source = SourceLines::open(changed);
  if (!source) {
    return std::unexpected(source.error());
  }
  PutBack back;
  std::string& out = back.text;
  std::string held;          // of the group: its original line
  std::size_t expected = 0;  // new lines that must still follow
  std::uint32_t number = 0;  // of the line in `out`
  const auto refuse = [&](std::string what) {
    return kernel::outcome::refuse(changed, source->number(), std::move(what),
                                   "undo what was changed by hand in the lines marked STEADYREST, "
                                   "or make the program again from the original");
  };
  while (source->next()) {
    const std::string_view line = source->line();
    const bool fresh = is_new(line);
    if (fresh != (expected > 0)) {
      return refuse(fresh ? "a new line that belongs to no replaced one"
                          : "a replaced line has fewer new lines than it says");
    }
    if (fresh) {
      ++back.removed;
      back.lines[number].emplace_back(new_code(line));
      if (--expected == 0) {
        out += held;
        out += source->ending();
      }
    } else if (auto was = read_was(line)) {
      ++back.restored;
      back.lines[++number];
      held = std::move(was->line);
      expected = was->new_lines;
      if (expected == 0) {
        out += held;
        out += source->ending();
      }
    } else if (is_mark(line, kReplacedMark)) {
      ++back.removed;
    } else if (was_replacing(line)) {
      return refuse("its comment was changed");
    } else {
      ++number;
      out += line;
      out += source->ending();
    }
  }
  if (auto whole = source->whole(); !whole) {
    return std::unexpected(whole.error());
  }
  if (expected > 0) {
    return refuse("the program ends within a replaced line");
  }
  return back;
}

}  // namespace steadyrest::nc::rewrite
