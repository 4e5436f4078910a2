// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstddef>

#include <steadyrest/nc/read/letter/letter_line.hpp>
#include <steadyrest/nc/read/text/character.hpp>

// Comments: most say something to people, some do something on the control.
namespace steadyrest::nc::read {
namespace {

/// The word that a comment begins with and the comma behind it, in capitals.
bool begins(std::string_view comment, std::string_view word) noexcept {
  const auto* const first = std::ranges::find_if_not(comment, is_blank);
  comment.remove_prefix(static_cast<std::size_t>(first - comment.begin()));
  return comment.size() >= word.size() &&
         std::ranges::equal(comment.substr(0, word.size()), word, {}, upper);
}

/// Python: a statement, a file, or all modules again. It sees and sets what the interpreter has.
bool is_foreign(std::string_view comment) noexcept {
  constexpr std::array<std::string_view, 3> kForeign = {"PY,", "PYRUN,", "PYRELOAD"};
  return std::ranges::any_of(kForeign, [comment](auto word) { return begins(comment, word); });
}

/// LinuxCNC 2.9, found with rs274: blanks before the word, in any case, none between it and its
/// comma. MSG, DEBUG, PRINT, LOG, LOGOPEN, LOGAPPEND, LOGCLOSE, PROBEOPEN and PROBECLOSE move
/// nothing and set nothing.
Acting acting_of(std::string_view comment) noexcept {
  return is_foreign(comment)                                    ? Acting::foreign
         : begins(comment, "ABORT,")                            ? Acting::abort
         : begins(comment, "MSG,") || begins(comment, "DEBUG,") ? Acting::message
                                                                : Acting::none;
}

}  // namespace

bool LetterLine::round_comment() {
  const char* const open = at_;
  for (++at_; at_ != end_; ++at_) {
    if (*at_ == ')') {
      note_comment({open + 1, static_cast<std::size_t>(at_ - open - 1)});
      ++at_;
      return true;
    }
    if (*at_ == '(' && !rules_.loose_comments) {
      return refuse({open, static_cast<std::size_t>(end_ - open)}, "nested_comment",
                    "a comment opens inside a comment; close the first one");
    }
    if (is_control(*at_)) {
      ++at_;
      return refuse({at_ - 1, 1}, "control_character", kControlCharacter);
    }
  }
  return rules_.loose_comments ||
         refuse(since(open), "unclosed_comment",
                "a comment that is not closed on its line; write ) at its end");
}

// Of several comments on a line LinuxCNC acts on the last alone. A foreign one is noted wherever it
// is: better one program too many refused.
void LetterLine::note_comment(std::string_view comment) {
  if (rules_.acting_comments && block_.acting() != Acting::foreign) {
    block_.set_comment(acting_of(comment), comment);
  }
}

// `;` opens a comment (linuxcnc) or ends the block (fanuc), after which nothing may follow.
bool LetterLine::rest_of_line() {
  const char* const mark = at_++;
  if (rules_.semicolon_ends) {
    skip_blanks();
    if (at_ != end_) {
      at_ = end_;
      return refuse(since(mark), "text_after_end_of_block",
                    "; ends the block in this dialect, but text follows; put it in ( )");
    }
    return true;
  }
  for (; at_ != end_; ++at_) {
    if (is_control(*at_)) {
      return refuse({at_, 1}, "control_character", kControlCharacter);
    }
  }
  if (rules_.acting_comments && is_foreign(since(mark + 1))) {
    block_.set_comment(Acting::foreign, since(mark + 1));
  }
  return true;
}

}  // namespace steadyrest::nc::read
