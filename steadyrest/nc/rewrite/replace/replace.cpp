// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <steadyrest/nc/rewrite/replace/replace.hpp>
#include <steadyrest/nc/rewrite/text/place_of_head.hpp>
#include <steadyrest/nc/rewrite/text/replaced_text.hpp>
#include <steadyrest/nc/rewrite/text/source_lines.hpp>
#include <steadyrest/nc/rewrite/text/writing.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using kernel::outcome::Result;

/// Only its comments and the place of a head matter here.
Way way_of_comments(read::Dialect dialect) {
  switch (dialect) {
    case read::Dialect::linuxcnc:
    case read::Dialect::grbl:
    case read::Dialect::mach3:
      return {.method = Method::linuxcnc};
    case read::Dialect::fanuc:
      return {.method = Method::fanuc};
    case read::Dialect::haas:
      return {.method = Method::haas};
    case read::Dialect::sinumerik:
      return {.method = Method::frame_fine};
  }
  return {};
}

/// Copies a program and puts new lines in.
class Copy {
 public:
  Copy(read::Dialect dialect, const NewLines& lines, std::uint32_t head_line, std::string head)
      : dialect_(dialect), lines_(lines), head_line_(head_line), head_(std::move(head)) {
    out_.origin.push_back(0);
  }

  void line(const SourceLines& source) {
    const std::string_view ending = source.ending();
    usual_ = ending.empty() ? usual_ : ending;
    if (source.number() == head_line_) {
      put_head();
    }
    const auto found = lines_.find(source.number());
    if (found == lines_.end()) {
      put(source.line(), ending, source.number());
      return;
    }
    const auto& texts = found->second;
    ++out_.replaced;
    // The last of the group ends as the line did, so that a file without a last line end keeps to
    // that.
    put(was_text(dialect_, source.line(), texts.size()), texts.empty() ? ending : usual_,
        source.number());
    for (std::size_t i = 0; i < texts.size(); ++i) {
      put(new_text(dialect_, texts[i]), i + 1 == texts.size() ? ending : usual_, source.number());
      ++out_.new_lines;
    }
  }

  Replaced take() { return std::move(out_); }

 private:
  void put(std::string_view text, std::string_view ending, std::uint32_t origin) {
    out_.text += text;
    out_.text += ending;
    out_.origin.push_back(origin);
  }
  void put_head() {
    std::string_view rest = head_;
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find('\n'), rest.size());
      put(rest.substr(0, end), usual_, 0);
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  }

  read::Dialect dialect_;
  const NewLines& lines_;
  std::uint32_t head_line_;
  std::string head_;
  std::string usual_ = "\n";
  Replaced out_;
};

}  // namespace

Result<Replaced> replace(const std::string& program, read::Dialect dialect, const NewLines& lines,
                         const std::vector<Told>& told) {
  const Way way = way_of_comments(dialect);
  auto source = SourceLines::open(program);
  if (!source) {
    return std::unexpected(source.error());
  }
  PlaceOfHead place(way);
  BlocksSum sum;
  while (source->next()) {
    place.look(source->line(), source->number());
    if (const auto found = lines.find(source->number()); found != lines.end()) {
      sum.add(was_text(dialect, source->line(), found->second.size()));
      for (const std::string& text : found->second) {
        sum.add(new_text(dialect, text));
      }
    }
  }
  std::vector<Told> mark = told;
  if (!mark.empty()) {
    mark.push_back({.name = std::string{kBlocksSum}, .value = sum.text()});
  }
  auto again = SourceLines::open(program);
  if (!again) {
    return std::unexpected(again.error());
  }
  Copy copy(dialect, lines, place.line(),
            lines.empty() ? "" : mark_text(way, mark, "\n", kReplacedMark));
  while (again->next()) {
    copy.line(*again);
  }
  if (auto whole = again->whole(); !whole) {
    return std::unexpected(whole.error());
  }
  return copy.take();
}

}  // namespace steadyrest::nc::rewrite
