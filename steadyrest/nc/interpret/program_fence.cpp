// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <optional>
#include <utility>

#include <steadyrest/nc/interpret/program_fence.hpp>
#include <steadyrest/nc/interpret/program_refusals.hpp>

namespace steadyrest::nc::interpret {

using kernel::machine::BuildersWord;
using read::Block;
using read::Refused;

namespace {

void take_words(Block& block) {
  const bool deleted = block.deleted();
  block.reset(block.line());
  if (deleted) {
    block.set_deleted();
  }
}

}  // namespace

bool ProgramFence::without_functions(Block& block) {
  const auto is_function = [this](const Refused& one) {
    return fences_ && (one.word.starts_with('M') || one.word.starts_with('H')) &&
           may_change(one, dialect_);
  };
  while (is_function(parts_.interpreter.refused())) {
    functions_.push_back(parts_.interpreter.refused());
    const std::size_t before = block.words().size();
    block.drop([&](const read::Word& word) { return word.text == functions_.back().word; });
    if (block.words().size() == before) {
      return false;
    }
    parts_.counter.set_opaque(true);
    if (parts_.interpreter.execute(block, parts_.counter)) {
      return true;
    }
  }
  // What remains belongs to the function: its P and Q.
  if (functions_.empty() || parts_.interpreter.refused().reason != "unused_word") {
    return false;
  }
  take_words(block);
  return true;
}

void ProgramFence::take_builders_words(Block& block) {
  declared_ = builders_.take(block);
  if (block.deleted() && block_delete_) {
    declared_ = {};
  }
  for (const BuildersWord* const word : declared_) {
    if (word->does != BuildersWord::Does::nothing) {
      parts_.interpreter.pause(block.line(), word->dwell_s, parts_.counter);
    }
  }
}

void ProgramFence::open_stretches(const Block& block) {
  for (; !functions_.empty(); functions_.pop_back()) {
    open_stretch(functions_.back(), Effects{.all = true});
  }
  for (const BuildersWord* const word : std::exchange(declared_, {})) {
    if (const Effects effects = effects_of(*word); effects.all || effects.axes != 0) {
      open_stretch(at_block(block, "declared",
                            effects.all ? "the machine file says that it may do anything"
                                        : "the machine file says that it moves " + word->axes,
                            word->word),
                   effects);
    }
  }
}

void ProgramFence::open_stretch(const Refused& refused, const Effects& effects) {
  Refused where = refused;
  where.file = parts_.files.in_main() ? std::string{} : parts_.files.path();
  parts_.provenance.not_understood(where, effects, parts_.interpreter.state());
  if (effects.all) {
    parts_.lose_values();
  }
}

bool ProgramFence::opens(Block& block, const Refused& refused) {
  auto effects = fences_ ? may_change(refused, dialect_) : std::nullopt;
  functions_.clear();
  if (!effects) {
    return false;
  }
  // What a modal call does, it does behind each block that moves.
  const read::FlowKind kind = block.flow().kind;
  const bool modal = kind == read::FlowKind::modal_cycle || kind == read::FlowKind::modal_call;
  effects->modes |= modal ? kCallMode : 0U;
  take_words(block);
  if (!(block.deleted() && block_delete_)) {
    open_stretch(refused, *effects);
  }
  return true;
}

}  // namespace steadyrest::nc::interpret
