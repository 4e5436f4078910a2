// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <steadyrest/nc/interpret/flow/flow_control.hpp>

// Conditions and loops of the dialects whose files are mapped. What is open is in the frame, as
// with O-words; where it begins and ends is in the map.
namespace steadyrest::nc::interpret {

using read::Block;
using read::FlowKind;

bool FlowControl::structure(const Block& block, const ProgramMap& map) {
  const std::size_t index = map.at(block.line());
  if (index == ProgramMap::kNone) {
    return refuse(block.line(), {}, "structure_unmatched",
                  "a condition or loop that the search over the file did not find here");
  }
  const ProgramMap::Structure& found = map.structure(index);
  switch (block.flow().kind) {
    case FlowKind::when:
    case FlowKind::loop_while:
    case FlowKind::loop:
    case FlowKind::loop_count:
    case FlowKind::loop_until:
      if (block.flow().unknown != 0) {
        doubt_lines(map, block.line() + 1, found.after.line);
      }
      return block.flow().kind == FlowKind::when ? branch(block, index, found)
                                                 : loop_head(block, index, found);
    case FlowKind::otherwise:
    case FlowKind::endif:
    case FlowKind::until:
    case FlowKind::end_loop:
      if (frames_.back().open.empty() || frames_.back().open.back().structure != index) {
        return refuse(block.line(), {}, "structure_unmatched",
                      "the end of a condition or loop that is not being executed");
      }
      return loop_end(block, map, found);
    default:
      return true;
  }
}

bool FlowControl::branch(const Block& block, std::size_t index,
                         const ProgramMap::Structure& structure) {
  const bool holds = block.flow().holds;
  const bool otherwise = structure.otherwise.line != 0;
  if (holds || otherwise) {
    frames_.back().open.push_back(
        {.kind = FlowKind::when, .label = {}, .head = structure.head, .structure = index});
  }
  return holds || go(block.line(), otherwise ? structure.otherwise : structure.after);
}

bool FlowControl::loop_head(const Block& block, std::size_t index,
                            const ProgramMap::Structure& structure) {
  auto& open = frames_.back().open;
  const read::Flow& flow = block.flow();
  const bool again = !open.empty() && open.back().structure == index;
  if (again && flow.kind == FlowKind::loop_count && open.back().limit != flow.values[1]) {
    return refuse(block.line(), {}, "loop_end_changed",
                  "the end value of FOR has changed during the loop: whether the control takes "
                  "the new one is not certain");
  }
  if (!flow.holds) {
    if (again) {
      open.pop_back();
    }
    return go(block.line(), structure.after);
  }
  if (!again) {
    open.push_back({.kind = flow.kind,
                    .label = {},
                    .head = structure.head,
                    .structure = index,
                    .limit = flow.kind == FlowKind::loop_count ? flow.values[1] : 0.0});
  }
  return true;
}

bool FlowControl::loop_end(const Block& block, const ProgramMap& map,
                           const ProgramMap::Structure& structure) {
  auto& open = frames_.back().open;
  switch (block.flow().kind) {
    case FlowKind::otherwise:  // the branch before it has been executed
      open.pop_back();
      return go(block.line(), structure.after);
    case FlowKind::until:
      if (block.flow().unknown != 0) {
        doubt_lines(map, structure.head.line + 1, structure.after.line);
      }
      if (block.flow().holds) {
        open.pop_back();
        return true;
      }
      return go_back(block.line(), structure.body);
    case FlowKind::end_loop:
      if (structure.kind == FlowKind::loop_count) {
        reader_.count_on();
      }
      return go_back(block.line(), structure.head);
    default:  // endif
      open.pop_back();
      return true;
  }
}

}  // namespace steadyrest::nc::interpret
