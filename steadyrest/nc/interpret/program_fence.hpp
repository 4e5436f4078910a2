// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <utility>
#include <vector>

#include <steadyrest/nc/interpret/blocks/interpreter.hpp>
#include <steadyrest/nc/interpret/flow/program_files.hpp>
#include <steadyrest/nc/interpret/program_counter.hpp>
#include <steadyrest/nc/interpret/provenance/builders_words.hpp>
#include <steadyrest/nc/interpret/provenance/provenance.hpp>
#include <steadyrest/nc/read/text/block.hpp>
#include <steadyrest/nc/read/text/refused.hpp>

namespace steadyrest::nc::interpret {

/// What a run does with words that are not understood, and with those that the machine file
/// declares.
class ProgramFence {
 public:
  /// Those of the run; all outlive the object.
  struct Parts {
    ProgramFiles& files;
    Interpreter& interpreter;
    Provenance& provenance;
    Counter& counter;
    std::function<void()> lose_values;  ///< the variables are no longer known
  };
  ProgramFence(const Config& config, Parts parts)
      : parts_(std::move(parts)),
        dialect_(config.dialect),
        block_delete_(config.block_delete),
        fences_(config.opaque_stretches),
        builders_(config.settings.words) {}

  /// Before a line is read.
  void at_line() {
    if (fences_) {
      parts_.counter.set_opaque(parts_.provenance.opaque());
    }
  }
  /// Takes out of the block what the machine file declares, and does it.
  void take_declared(read::Block& block) {
    if (!builders_.none()) {
      take_builders_words(block);
    }
  }
  /// The interpreter has refused the block. M and H words are functions of the machine: where only
  /// they are not understood, the other words do what they say. False: the refusal stands.
  bool without_functions(read::Block& block);
  /// After the block's other words have acted.
  void executed(const read::Block& block) {
    if (!functions_.empty() || !declared_.empty()) {
      open_stretches(block);
    }
  }
  /// A block of which nothing has acted: true where it opens an opaque stretch. It has no words
  /// afterwards.
  bool opens(read::Block& block, const read::Refused& refused);

 private:
  void take_builders_words(read::Block& block);
  void open_stretches(const read::Block& block);
  void open_stretch(const read::Refused& refused, const Effects& effects);

  Parts parts_;
  read::Dialect dialect_;
  bool block_delete_;
  bool fences_;
  BuildersWords builders_;
  std::span<const kernel::machine::BuildersWord* const> declared_;  ///< of the block at hand
  std::vector<read::Refused> functions_;  ///< of the block at hand: words that are not understood
};

}  // namespace steadyrest::nc::interpret
