// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cctype>

#include <steadyrest/nc/interpret/decode/codes.hpp>
#include <steadyrest/nc/interpret/state/words.hpp>
#include <steadyrest/nc/rewrite/replace/block_words.hpp>

namespace steadyrest::nc::rewrite {
namespace {

/// The word sets the motion in force. On fanuc the cycles are a group of their own: behind them the
/// motion before them is in force again.
bool sets_motion(const read::Word& word, read::Dialect dialect) noexcept {
  const int code = word.letter == 'G' ? interpret::g::code_of(word.value) : -1;
  const auto of = interpret::group_of_g(code);
  return of.known && of.group == interpret::GGroup::motion &&
         ((dialect != read::Dialect::fanuc && dialect != read::Dialect::haas) ||
          code <= interpret::g::kRigidTap);
}

/// M70 and M73 keep the motion and the feed in force, for M72 or the end of the subprogram.
bool keeps_modes(const read::Word& word) noexcept {
  return word.letter == 'M' &&
         (word.value == interpret::m::kKeepModes || word.value == interpret::m::kKeepModesForCall);
}

/// A word that a line or an arc may have without saying anything else.
bool is_plain(const read::Word& word) {
  constexpr std::string_view kLetters = "NXYZIJKRFP";
  if (word.letter == 'G') {
    const int code = interpret::g::code_of(word.value);
    return code == interpret::g::kLinear || code == interpret::g::kArcClockwise ||
           code == interpret::g::kArcCounterClockwise;
  }
  const bool arc_name = word.name == "CR" || word.name == "TURN";
  return arc_name || (word.letter != 0 && kLetters.find(word.letter) != std::string_view::npos);
}

}  // namespace

Says says(const read::Block& block, read::Dialect dialect) {
  Says out;
  for (const read::Word& word : block.words()) {
    out.motion = out.motion || sets_motion(word, dialect);
    out.keeps = out.keeps || keeps_modes(word);
    out.feed = out.feed || word.letter == 'F';
    out.plain = out.plain && is_plain(word);
    out.calculated = out.calculated || is_calculated(word);
  }
  return out;
}

bool is_calculated(const read::Word& word) {
  constexpr std::string_view kNumber = "0123456789.+- \t=()";
  std::string_view value = word.text;
  value.remove_prefix(std::min(value.size(), std::max<std::size_t>(word.name.size(), 1)));
  if (word.qualifier != read::Qualifier::none) {
    const std::size_t bracket = value.find('(');  // AC(…), IC(…)
    value.remove_prefix(bracket == std::string_view::npos ? 0 : bracket);
  }
  return word.calculated || value.find_first_not_of(kNumber) != std::string_view::npos;
}

std::string_view word_beyond_a_cut(const read::Block& block) {
  for (const read::Word& word : block.words()) {
    if (!is_plain(word) || is_calculated(word)) {
      return word.text;
    }
  }
  return block.flow().kind == read::FlowKind::none ? std::string_view{} : "an O-word";
}

std::string active_comment(read::Dialect dialect, std::string_view line) {
  constexpr std::array<std::string_view, 6> kWithComma = {"MSG", "DEBUG", "PRINT",
                                                          "LOG", "ABORT", "PY"};
  constexpr std::array<std::string_view, 5> kAlone = {"LOGOPEN", "LOGAPPEND", "LOGCLOSE",
                                                      "PROBEOPEN", "PROBECLOSE"};
  if (dialect != read::Dialect::linuxcnc) {
    return {};
  }
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  for (std::size_t at = line.find_first_of("(;"); at != std::string_view::npos;
       at = line.find_first_of("(;", at + 1)) {
    auto next =
        std::find_if_not(line.begin() + static_cast<std::ptrdiff_t>(at) + 1, line.end(), blank);
    std::string name;
    for (; next != line.end() && std::isalpha(static_cast<unsigned char>(*next)) != 0; ++next) {
      name += static_cast<char>(std::toupper(static_cast<unsigned char>(*next)));
    }
    next = std::find_if_not(next, line.end(), blank);
    const bool comma = next != line.end() && *next == ',';
    if (std::ranges::find(kAlone, name) != kAlone.end() ||
        (comma && std::ranges::find(kWithComma, name) != kWithComma.end())) {
      return name;
    }
  }
  return {};
}

}  // namespace steadyrest::nc::rewrite
