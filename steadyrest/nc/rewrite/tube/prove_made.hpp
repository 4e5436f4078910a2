// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/rewrite/replace/replace.hpp>
#include <steadyrest/nc/rewrite/tube/verify_tube.hpp>

namespace steadyrest::nc::rewrite {

/// The proof of `program verify` for a text with blocks replaced that is in no file yet: what may
/// have changed is what its own mark says. A verb that replaces blocks writes nothing without it.
///
/// Nothing is to be proved where no block is replaced: the text is the original's. The refusal
/// names the original's line.
[[nodiscard]] kernel::outcome::Result<TubeProof> prove_made(
    const std::string& original, const Replaced& made, const interpret::Config& config,
    const kernel::machine::Machine& machine,
    const std::function<void(double share, std::string_view what)>& progress = {});

}  // namespace steadyrest::nc::rewrite
