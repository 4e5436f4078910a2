// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/nc/interpret/decode/fanuc/fanuc.hpp>
#include <steadyrest/nc/interpret/decode/fanuc/fanuc_decoder.hpp>

namespace steadyrest::nc::interpret {
namespace {

bool decode_fanuc(const Decoding& in, const read::Block& block, Step& step) {
  return FanucDecoder(fanuc_variant(), in, step).block(block);
}

bool decode_haas(const Decoding& in, const read::Block& block, Step& step) {
  return FanucDecoder(haas_variant(), in, step).block(block);
}

}  // namespace

const DialectRules& fanuc_rules() noexcept {
  // Differences from LinuxCNC: G98 at the start, G10 adds in G91, cycle words stay until G80, P may
  // be omitted, no lift before moving across; G53 is a one-shot rapid.
  static constexpr DialectRules kRules{.decode = decode_fanuc,
                                       .starts_with_g98 = true,
                                       .machine_frame_alone = true,
                                       .machine_frame_is_rapid = true,
                                       .g10_adds = true,
                                       .cycle_words_stay = true,
                                       .cycle_needs_dwell = false,
                                       .cycle_keeps_all_words = true,
                                       .cycles_are_a_group = true,
                                       .cycle_lifts_first = false,
                                       .variables = Variables::macros,
                                       .numbered_programs = true};
  return kRules;
}

const DialectRules& haas_rules() noexcept {
  // As above, but G53 moves by the motion word in force, G10 L2 P0 is G52, and tapping is rigid
  // (setting 133).
  static constexpr DialectRules kRules{.decode = decode_haas,
                                       .starts_with_g98 = true,
                                       .machine_frame_alone = true,
                                       .g10_adds = true,
                                       .cycle_words_stay = true,
                                       .cycle_needs_dwell = false,
                                       .cycle_keeps_all_words = true,
                                       .cycles_are_a_group = true,
                                       .cycle_lifts_first = false,
                                       .variables = Variables::macros,
                                       .numbered_programs = true,
                                       .external_offset = false,
                                       .pecks_by_words = true,
                                       .taps_rigidly = true};
  return kRules;
}

}  // namespace steadyrest::nc::interpret
