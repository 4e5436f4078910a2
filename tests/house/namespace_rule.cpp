// SPDX-License-Identifier: Apache-2.0
#include "file_check.hpp"
#include "place.hpp"

// The namespace is the folder's.
namespace house {
namespace {

/// Folder by folder, shelves excepted: they share the namespace of their place.
std::string expected_namespace(const FileCheck& check) {
  std::string name = check.rules.root + "/" + home_of(check.rules, check.folder);
  for (std::size_t at = name.find('/'); at != std::string::npos; at = name.find('/')) {
    name.replace(at, 1, "::");
  }
  return name;
}

}  // namespace

/// An alias (`namespace x = steadyrest::…;`) and `using namespace` may name other rooms'
/// namespaces.
void check_namespaces(FileCheck& check) {
  const std::string expected = expected_namespace(check);
  bool matched = false;
  const auto all = words(check.blanked);
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    if (all[i].text != "namespace" || all[i + 1].text != check.rules.root ||
        (i > 0 && all[i - 1].text == "using")) {
      continue;
    }
    const std::size_t start = all[i + 1].offset;
    const std::size_t end = check.blanked.find_first_of(" \n{;=", start);
    const std::string actual = check.blanked.substr(start, end - start);
    const std::size_t sign = check.blanked.find_first_of("{;=", start);
    const bool alias = i > 0 && sign != std::string::npos && check.blanked[sign] == ';';
    if (actual == expected || actual.starts_with(expected + "::")) {
      matched = true;
    } else if (!alias) {
      check.report("namespace", line_of(check.blanked, start),
                   "namespace " + actual + " in the folder of " + expected);
    }
  }
  // A source may define only things of the unnamed namespace; a header must declare something.
  if (!matched && check.file.path.ends_with(".hpp")) {
    check.report("namespace", 1, "the header declares nothing in namespace " + expected);
  }
}

}  // namespace house
