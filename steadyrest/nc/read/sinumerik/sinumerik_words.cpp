// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <steadyrest/nc/read/sinumerik/sinumerik_names.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_words.hpp>
#include <steadyrest/nc/read/text/character.hpp>

namespace steadyrest::nc::read {
namespace {

constexpr NamedWord acts(std::string_view name, bool index = false) {
  return {.name = name, .role = WordRole::decoded, .index = index, .brackets = false};
}
constexpr NamedWord idle(std::string_view name) {
  return {.name = name, .role = WordRole::without_effect, .index = false, .brackets = false};
}
constexpr NamedWord idle_list(std::string_view name) {
  return {.name = name, .role = WordRole::without_effect, .index = false, .brackets = true};
}
constexpr NamedWord drives(std::string_view name) {
  return {.name = name, .role = WordRole::dynamics, .index = true, .brackets = true};
}

// The words of arcs and frames first: they are the frequent ones.
constexpr std::array kNamedWords = {
    // Motion and frames (F)
    acts("CR"), acts("TURN"), acts("AR"), acts("RP"), acts("AP"), acts("ANG"), acts("CIP"),
    acts("CT"), acts("SUPA"), acts("TRANS"), acts("ATRANS"), acts("ROT"), acts("AROT"), acts("RPL"),
    acts("DIAMON"), acts("DIAMOF"), acts("RET"), acts("TRAFOOF"),
    // Rounding at block transitions, compressors, tolerances (F, J)
    acts("ADIS"), acts("ADISPOS"), acts("CTOL"), acts("OTOL"), acts("ATOL", true), acts("COMPOF"),
    acts("COMPON"), acts("COMPCURV"), acts("COMPCAD"), acts("COMPSURF"),
    // The spindle (F)
    acts("LIMS", true), acts("SPOS", true), acts("SPOSA", true), idle_list("SPCON"),
    idle_list("SPCOF"),
    // The course of the feed and what it refers to (F, J)
    idle("FNORM"), drives("FLIN"), drives("FCUB"), idle("CFC"), idle("CFTCP"), idle("CFIN"),
    drives("FGROUP"), drives("FGREF"),
    // Acceleration and jerk (F, J): the plan takes those of the machine file
    idle("SOFT"), idle_list("SOFTA"), drives("BRISK"), drives("BRISKA"), drives("DRIVE"),
    drives("DRIVEA"), drives("FFWON"), idle("FFWOF"), drives("ACC"), drives("VELOLIM"),
    drives("JERKLIM"), drives("ACCLIMA"), drives("VELOLIMA"), drives("JERKLIMA"), idle("DYNNORM"),
    drives("DYNPOS"), drives("DYNROUGH"), drives("DYNSEMIFIN"), drives("DYNFINISH"),
    drives("DYNPREC"),
    // Preprocessing memory, limits, protection (F, J): a move that they stop does not happen
    // elsewhere
    idle("STOPRE"), idle("STARTFIFO"), idle("STOPFIFO"), idle("FIFOCTRL"), idle("WALIMON"),
    idle("WALIMOF"), idle("SBLON"), idle("SBLOF"), idle("UPATH"), idle("SPATH"),
    // Of radius compensation and transformations, none of which can be on (F, J)
    idle("NORM"), idle("KONT"), idle("KONTC"), idle("KONTT"), idle("CDOF"), idle("CDOF2"),
    idle("CDON"), idle("CUT2D"), idle("CUT2DF"), idle("CUT3DC"), idle("CUT3DF"), idle("CUT3DFF"),
    idle("CUT3DFS"), idle("ORIWKS"), idle("ORIMKS"), idle("ORIAXES"), idle("ORIVECT"),
    idle("ORIEULER"), idle("ORIRPY"), idle("ORIRPY2"), idle("ORISON"), idle("ORISOF"), idle("OSOF"),
    idle("OSC"), idle("OSS"), idle("OSSE"), idle("OSD"), idle("OST"),
    // For the operator and for the editor (J, C)
    idle_list("SETAL"), idle_list("WORKPIECE"), idle_list("GROUP_BEGIN"), idle_list("GROUP_ADDEND"),
    idle_list("GROUP_END")};

constexpr std::array<std::string_view, 9> kPatterns = {
    "HOLES1", "HOLES2", "SLOT1", "SLOT2", "POCKET1", "POCKET2", "POCKET3", "POCKET4", "LONGHOLE"};

// "Cycles", CYCLE832: the modes by name.
struct Predefined {
  std::string_view name;
  double value;
};
constexpr std::array kPredefined = {Predefined{"_off", 0.0},
                                    Predefined{"_finish", 1.0},
                                    Predefined{"_semifin", 2.0},
                                    Predefined{"_rough", 3.0},
                                    Predefined{"_precision", 4.0},
                                    Predefined{"_ori_finish", 11.0},
                                    Predefined{"_ori_semifin", 12.0},
                                    Predefined{"_ori_rough", 13.0},
                                    Predefined{"_ori_precision", 14.0},
                                    Predefined{"_top_surface_smooth_off", 1e6},
                                    Predefined{"_top_surface_smooth_on", 2e6}};

}  // namespace

// Linear: such words are rare but for CR, which comes first.
const NamedWord* named_word(std::string_view name) noexcept {
  const auto* const found = std::ranges::find_if(
      kNamedWords, [&](const NamedWord& word) { return equal(name, word.name); });
  return found == kNamedWords.end() ? nullptr : found;
}

bool predefined(std::string_view name, double& value) noexcept {
  const auto* const found = std::ranges::find(kPredefined, name, &Predefined::name);
  if (found == kPredefined.end()) {
    return false;
  }
  value = found->value;
  return true;
}

bool names_cycle(std::string_view name) noexcept {
  if (name.size() > 5 && equal(name.substr(0, 5), "CYCLE")) {
    return true;
  }
  return std::ranges::any_of(kPatterns,
                             [&](std::string_view pattern) { return equal(name, pattern); });
}

}  // namespace steadyrest::nc::read
