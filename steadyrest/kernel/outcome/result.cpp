// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/outcome/shown.hpp>

namespace steadyrest::kernel::outcome {

// FILE:LINE: what; what to do. The format of compilers: editors jump to it.
std::string text(const Refusal& refusal) {
  std::string out;
  if (!refusal.file.empty()) {
    out += refusal.file;
    out += ':';
    if (refusal.line != 0) {
      out += std::to_string(refusal.line);
      out += ':';
    }
    out += ' ';
  }
  out += refusal.what;
  if (!refusal.to_do.empty()) {
    out += "; ";
    out += refusal.to_do;
  }
  return shown(out);
}

}  // namespace steadyrest::kernel::outcome
