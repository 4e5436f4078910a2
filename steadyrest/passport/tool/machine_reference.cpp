// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <string>

#include <steadyrest/passport/file/reference.hpp>

/// Prints docs/machine-file.md.
int main() {
  const std::string page = steadyrest::passport::reference_page();
  return std::fwrite(page.data(), 1, page.size(), stdout) == page.size() ? 0 : 1;
}
