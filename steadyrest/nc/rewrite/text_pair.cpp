// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/nc/rewrite/source_lines.hpp>
#include <steadyrest/nc/rewrite/tag.hpp>
#include <steadyrest/nc/rewrite/text_pair.hpp>

namespace steadyrest::nc::rewrite {

using kernel::outcome::Kind;
using kernel::outcome::Refusal;
using kernel::outcome::Result;

Result<Inserted> compare_text(const std::string& original, const std::string& changed,
                              PlainSurvey& plain, bool with_groups) {
  auto before = SourceLines::open(original);
  auto after = SourceLines::open(changed);
  if (!before || !after) {
    return std::unexpected(before ? after.error() : before.error());
  }
  const auto refuse = [](const std::string& file, std::uint32_t line, std::string what) {
    return std::unexpected(Refusal{Kind::bad_input, file, line, std::move(what),
                                   "make the changed program anew from this original"});
  };
  Inserted inserted;
  const auto take = [&] {
    inserted.lines.push_back(after->number());
    if (is_head(after->line())) {
      inserted.head.append(after->line()).append("\n");
      ++inserted.head_lines;
      inserted.head_before = before->number();
    } else if (with_groups) {
      inserted.groups[before->number()].append(after->line()).append("\n");
    }
  };
  while (before->next()) {
    const bool bare = plain.look(before->line());
    if (!bare && is_inserted(before->line())) {
      return refuse(original, before->number(), "the original carries the mark of a correction");
    }
    // The original's line is no inserted one: what is the same is none either.
    if (after->skip(before->line(), before->ending())) {
      continue;
    }
    bool more = after->next();
    while (more && after->line() != before->line() && is_inserted(after->line())) {
      take();
      more = after->next();
    }
    if (!more || after->line() != before->line() || after->ending() != before->ending()) {
      return refuse(changed, after->number(),
                    "differs from the original outside of the inserted lines");
    }
  }
  while (after->next()) {
    if (!is_inserted(after->line())) {
      return refuse(changed, after->number(), "goes on where the original has ended");
    }
    take();
  }
  for (const auto* lines : {&*before, &*after}) {
    if (auto whole = lines->whole(); !whole) {
      return std::unexpected(whole.error());
    }
  }
  return inserted;
}

}  // namespace steadyrest::nc::rewrite
