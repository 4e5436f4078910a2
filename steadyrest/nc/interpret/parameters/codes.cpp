// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>

#include <steadyrest/nc/interpret/parameters/codes.hpp>

namespace steadyrest::nc::interpret {
namespace {

struct Range {
  int first;  // G times ten
  int last;
  GGroup group;
};

constexpr std::array kGroups = {
    Range{0, 0, GGroup::motion},           Range{10, 10, GGroup::motion},
    Range{20, 20, GGroup::motion},         Range{30, 30, GGroup::motion},
    Range{40, 40, GGroup::non_modal},      Range{70, 80, GGroup::lathe_diameter},
    Range{100, 100, GGroup::non_modal},    Range{170, 170, GGroup::plane},
    Range{180, 180, GGroup::plane},        Range{190, 190, GGroup::plane},
    Range{200, 200, GGroup::units},        Range{210, 210, GGroup::units},
    Range{280, 281, GGroup::non_modal},    Range{300, 301, GGroup::non_modal},
    Range{330, 331, GGroup::motion},       Range{50, 53, GGroup::motion},
    Range{760, 760, GGroup::motion},       Range{382, 385, GGroup::motion},
    Range{400, 400, GGroup::cutter},       Range{410, 411, GGroup::cutter},
    Range{420, 421, GGroup::cutter},       Range{430, 432, GGroup::tool_length},
    Range{490, 490, GGroup::tool_length},  Range{520, 520, GGroup::non_modal},
    Range{530, 530, GGroup::non_modal},    Range{540, 540, GGroup::work_offset},
    Range{550, 550, GGroup::work_offset},  Range{560, 560, GGroup::work_offset},
    Range{570, 570, GGroup::work_offset},  Range{580, 580, GGroup::work_offset},
    Range{590, 593, GGroup::work_offset},  Range{610, 611, GGroup::path_mode},
    Range{640, 640, GGroup::path_mode},    Range{730, 730, GGroup::motion},
    Range{740, 740, GGroup::motion},       Range{800, 800, GGroup::motion},
    Range{810, 810, GGroup::motion},       Range{820, 820, GGroup::motion},
    Range{830, 830, GGroup::motion},       Range{840, 840, GGroup::motion},
    Range{850, 850, GGroup::motion},       Range{860, 860, GGroup::motion},
    Range{870, 870, GGroup::motion},       Range{880, 880, GGroup::motion},
    Range{890, 890, GGroup::motion},       Range{900, 900, GGroup::distance},
    Range{901, 901, GGroup::arc_centre},   Range{910, 910, GGroup::distance},
    Range{911, 911, GGroup::arc_centre},   Range{920, 923, GGroup::non_modal},
    Range{930, 930, GGroup::feed_mode},    Range{940, 940, GGroup::feed_mode},
    Range{950, 950, GGroup::feed_mode},    Range{960, 960, GGroup::spindle_mode},
    Range{970, 970, GGroup::spindle_mode}, Range{980, 980, GGroup::retract},
    Range{990, 990, GGroup::retract},
};

constexpr std::size_t kCodes = 1000;
constexpr std::uint8_t kUnknown = 0xff;

constexpr auto kGroupOfG = [] {
  std::array<std::uint8_t, kCodes> table{};
  table.fill(kUnknown);
  for (const Range& range : kGroups) {
    for (int code = range.first; code <= range.last; ++code) {
      table[static_cast<std::size_t>(code)] = static_cast<std::uint8_t>(range.group);
    }
  }
  return table;
}();

struct Note {
  int first;
  int last;
  std::string_view text;
};

constexpr std::array kRefusedG = {
    Note{410, 411,
         "cutter radius compensation (G41) is not interpreted; let the CAM system "
         "compensate"},
    Note{420, 421,
         "cutter radius compensation (G42) is not interpreted; let the CAM system "
         "compensate"},
    Note{700, 722, "a lathe cycle is not interpreted"},
};

constexpr std::array kRefusedM = {
    Note{19, 19, "spindle orientation (M19) is not interpreted in this dialect"},
    Note{62, 73, "M62-M73 are not interpreted in this dialect"},
    Note{98, 99, "a subprogram call or return (M98, M99) is not interpreted in this dialect"},
    Note{100, 199, "a user-defined M word (M100-M199) does what only its machine knows"},
};

}  // namespace

GroupOfG group_of_g(int code) noexcept {
  if (code < 0 || code >= static_cast<int>(kCodes)) {
    return {};
  }
  const std::uint8_t group = kGroupOfG[static_cast<std::size_t>(code)];
  return {.known = group != kUnknown, .group = static_cast<GGroup>(group)};
}

GroupOfM group_of_m(int code) noexcept {
  switch (code) {
    case 0:
    case 1:
    case 2:
    case 30:
    case 60:
      return {.known = true, .group = MGroup::stopping};
    case 6:
    case 61:
      return {.known = true, .group = MGroup::tool_change};
    case 3:
    case 4:
    case 5:
    case 19:
      return {.known = true, .group = MGroup::spindle};
    case 7:
    case 8:
    case 9:
      return {.known = true, .group = MGroup::coolant};
    case 48:
    case 49:
    case 50:
    case 51:
    case 52:
    case 53:
      return {.known = true, .group = MGroup::override_switch};
    case 62:
    case 63:
    case 64:
    case 65:
    case 66:
    case 67:
    case 68:
      return {.known = true, .group = MGroup::io};
    case 70:
    case 71:
    case 72:
    case 73:
      return {.known = true, .group = MGroup::modes};
    case 98:
    case 99:
      return {.known = true, .group = MGroup::program};
    default:
      return {};
  }
}

std::string_view known_but_refused_g(int code) noexcept {
  for (const Note& note : kRefusedG) {
    if (code >= note.first && code <= note.last) {
      return note.text;
    }
  }
  return {};
}

std::string_view known_but_refused_m(int code) noexcept {
  for (const Note& note : kRefusedM) {
    if (code >= note.first && code <= note.last) {
      return note.text;
    }
  }
  return {};
}

}  // namespace steadyrest::nc::interpret
