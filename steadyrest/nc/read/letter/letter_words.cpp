// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstddef>

#include <steadyrest/nc/read/letter/letter_line.hpp>
#include <steadyrest/nc/read/text/character.hpp>

// Words that only some of the controls with letters and numbers have.
namespace steadyrest::nc::read {
namespace {

/// Settings that only change what Grbl reports, or the power of a laser or spindle: nothing moves
/// otherwise. Grbl 1.1, "Configuration".
constexpr std::array<std::string_view, 5> kHarmlessSettings = {
    "$10=", "$13=", "$30=", "$31=", "$32="};
/// Questions, and `$X`, which ends an alarm.
constexpr std::array<std::string_view, 7> kHarmlessCommands = {"$",  "$$", "$#", "$G",
                                                               "$I", "$N", "$X"};

}  // namespace

// grbl: a line that begins with `$` is for the control itself, `!` holds the feed.
bool LetterLine::system_line() {
  const char* const from = at_;
  const bool first = block_.words().empty();
  std::array<char, 8> head{};
  std::size_t length = 0;
  const bool hold = *at_ == '!';
  for (; at_ != end_; ++at_) {
    if (!is_blank(*at_) && length < head.size()) {
      head[length++] = upper(*at_);
    }
  }
  const std::string_view text{head.data(), length};
  const auto begins = [text](std::string_view setting) { return text.starts_with(setting); };
  if (first && (std::ranges::find(kHarmlessCommands, text) != kHarmlessCommands.end() ||
                std::ranges::any_of(kHarmlessSettings, begins))) {
    return true;
  }
  if (hold) {
    return refuse(since(from), "feed_hold", "a feed hold (!) in a program: it waits for ~");
  }
  if (begins("$H")) {
    return refuse(since(from), "homing", "homing ($H) ends where the machine's switches are");
  }
  if (begins("$J=")) {
    return refuse(since(from), "jogging", "a jog ($J=) is for the operator; write G1 instead");
  }
  return refuse(since(from), "control_setting",
                "a setting or command of the control ($) that may change what words mean; only "
                "$X, $10=, $13=, $30=, $31=, $32= and questions may be in a program");
}

// fanuc: `,C2.` a chamfer, `,R2.` a rounding at the end of the block. The word's letter is 0, its
// name has the comma.
bool LetterLine::corner_word() {
  const char* const word_begin = at_++;
  skip_blanks();
  Word word;
  const char letter = at_ == end_ ? '\0' : upper(*at_);
  if (letter != 'C' && letter != 'R') {
    at_ = end_;
    return refuse(since(word_begin), "bad_character",
                  "a comma that is not followed by C (chamfer) or R (rounding)");
  }
  word.letter = letter;  // its increment is that of a length
  ++at_;
  if (!value(word_begin, word)) {
    return false;
  }
  word.letter = 0;
  word.has_value = true;
  word.unknown = reading_.values != nullptr && reading_.values->take_unknown();
  word.text = since(word_begin);
  word.name = letter == 'C' ? ",C" : ",R";
  return block_.push(word) ||
         refuse(word.text, "too_many_words", "more words than a block may have (128)");
}

}  // namespace steadyrest::nc::read
