// SPDX-License-Identifier: Apache-2.0
#include <fstream>

#include <steadyrest/apps/cli/text_file.hpp>

namespace steadyrest::apps::cli {

kernel::outcome::Result<void> write_text(const std::filesystem::path& path, std::string_view text) {
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out << text;
  out.close();
  if (!out) {
    return std::unexpected(kernel::outcome::Refusal{
        kernel::outcome::Kind::unavailable, path.string(), 0, "cannot be written",
        "check the folder, the rights and the disk space"});
  }
  return {};
}

}  // namespace steadyrest::apps::cli
