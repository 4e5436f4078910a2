// SPDX-License-Identifier: Apache-2.0
#include "nc_mutator.hpp"

#include <algorithm>
#include <array>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// Random bytes hardly ever make a program. So lines of the three dialects are inserted, moved,
// repeated and erased, and numbers are changed; one time in five bytes change as well.
namespace steadyrest::fuzz {
namespace {

using Random = std::minstd_rand;

// $ represents a number, ~ one above zero. A line with \n is several lines.
constexpr auto kLines = std::to_array<std::string_view>({
    "G0 X$ Y$ Z$",
    "G0 Z$",
    "G0 X$",
    "G0 X$ Y$",
    "G0",
    "X$ Y$",
    "Z$",
    "G1 X$ Y$ F~",
    "G1 Z$ F~",
    "G1 X$",
    "G2 I$ J$",
    "G3 I$ J$ Z$",
    "G2 X$ Y$ R~",
    "G18 G3 I$ K$",
    "G17",
    "G19",
    "G90",
    "G91",
    "G20",
    "G21",
    "G54",
    "G55",
    "T1 M6",
    "T2 M6",
    "G43 H1",
    "G49",
    "M3 S~",
    "M5",
    "M8",
    "M9",
    "G4 P~",
    "G64",
    "G61",
    "G93",
    "G94",
    "G95 F~",
    "G98 G81 X$ Y$ Z-~ R~ F~",
    "G83 X$ Y$ Z-~ R~ Q~ F~",
    "G80",
    "G53 G0 Z$",
    "G52 Z$",
    "G92 X$ Z$",
    "G92.1",
    "G28 Z$",
    "M1",
    "M0",
    "/G0 X$ Z$",
    "N~ G0 Z$",
    "(A NOTE)",
    "G96 D~ S~",
    "G97 S~",
    "A$",
    "G0 A$ Z$",
    "G1 Z$ B$ F~",
    "M2",
    "M30",
});
constexpr auto kLinuxcnc = std::to_array<std::string_view>({
    "#1=$",
    "#<a>=[$+#1]",
    "G0 X[#1+$] Z[$*2]",
    "G1 Z[#1] F~",
    "o1 repeat [2]\nG0 X$ Z$\no1 endrepeat",
    "o2 sub\nG1 Z$ F~\no2 endsub",
    "o2 call [$]",
    "o3 if [#1 GT $]\nG0 Z$\no3 else\nG0 X$\no3 endif",
    "o4 while [#1 LT 3]\n#1=[#1+1]\nG0 Z#1\no4 endwhile",
    "o5 do\n#1=[#1+1]\no5 while [#1 LT 2]",
    "G41.1 D~",
    "G42.1 D~",
    "G40",
    "G10 L2 P1 Z$",
    "G10 L2 P1 R$",
    "G10 L2 P2 X$ Z$",
    "G10 L20 P1 Z$",
    "G10 L20 P2 Z$",
    "G10 L1 P1 Z$",
    "G5.2 X$ Y$ P1 L3\nX$ Y$ P1\nX$ Y$ P2\nG5.3",
    "G5 I$ J$ P$ Q$ X$ Y$",
    "G33 Z$ K~",
    "G76 P~ Z-~ I-~ J~ R~ K~ Q~ H1 E0 L0",
    "G38.2 Z$ F~",
    "G7",
    "G8",
    "G59.3",
    "G64 P~",
    "G73 X$ Y$ Z-~ R~ Q~",
    "G43.1 Z$",
    "G30",
    "@~ ^$",
    "M66 P0 L0",
});
constexpr auto kFanuc = std::to_array<std::string_view>({
    "#100=$",
    "#1=[#100*2.]",
    "G0 X[#100+$] Z#100",
    "G10 L2 P1 Z$",
    "G10 L2 P0 Z$",
    "G91 G28 Z0",
    "M98 P100 L2",
    "M98 P100",
    "O100\nG0 X$ Z$\nM99",
    "G84 X$ Y$ Z-~ R~ F~",
    "G99 G86 X$ Z-~ R~ F~",
    "G9 G1 X$",
    "G30 P2 Z0",
    "G50.1",
    "M29",
});
constexpr auto kSinumerik = std::to_array<std::string_view>({
    "R1=$",
    "R2=R1*2+SIN($)",
    "G0 X=R1 Z=AC($)",
    "G0 X=IC($) Z$",
    "G1 Z=IC($) F~",
    "TRANS X$ Z$",
    "ATRANS Z$",
    "TRANS",
    "ROT Z$",
    "AROT RPL=$",
    "CYCLE81(10,0,2,-5)",
    "CYCLE82(10,0,2,-5,,0.1)",
    "CYCLE85(10,0,2,-5,,0.1,~,~)",
    "MCALL CYCLE81(10,0,2,-5)",
    "MCALL",
    "G500",
    "G505",
    "D0",
    "D1",
    "SUPA G0 Z$ D0",
    "G53 G0 Z$",
    "STOPRE",
    "MSG(\"A\")",
    "DEF REAL A=$",
    "DEF INT B=$",
    "G71",
    "G70",
    "G700",
    "G2 X$ Y$ CR=~",
    "G3 I$ J$ TURN=2 Z$",
    "G4 F~",
    "G641 ADIS=~",
    "T=\"DRILL\" M6",
});

constexpr auto kHeidenhain = std::to_array<std::string_view>({
    "BEGIN PGM A MM",
    "END PGM A MM",
    "TOOL CALL 1 Z S~ F~",
    "L X$ IY$ R0 FMAX",
    "L Z$ F~ M99",
    "CC X$ Y$",
    "C X$ Y$ DR+",
    "CP IPA$ IZ$ DR-",
    "CR X$ Y$ R$ DR+",
    "CT X$ Y$",
    "LP PR~ PA$",
    "RND R~",
    "CHF ~",
    "Q1 = Q1 + $ * SIN Q1",
    "FN 0: Q1 = $",
    "LBL 1",
    "LBL 0",
    "CALL LBL 1",
    "CALL LBL 1 REP 2",
    "FN 12: IF +Q1 LT +$ GOTO LBL 1",
    "CYCL DEF 200 DRILL\nQ200=~\nQ201=-~\nQ206=~\nQ202=~\nQ203=0\nQ204=~",
    "Q201=-~ ;DEPTH",
    "CYCL DEF 7.1 X$",
    "CYCL DEF 10.1 ROT$",
    "CYCL DEF 8.1 X",
    "CYCL CALL M3",
    "STOP",
});

/// The low bits of minstd_rand are poor; division drops them.
std::size_t below(Random& random, std::size_t limit) {
  return random() / 7 % limit;
}

std::string number(Random& random, bool positive) {
  static constexpr auto kNumbers =
      std::to_array<std::string_view>({"0", "1", "2", "5.5", "10", "0.1", "100", "12.3456",
                                       "0.0001", "25.4", "3.", ".5", "400", "1000"});
  std::string text{
      kNumbers[below(random, kNumbers.size() - (positive ? 1 : 0)) + (positive ? 1 : 0)]};
  return !positive && below(random, 3) == 0 ? "-" + text : text;
}

std::string one_line(Random& random, std::uint8_t dialect) {
  static constexpr std::array<std::span<const std::string_view>, 4> kOwn = {
      kLinuxcnc, kFanuc, kSinumerik, kHeidenhain};
  const std::span<const std::string_view> own = kOwn[dialect % kOwn.size()];
  // Two thirds of the choice from what all dialects know.
  const std::size_t at = below(random, 2 * kLines.size() + own.size());
  std::string text;
  for (const char c : at < 2 * kLines.size() ? kLines[at / 2] : own[at - 2 * kLines.size()]) {
    text += c == '$' || c == '~' ? number(random, c == '~') : std::string(1, c);
  }
  return text;
}

class Program {
 public:
  explicit Program(std::string_view text) {
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      lines_.emplace_back(text.substr(at, end - at));
      at = end + 1;
    }
  }

