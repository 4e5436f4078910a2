// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <utility>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/nc/rewrite/prove/text_pair.hpp>
#include <steadyrest/nc/rewrite/text/place_of_head.hpp>
#include <steadyrest/nc/rewrite/text/source_lines.hpp>
#include <steadyrest/nc/rewrite/text/tag.hpp>

namespace steadyrest::nc::rewrite {

using kernel::outcome::bad_input;
using kernel::outcome::Refusal;
using kernel::outcome::Result;

namespace {

// One pass over both files side by side: the original's lines must all be there, in order and byte
// for byte. Any other line must carry a mark and is stored under the line it precedes.
class TextPair {
 public:
  TextPair(SourceLines before, SourceLines after, const std::string& original,
           const std::string& changed, const Way& way)
      : before_(std::move(before)),
        after_(std::move(after)),
        original_(original),
        changed_(changed),
        way_(way),
        head_(way) {}

  Result<Inserted> compare(PlainSurvey& plain) {
    while (!fault_ && before_.next()) {
      const bool bare = plain.look(before_.line());
      head_.look(before_.line(), before_.number());
      if (!bare && is_inserted(before_.line())) {
        // strip would remove a mark of the original and not restore it.
        refuse(original_, before_.number(), "the original already has corrections");
      }
      if (std::string use = bare ? "" : own_use(way_, before_.line()); !use.empty()) {
        refuse(original_, before_.number(), std::move(use), against_own_use(way_));
      }
      pair();
      if (!before_.ending().empty()) {
        crlf_ = before_.ending().size() > 1;
        ended_ = true;
      }
    }
    while (!fault_ && after_.next()) {
      if (!is_inserted(after_.line())) {
        refuse(changed_, after_.number(), "continues past the end of the original");
      }
      take();
    }
    if (fault_) {
      return std::unexpected(*fault_);
    }
    for (const SourceLines* lines : {&before_, &after_}) {
      if (auto whole = lines->whole(); !whole) {
        return std::unexpected(whole.error());
      }
    }
    return std::move(inserted_);
  }

 private:
  void refuse(const std::string& file, std::uint32_t line, std::string what,
              std::string_view to_do = "make the changed program again from this original") {
    if (!fault_) {
      fault_ = bad_input(file, line, std::move(what), std::string(to_do));
    }
  }

  /// Advances to the line of the changed program that pairs with the original's current one.
  void pair() {
    // The original's line is not an inserted one, so an identical line is not either.
    if (after_.skip(before_.line(), before_.ending())) {
      return;
    }
    bool more = after_.next();
    while (more && after_.line() != before_.line() && is_inserted(after_.line())) {
      take();
      more = after_.next();
    }
    if (!more || after_.line() != before_.line() || after_.ending() != before_.ending()) {
      refuse(changed_, after_.number(), "differs from the original outside the inserted lines");
    }
  }

  // Adds an inserted line to the head or to the group before the original's next line.
  void take() {
    inserted_.lines.push_back(after_.number());
    // The line end used around the inserted line: the last one seen, or at the top of the file the
    // next.
    const bool crlf = ended_ ? crlf_ : before_.ending().size() > 1;
    if (after_.ending().size() != (crlf ? 2 : 1)) {
      refuse(changed_, after_.number(),
             "an inserted line ends differently from the lines around it");
    }
    if (!is_head(after_.line())) {
      inserted_.groups[before_.number()].append(after_.line()).append("\n");
      return;
    }
    inserted_.head.append(after_.line()).append("\n");
    ++inserted_.head_lines;
    // The head has only one right place: after an abort it must run before anything moves.
    if (head_.line() != before_.number()) {
      refuse(changed_, after_.number(),
             "the head is not before the first block that does something", kAgainstOtherLines);
    }
  }

  SourceLines before_;
  SourceLines after_;
  const std::string& original_;
  const std::string& changed_;
  const Way& way_;
  PlaceOfHead head_;
  bool ended_ = false;  ///< a line of the original had a line end
  bool crlf_ = false;   ///< the last of these was CR LF
  Inserted inserted_;
  std::optional<Refusal> fault_;
};

}  // namespace

Result<Inserted> compare_text(const std::string& original, const std::string& changed,
                              PlainSurvey& plain, const Plan& plan, const Settings& settings) {
  auto before = SourceLines::open(original);
  auto after = SourceLines::open(changed);
  if (!before || !after) {
    return std::unexpected(before ? after.error() : before.error());
  }
  TextPair pair(std::move(*before), std::move(*after), original, changed, settings);
  auto inserted = pair.compare(plain);
  if (inserted && inserted->lines.empty() && corrects(plan)) {
    return kernel::outcome::refuse(changed, "has no corrections: neither a head nor any other line",
                                   "give the program that `program compensate` has written");
  }
  if (inserted && inserted->head != whole_head(plan, settings)) {
    return kernel::outcome::refuse(changed, "the head does not match this plan, machine and method",
                                   std::string(kAgainstOtherLines));
  }
  return inserted;
}

}  // namespace steadyrest::nc::rewrite
