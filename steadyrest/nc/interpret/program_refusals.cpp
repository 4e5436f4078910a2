// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <utility>

#include <steadyrest/nc/interpret/program_refusals.hpp>

namespace steadyrest::nc::interpret {

using read::Refused;

Refused at_block(const read::Block& block, std::string_view reason, std::string_view text,
                 std::string_view word) {
  return {.line = block.line(),
          .word = std::string{word},
          .reason = std::string{reason},
          .text = std::string{text}};
}

Refused acting_comment(const read::Block& block, bool in_doubt) {
  const std::string comment = read::printable(block.comment());
  if (block.acting() == read::Acting::foreign) {
    return at_block(block, "python",
                    "a comment that LinuxCNC executes as Python: only the running control knows "
                    "what it changes; take it out, or write it as O-words",
                    comment);
  }
  return at_block(
      block, "abort",
      in_doubt ? "the control would end the program here with this message, if its answers are "
                 "those that were assumed (--json lists them)"
               : "the control ends the program here with this message",
      comment);
}

void add_kind(Report& report, const Refused& refused) {
  // A hundred lines with G41 are one finding: words with the same letter and number count once.
  const auto head = [](const Refused& one) {
    return std::pair{one.reason, one.word.substr(0, one.word.find_first_of(" .=[(+-#"))};
  };
  const bool known = std::ranges::any_of(report.refused, [&](const Refused& earlier) {
    return head(earlier) == head(refused) ||
           (earlier.reason == refused.reason && earlier.reason.find("code") == std::string::npos);
  });
  if (!known) {
    report.refused.push_back(refused);
  }
}

}  // namespace steadyrest::nc::interpret