  void change(Random& random, std::uint8_t dialect) {
    const std::size_t at = below(random, lines_.size() + 1);
    const auto place = lines_.begin() + static_cast<long>(at);
    // Inserting as often as everything else together, so that programs grow.
    const std::size_t what = below(random, 8);
    if (what < 4 || place == lines_.end()) {
      lines_.insert(place, one_line(random, dialect));
    } else if (what == 4) {
      lines_.erase(place);
    } else if (what == 5) {
      lines_.insert(place, lines_[below(random, lines_.size())]);
    } else if (what == 6) {
      std::swap(*place, lines_[below(random, lines_.size())]);
    } else {
      change_number(*place, random);
    }
  }

  // A program without an end is refused at once, which teaches the fuzzer nothing.
  void end_well() {
    if (lines_.empty() || (lines_.back() != "M2" && lines_.back() != "M30")) {
      lines_.emplace_back("M2");
    }
  }

  [[nodiscard]] std::string text() const {
    std::string all;
    for (const std::string& line : lines_) {
      all += line + "\n";
    }
    return all;
  }

 private:
  static void change_number(std::string& line, Random& random) {
    constexpr std::string_view kDigits = "0123456789.";
    const std::size_t from = line.find_first_of(kDigits, below(random, line.size() + 1));
    if (from != std::string::npos) {
      const std::size_t to = std::min(line.find_first_not_of(kDigits, from), line.size());
      line.replace(from, to - from, number(random, true));
    }
  }

