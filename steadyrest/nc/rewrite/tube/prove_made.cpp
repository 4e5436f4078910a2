// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <optional>

#include <steadyrest/kernel/file/memory_file.hpp>
#include <steadyrest/nc/rewrite/text/mark.hpp>
#include <steadyrest/nc/rewrite/tube/permitted.hpp>
#include <steadyrest/nc/rewrite/tube/prove_made.hpp>

namespace steadyrest::nc::rewrite {

using kernel::outcome::Refusal;
using kernel::outcome::Result;

Result<TubeProof> prove_made(
    const std::string& original, const Replaced& made, const interpret::Config& config,
    const kernel::machine::Machine& machine,
    const std::function<void(double share, std::string_view what)>& progress) {
  if (made.replaced == 0) {
    return TubeProof{};
  }
  const auto file = kernel::file::MemoryFile::make(made.text);
  if (!file) {
    return std::unexpected(file.error());
  }
  const auto of_original = [&](Refusal refusal) {
    if (refusal.file == file->path()) {
      const auto line = static_cast<std::size_t>(refusal.line);
      refusal.file = original;
      refusal.line = line < made.origin.size() ? made.origin[line] : 0;
      refusal.what = "what would replace this block " + refusal.what;
    }
    return std::unexpected(std::move(refusal));
  };
  const auto mark = read_replaced_mark(file->path());
  const auto permitted = mark ? permitted_of(file->path(), *mark, std::nullopt, &machine)
                              : std::unexpected(mark.error());
  if (!permitted) {
    return of_original(permitted.error());
  }
  auto proof = verify_tube(original, file->path(), config, *permitted, progress);
  return proof ? std::move(proof) : of_original(std::move(proof.error()));
}

}  // namespace steadyrest::nc::rewrite
