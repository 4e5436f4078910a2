// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/nc/interpret/blocks/klartext_blocks.hpp>
#include <steadyrest/nc/interpret/control/coordinates.hpp>

namespace steadyrest::nc::interpret {
namespace {

std::string_view text_of(ContourCorners::Fault fault) noexcept {
  using Fault = ContourCorners::Fault;
  switch (fault) {
    case Fault::nothing_before:
      return "a rounding or chamfer without a line or arc before it";
    case Fault::nothing_after:
      return "a rounding or chamfer that no line or arc at feed follows";
    case Fault::off_plane:
      return "a rounding or chamfer between moves that leave the working plane";
    case Fault::no_corner:
      return "a rounding or chamfer where the contour has no corner";
    case Fault::not_lines:
      return "a chamfer that is not between two lines";
    case Fault::does_not_fit:
    case Fault::none:
      break;
  }
  return "a rounding or chamfer that does not fit between its two moves";
}

}  // namespace

// A corner's fault shows at the block after it.
bool KlartextBlocks::sound(const Step& step) {
  return corners_.fault() == ContourCorners::Fault::none ||
         refusals_.block(step, "corner", text_of(corners_.fault()));
}

bool KlartextBlocks::execute(const Step& step) {
  const KlartextStep& own = step.klartext;
  out_.begin_block(step.line);
  switch (own.kind) {
    case KlartextStep::Kind::pole:
      state_.klartext.pole_mm = own.pole_mm;
      state_.klartext.pole_known = true;
      return true;
    case KlartextStep::Kind::rounding:
    case KlartextStep::Kind::chamfer: {
      const double feed = own.feed > 0.0 ? own.feed * state_.feed_unit_mm / 60.0 : 0.0;
      corners_.round(own.length_mm, own.kind == KlartextStep::Kind::chamfer, feed, step.line);
      state_.klartext.heading_known = false;
      return sound(step);
    }
    case KlartextStep::Kind::cycle:
      return define(step);
    case KlartextStep::Kind::tool:
    case KlartextStep::Kind::none:
      break;
  }
  return true;
}

bool KlartextBlocks::define(const Step& step) {
  constexpr int kPreset = 247;
  const KlartextStep& own = step.klartext;
  if (corners_.open()) {
    return refusals_.block(step, "corner", text_of(ContourCorners::Fault::nothing_after));
  }
  state_.klartext.defining = own.cycle;
  if (own.cycle == kPreset && own.part < 0) {
    double number = 0.0;
    return !own.complete || (cycles_.value(step, 339, number) && frames_.preset(step, number));
  }
  const bool frame = own.cycle == 7 || own.cycle == 8 || own.cycle == 10 || own.cycle == 11;
  return frame && own.part >= 0 ? frames_.set(step) : cycles_.define(step);
}

bool KlartextBlocks::before(const Step& step) {
  return !step.has_klartext || !step.klartext.call_at || cycles_.check_position(step);
}

// The length delta adds to the tool's own; both act at once.
void KlartextBlocks::tool(const Step& step) {
  const KlartextStep& own = step.klartext;
  if (own.feed >= 0.0) {
    state_.klartext.auto_feed = own.feed;
  }
  if (own.tool_delta_mm != 0.0) {
    state_.tool_offset[axes_of(state_.plane).normal] += own.tool_delta_mm;
    update_offset(state_);
  }
}

// M99 also ends M89, at the last hole.
bool KlartextBlocks::call(const Step& step) {
  KlartextState& state = state_.klartext;
  const bool moved = step.moves_by >= 0 && (step.mask & kAxisMask) != 0;
  const auto when = step.has_klartext ? step.klartext.call : KlartextStep::Call::none;
  const bool runs = when != KlartextStep::Call::none || (state.cycle_modal && moved);
  if (when != KlartextStep::Call::none) {
    state.cycle_modal = when == KlartextStep::Call::modal;
  }
  return !runs || cycles_.run(step);
}

bool KlartextBlocks::after(const Step& step) {
  KlartextState& state = state_.klartext;
  state.begun = state.begun || step.code(GGroup::units) != kNoCode;
  if (step.has_klartext) {
    tool(step);
  }
  if (!sound(step) || !call(step) || !sound(step)) {
    return false;
  }
  if (step.has_klartext && step.klartext.spindle_off_after) {
    state_.spindle_direction = 0;
    out_.spindle();
  }
  if (step.has_klartext && step.klartext.coolant_off_after) {
    state_.coolant = 0.0;
    out_.event(EventKind::coolant, 0.0);
  }
  if (step.moves_by >= 0) {
    state.heading_known = corners_.heading().has_value();
    state.heading = corners_.heading().value_or(std::array<double, 2>{});
  }
  return sound(step);
}

bool KlartextBlocks::end(std::uint32_t line) {
  const read::Word whole{};
  return corners_.fault() == ContourCorners::Fault::none ||
         refusals_.word(line, whole, "corner", text_of(corners_.fault()));
}

}  // namespace steadyrest::nc::interpret