  std::vector<std::string> lines_;
};

std::uint8_t choice_of(std::uint8_t byte, const Layout& layout) {
  return static_cast<std::uint8_t>(static_cast<std::uint8_t>(byte - '0') % layout.dialects);
}

/// The choice byte stays legal, or most inputs would go to the same place.
std::size_t mutate_bytes(std::uint8_t* data, std::size_t size, std::size_t most,
                         const Layout& layout) {
  const std::size_t now = LLVMFuzzerMutate(data, size, most);
  if (now > 0) {
    data[0] = static_cast<std::uint8_t>('0' + choice_of(data[0], layout));
  }
  return now;
}

}  // namespace

/// seed decides everything: libFuzzer expects the same change for the same seed.
std::size_t mutate_program(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed,
                           const Layout& layout) {
  Random random(seed);
  constexpr std::size_t kSeldom = 5;
  if (below(random, kSeldom) == 0) {
    return mutate_bytes(data, size, most, layout);
  }
  std::string input(reinterpret_cast<const char*>(data), size);
  input.resize(std::max(size, layout.head), '0');
  const std::size_t nul =
      layout.edits ? std::min(input.find('\0', layout.head), input.size()) : input.size();
  std::string edits = nul < input.size() ? input.substr(nul + 1) : std::string{};
  std::string head = input.substr(0, layout.head);
  if (below(random, 16) == 0) {
    head[below(random, head.size())] = static_cast<char>('0' + below(random, 64));
  }
  const std::uint8_t choice = choice_of(static_cast<std::uint8_t>(head[0]), layout);
  head[0] = static_cast<char>('0' + choice);
  Program program(std::string_view{input}.substr(layout.head, nul - layout.head));
  if (!layout.edits || below(random, 2) == 0) {
    for (std::size_t times = 1 + below(random, 4); times > 0; --times) {
      program.change(random, layout.dialect_of == nullptr ? choice : layout.dialect_of[choice]);
    }
  }
  // Now and then without an end, for that path too.
  if (below(random, 8) != 0) {
    program.end_well();
  }
  std::string made = head + program.text();
  if (layout.edits) {
    // Some edits of the corrected program are kept, new ones are added.
    if (edits.size() > 16 || below(random, 4) == 0) {
      edits.clear();
    }
    for (std::size_t byte = 0; byte < 4; ++byte) {
      edits += static_cast<char>(below(random, 256));
    }
    made += '\0' + edits;
  }
  if (made.size() > most) {
    return mutate_bytes(data, size, most, layout);
  }
  std::ranges::copy(made, data);
  return made.size();
}

}  // namespace steadyrest::fuzz
