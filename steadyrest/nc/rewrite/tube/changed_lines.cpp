// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/rewrite/text/mark.hpp>
#include <steadyrest/nc/rewrite/text/put_back.hpp>
#include <steadyrest/nc/rewrite/text/replaced_text.hpp>
#include <steadyrest/nc/rewrite/text/source_lines.hpp>
#include <steadyrest/nc/rewrite/tube/changed_lines.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using kernel::outcome::Result;

constexpr std::string_view kMakeAgain = "make the changed program again from this original";

/// What a new line may not hold, which running it would not show at once: a comment that is not the
/// original's or the mark (LinuxCNC stops at (ABORT,…)), and a parameter. Empty when nothing.
std::string_view hidden_fault(std::string_view line, std::string_view original) {
  while (true) {
    const std::size_t at = std::min(line.find_first_of("(;"), line.size());
    if (line.substr(0, at).find('#') != std::string_view::npos) {
      return "a new line names a parameter";
    }
    if (at == line.size()) {
      return {};
    }
    const std::size_t close = line[at] == ';' ? std::string_view::npos : line.find(')', at);
    const std::size_t length = close == std::string_view::npos ? line.size() - at : close - at + 1;
    std::string_view comment = line.substr(at, length);
    line.remove_prefix(at + length);
    if (is_new(comment)) {
      // What the mark ends: a comment of the original before it, or nothing.
      comment = comment.substr(0, comment.rfind(comment.ends_with(')') ? '(' : ';'));
      while (comment.ends_with(' ')) {
        comment.remove_suffix(1);
      }
    }
    if (original.find(comment) == std::string_view::npos) {
      return "a new line has a comment that the original does not have";
    }
  }
}

/// The new line is the original's, with the mark.
bool is_same(std::string_view line, std::string_view original) {
  if (!line.starts_with(original)) {
    return false;
  }
  line.remove_prefix(original.size());
  return line.starts_with(' ') && is_new(line.substr(1)) &&
         line.find_first_of("(;", 2) == std::string_view::npos;
}

}  // namespace

std::uint32_t ChangedLines::place_of(std::uint32_t original_line) const noexcept {
  for (std::uint32_t line = original_line; line < origin_.size(); ++line) {
    if (origin_[line] == original_line) {
      return line;
    }
  }
  return 0;
}

Result<ChangedLines> ChangedLines::compare(const std::string& original,
                                           const std::string& changed) {
  const auto back = put_back(changed);
  if (!back) {
    return std::unexpected(back.error());
  }
  auto before = SourceLines::open(original);
  auto after = SourceLines::open(changed);
  if (!before || !after) {
    return std::unexpected(before ? after.error() : before.error());
  }
  ChangedLines out;
  SourceLines restored = SourceLines::of(back->text, changed);
  std::string was;
  while (after->next()) {
    const std::string_view line = after->line();
    Kind kind = Kind::kept;
    if (is_new(line)) {
      kind = Kind::fresh;
      ++out.fresh_;
      ++out.new_lines_.back();
      const bool first = out.kind_.back() == Kind::was;
      if (first && is_same(line, was)) {
        kind = Kind::same;
      } else if (const auto fault = hidden_fault(line, was); !fault.empty()) {
        return kernel::outcome::refuse(changed, after->number(), std::string(fault),
                                       std::string(kMakeAgain));
      }
    } else if (auto kept = read_was(line)) {
      kind = Kind::was;
      ++out.replaced_;
      was = std::move(kept->line);
    } else if (is_mark(line, kReplacedMark)) {
      kind = Kind::head;
    }
    if (kind == Kind::kept || kind == Kind::was) {
      out.new_lines_.push_back(kind == Kind::was ? 0 : kNone);
      const bool more = before->next();
      if (!restored.next() || !more || before->line() != restored.line() ||
          before->ending() != restored.ending()) {
        return kernel::outcome::refuse(changed, after->number(),
                                       "differs from the original outside the replaced lines",
                                       std::string(kMakeAgain));
      }
    }
    out.kind_.push_back(kind);
    out.origin_.push_back(kind == Kind::head ? 0 : before->number());
  }
  if (before->next()) {
    return kernel::outcome::refuse(changed, after->number(), "ends before the original",
                                   std::string(kMakeAgain));
  }
  for (const SourceLines* lines : {&*before, &*after}) {
    if (auto whole = lines->whole(); !whole) {
      return std::unexpected(whole.error());
    }
  }
  return out;
}

}  // namespace steadyrest::nc::rewrite
